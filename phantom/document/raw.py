"""The first look at a parsed tree, before any model: nothing in it may be odd, deep or endless.

The walk keeps its own stack, so that no depth exhausts Python's, and stops at a number of values,
so that references shared many times over (a YAML alias bomb) cost no more than their share.
"""

from __future__ import annotations

import math
from typing import Any

from phantom.document.words import MOST_PROBLEMS, HugeInteger, found, quoted
from phantom.errors import Problem, pointer

DEEPEST_VALUE = 200
MOST_VALUES = 500_000
MOST_NUMBERS_IN_ARRAY = 10_000
LONGEST_KEY = 1_000
HUGE_BITS = 1023

Place = tuple[Any, Any] | None  # (place of the parent, key): a path as a linked list


class RepeatedKeys(dict[str, Any]):
    """An object of an input in which keys stand more than once; ``repeated`` lists them."""

    def __init__(self, *values: Any) -> None:
        super().__init__(*values)
        self.repeated: list[str] = []


def path_of(place: Place) -> str:
    """Return the JSON pointer of a place."""
    parts = []
    while place is not None:
        place, key = place
        parts.append(key)
    # A lone surrogate cannot be printed; it is shown as its escape.
    return pointer(reversed(parts)).encode("utf-8", "backslashreplace").decode()


class Walk:
    """One walk over a tree; afterwards ``problems`` and whether models may still be tried."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self.fatal = False

    def report(self, place: Place, kind: str, message: str, *, fatal: bool = False) -> None:
        """Note a problem; a fatal one keeps the tree from the models."""
        if len(self.problems) <= MOST_PROBLEMS:
            self.problems.append(Problem(path_of(place), kind, message))
        self.fatal = self.fatal or fatal

    def over(self, tree: object) -> Walk:
        """Walk over the whole tree."""
        values = 0
        if not isinstance(tree, dict | list | tuple):
            self.scalar(None, tree)
            return self
        # Each entry: a container, its place, its depth, and the tally of the array it is part of.
        stack: list[tuple[Any, Place, int, list[Any]]] = [(tree, None, 1, [0, None])]
        tallies = [stack[0][3]]
        while stack:
            node, place, depth, tally = stack.pop()
            values += len(node)
            if depth > DEEPEST_VALUE:
                message = (
                    f"found values nested deeper than {DEEPEST_VALUE}; expected a flatter tree"
                )
                self.report(place, "too_deep", message, fatal=True)
                return self
            if values > MOST_VALUES:
                message = f"found more than {MOST_VALUES} values; expected fewer"
                self.report(None, "too_large", message, fatal=True)
                return self
            is_object = isinstance(node, dict)
            if is_object:
                self.keys(place, node)
            for key, value in node.items() if is_object else enumerate(node):
                kind = type(value)
                if kind is float or kind is int:
                    tally[0] += not is_object
                    if -1e300 < value < 1e300:
                        continue
                if kind is str and value.isascii():
                    continue
                if isinstance(value, dict):
                    stack.append((value, (place, key), depth + 1, [0, None]))
                elif isinstance(value, (list, tuple)):
                    # An array within an array counts into the outer one: points of one curve.
                    if is_object:
                        inner = [0, (place, key)]
                        tallies.append(inner)
                    else:
                        inner = tally
                    stack.append((value, (place, key), depth + 1, inner))
                else:
                    self.scalar((place, key), value)
        for count, place in tallies:
            if count > MOST_NUMBERS_IN_ARRAY:
                message = (
                    f"found {count} numbers; expected at most {MOST_NUMBERS_IN_ARRAY} in an array"
                )
                self.report(place, "too_long", message)
        return self

    def keys(self, place: Place, node: dict[Any, Any]) -> None:
        """Look at the keys of an object."""
        for key in node:
            if type(key) is str and key.isprintable() and len(key) <= LONGEST_KEY:
                continue  # neither control characters nor surrogates are printable
            if not isinstance(key, str):
                message = f"found the key {found(key)}; expected a string"
                self.report(place, "bad_key", message, fatal=True)
            elif len(key) > LONGEST_KEY:
                message = f"found a key of {len(key)} characters; expected at most {LONGEST_KEY}"
                self.report(place, "bad_key", message, fatal=True)
            elif any(c < " " or c == "\x7f" for c in key):
                message = f"found the key {quoted(key)}; expected no control characters"
                self.report(place, "bad_key", message, fatal=True)
            elif has_lone_surrogate(key):
                message = f"found the key {quoted(key)}; expected no lone surrogate"
                self.report(place, "lone_surrogate", message, fatal=True)
        if isinstance(node, RepeatedKeys):
            for key in node.repeated:
                self.report((place, key), "repeated_key", "found this key twice; expected it once")

    def scalar(self, place: Place, value: object) -> None:
        """Look at a value that holds no others."""
        if value is None or isinstance(value, bool):
            return
        if isinstance(value, str):
            if has_lone_surrogate(value):
                message = f"found {quoted(value)}; expected text without lone surrogates"
                self.report(place, "lone_surrogate", message)
        elif isinstance(value, HugeInteger) or (
            isinstance(value, int) and value.bit_length() > HUGE_BITS
        ):
            self.report(place, "out_of_range", f"found {found(value)}; expected at most 1e18")
        elif isinstance(value, float):
            if not math.isfinite(value):
                message = f"found {found(value)}; expected a finite number"
                self.report(place, "not_finite", message)
        elif not isinstance(value, int):
            message = f"found {found(value)}; expected plain JSON values"
            self.report(place, "unsupported_value", message, fatal=True)


def has_lone_surrogate(text: str) -> bool:
    """Tell whether a string holds half of a surrogate pair, which no encoding can write."""
    if text.isascii():
        return False
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        return True
    return False
