"""Parts of a set: what each has made, as a list of records, and all of them as one."""

from __future__ import annotations

import heapq
import json
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any, NamedTuple

from phantom.datasets.ledger import Ledger
from phantom.datasets.names import STATE, part_name
from phantom.datasets.storage import Storage
from phantom.errors import InvalidInputError, Problem


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
                message = f"found {name} of another design"
                problems.append(Problem("/output", "other_design", message))
        expected = [part_name(k, wanted) for k in range(wanted)]
        missing = [name for name in expected if name not in self._names]
        if not self._names or missing or len(self._names) > wanted:
            found = f"{len(self._names)} parts of {wanted or 'none'}"
            short = ", ".join(missing[:5]) or "no others"
            problems.append(
                Problem("/output", "missing_part", f"found {found}; expected {short} too")
            )
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
