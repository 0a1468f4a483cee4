"""JSON text to a plain tree, keeping what is wrong with it for the walk to report in its place."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

from phantom.document.raw import RepeatedKeys
from phantom.document.words import HugeInteger
from phantom.errors import InvalidInputError, Problem

MOST_DIGITS = 400


def decode_json(data: bytes | bytearray | memoryview | str) -> object:
    """Decode JSON into a tree that :func:`validate_model` can judge.

    Repeated keys, ``NaN``, ``Infinity`` and integers of any length are kept as marks in the tree,
    so that they are reported with their place.

    Raises
    ------
    InvalidInputError
        The text is not UTF-8, not JSON, or nested deeper than the decoder goes.
    """
    try:
        text = data if isinstance(data, str) else bytes(data).decode("utf-8-sig")
        return json.loads(text, parse_int=_integer, object_pairs_hook=_object)
    except UnicodeDecodeError as error:
        problem = Problem(
            "", "invalid_utf8", f"found a byte that is not UTF-8 at {error.start}; expected UTF-8"
        )
    except json.JSONDecodeError as error:
        message = f"found no JSON at line {error.lineno}, column {error.colno}: {error.msg}"
        problem = Problem("", "invalid_json", message[:200])
    except RecursionError:
        problem = Problem("", "too_deep", "found values nested too deep to read")
    raise InvalidInputError([problem])


def _integer(digits: str) -> int | HugeInteger:
    return int(digits) if len(digits) <= MOST_DIGITS else HugeInteger(len(digits.lstrip("-")))


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    plain = dict(pairs)
    if len(plain) == len(pairs):
        return plain
    marked = RepeatedKeys(plain)
    marked.repeated = [key for key, count in Counter(k for k, _ in pairs).items() if count > 1]
    return marked
