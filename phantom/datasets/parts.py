"""Parts of a set: what each has made, as a list of records, and all of them as one."""

from __future__ import annotations

import heapq
import json
import re
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any, Final, NamedTuple

from phantom.datasets.ledger import Ledger
from phantom.datasets.names import STATE, part_name
from phantom.datasets.storage import Storage
from phantom.errors import InvalidInputError, Problem

_DIVISION: Final = re.compile(r"(?:ledger|part)-\d+-of-(\d+)\.(?:sqlite|jsonl)$")


class Part(NamedTuple):
    """Which part of how many; units go round, one to each in turn."""

    number: int = 0
    of: int = 1

    @property
    def name(self) -> str:
        """What its ledger and its unfinished files are called."""
        return f"{self.number:05d}-of-{self.of:05d}"


def write_part(ledger: Ledger, where: Storage, part: Part, digest: str) -> None:
    """Write what a part has made: a line about it, then a line an image in order."""
    with where.writing(part_name(*part)) as stream:
        about = {"design": digest, "part": part.number, "parts": part.of}
        stream.write(f"{json.dumps(about)}\n".encode())
        records = ((number, text) for number, _, text in ledger.records())
        errors = ((n, json.dumps({"error": error})) for n, error in ledger.aside())
        for number, text in heapq.merge(records, errors):
            stream.write(f"[{number},{text}]\n".encode())


def check_division(where: Storage, part: Part) -> None:
    """Refuse a set that was begun in another number of parts, which would not fit together.

    Raises
    ------
    InvalidInputError
        It was (``/shard``).
    """
    begun = {int(found[1]) for n in where.names(STATE) if (found := _DIVISION.search(n))}
    if others := begun - {part.of}:
        message = (
            f"found a set in {min(others)} part{'s' * (min(others) > 1)} at {where.address!r},"
            f" and {part.number}/{part.of}; expected the same number, or another place"
        )
        raise InvalidInputError([Problem("/shard", "other_division", message)])


class Parts:
    """The records of a whole set, as often as they are wanted, in order.

    Raises
    ------
    InvalidInputError
        A part is missing, or is of another design (``/output``).
    """

    def __init__(self, where: Storage, digest: str) -> None:
        self._where = where
        self._names = [n for n in where.names(STATE) if n.startswith(f"{STATE}/part-")]
        wanted = 0
        problems = []
        for name in self._names:
            with self._where.reading(name) as stream:
                about = json.loads(stream.readline())
            wanted = max(wanted, about["parts"])
            if about["design"] != digest:
                message = f"found {name} of another design or version; expected those of this one"
                problems.append(Problem("/output", "other_design", message))
        expected = [part_name(k, wanted) for k in range(wanted)]
        missing = [name for name in expected if name not in self._names]
        if not self._names or missing or len(self._names) > wanted:
            there = len(self._names)
            message = f"found {there} of {wanted} parts; expected {', '.join(missing[:5])} too"
            if not missing:
                message = f"found parts of several divisions, {there} in all; expected those of one"
            if not there:
                message = "found no part; expected some"
            problems.append(Problem("/output", "missing_part", message))
        if problems:
            raise InvalidInputError(problems)

    def __iter__(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield (number, record) of every image; an ``error`` is the record of one set aside."""
        with ExitStack() as stack:
            lists = []
            for name in self._names:
                stream = stack.enter_context(self._where.reading(name))
                stream.readline()
                lists.append(_parsed(stream))
            yield from heapq.merge(*lists, key=lambda entry: entry[0])


def _parsed(lines: Any) -> Iterator[tuple[int, dict[str, Any]]]:
    for line in lines:
        number, record = json.loads(line)
        yield number, record
