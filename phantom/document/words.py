"""Short, safe words for whatever an input holds, and the order problems are told in."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence

from phantom.errors import Problem

LONGEST_ECHO = 60
MOST_PROBLEMS = 1000


class HugeInteger:
    """An integer of an input with too many digits to be read."""

    def __init__(self, digits: int) -> None:
        self.digits = digits


def quoted(text: str) -> str:
    """Return a string in quotes, cut to a line, with odd characters escaped."""
    cut = text[:LONGEST_ECHO]
    return repr(cut) + ("…" if len(text) > len(cut) else "")


def found(value: object) -> str:
    """Say what a value is without echoing more than a few dozen characters of it."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, HugeInteger):
        return f"an integer of {value.digits} digits"
    if isinstance(value, int):
        bits = value.bit_length()
        return str(value) if bits <= 128 else f"an integer of about {bits * 3 // 10} digits"
    if isinstance(value, float):
        if math.isnan(value):
            return "NaN"
        return f"{float(value):.12g}" if math.isfinite(value) else "an infinite number"
    if isinstance(value, Mapping):
        return f"an object with {counted(len(value), 'field')}"
    if isinstance(value, Sequence):
        return f"an array of {counted(len(value), 'value')}"
    return f"a Python {type(value).__name__[:LONGEST_ECHO]}"


def counted(count: int, noun: str) -> str:
    """Return ``1 value``, ``2 values``."""
    return f"{count} {noun}" + ("" if count == 1 else "s")


def listed(names: Iterable[str], most: int = 8) -> str:
    """Return names joined by commas, the first few of many."""
    every = sorted(names)
    shown = ", ".join(quoted(name) for name in every[:most]) or "none"
    return shown + (f" and {len(every) - most} more" if len(every) > most else "")


def arranged(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return the problems once each, by their place, and not more than a reader can bear."""
    every = sorted(set(problems), key=lambda p: (_natural(p.path), p.kind, p.message))
    if len(every) > MOST_PROBLEMS:
        more = f"found {len(every) - MOST_PROBLEMS} or more further problems, not listed"
        return (*every[:MOST_PROBLEMS], Problem("", "too_many_problems", more))
    return tuple(every)


def _natural(path: str) -> list[tuple[int, str]]:
    """Sort ``/solids/10`` after ``/solids/9``."""
    return [
        (int(part) if re.fullmatch("[0-9]{1,9}", part) else -1, part) for part in path.split("/")
    ]
