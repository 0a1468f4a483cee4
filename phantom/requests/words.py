"""The flat words of a command line or a query string, and the request that they mean."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from phantom.document import decode_json
from phantom.errors import InvalidInputError, Problem, pointer

PARAMETERS = "parameters."

WORDS: Mapping[str, tuple[str, ...]] = {
    "view": ("view", "preset"),
    "source_detector_mm": ("view", "source_detector_mm"),
    "source_object_mm": ("view", "source_object_mm"),
    "object_detector_mm": ("view", "object_detector_mm"),
    "angle_deg": ("view", "angle_deg"),
    "primary_angle_deg": ("view", "primary_angle_deg"),
    "secondary_angle_deg": ("view", "secondary_angle_deg"),
    "laterality": ("view", "laterality"),
    "columns": ("detector", "columns"),
    "rows": ("detector", "rows"),
    "pitch_mm": ("detector", "pitch_mm"),
    "energy_kev": ("beam", "energy_kev"),
    "kvp": ("beam", "kvp"),
    "anode": ("beam", "anode"),
    "filtration": ("beam", "filtration_mm"),
    "quantity": ("quantity",),
    "mode": ("presentation", "mode"),
    "scope": ("presentation", "scope"),
    "window_center": ("presentation", "window_center"),
    "window_width": ("presentation", "window_width"),
    "percentiles": ("presentation", "percentiles"),
    "polarity": ("presentation", "polarity"),
    "bits": ("presentation", "bits"),
    "gsdf": ("presentation", "gsdf"),
    "blind": ("blind",),
}
"""Where each word's value stands in a request."""


def scalar(text: str) -> object:
    """Return the number, truth value or JSON array or object that the text is, else the text."""
    text = text.strip()
    if text in ("true", "false"):
        return text == "true"
    if text[:1] in ("{", "["):
        return decode_json(text)
    try:
        number: float = int(text)
    except ValueError:
        try:
            number = float(text)
        except ValueError:
            return text
    return number if math.isfinite(number) else text


def parameters(pairs: Iterable[tuple[str, str]]) -> dict[str, object]:
    """Return the phantom's parameters from (name, text) pairs; a name given twice is refused."""
    found: dict[str, object] = {}
    for name, text in pairs:
        if name in found:
            path = pointer(("phantom", "parameters", name))
            raise InvalidInputError([Problem(path, "given_twice", "found it twice; expected once")])
        found[name] = scalar(text)
    return found


def request_tree(
    phantom: Mapping[str, object], words: Iterable[tuple[str, str]]
) -> tuple[dict[str, object], tuple[Problem, ...]]:
    """Return the request that the words ask for, as it would stand in JSON, and what is wrong.

    A ``view`` that is a JSON object is taken as it is, so that an explicit source and detector can
    be given too; ``filtration`` is a JSON object, MATERIAL=MM with commas between, or ``none``.
    Words that are not known, or given twice, are problems.
    """
    tree: dict[str, object] = {"phantom": dict(phantom)}
    problems: list[Problem] = []
    seen: set[str] = set()
    for word, text in words:
        if word not in WORDS:
            message = f"found an unknown word; expected one of {', '.join(WORDS)}"
            problems.append(Problem(pointer([word]), "unknown_field", message))
        elif word in seen:
            problems.append(
                Problem(pointer(WORDS[word]), "given_twice", "found it twice; expected once")
            )
        elif word == "filtration":
            filters, wrong = _filters(text)
            _place(tree, word, filters)
            problems += wrong
        else:
            _place(tree, word, scalar(text))
        seen.add(word)
    return tree, tuple(problems)


def _filters(text: str) -> tuple[object, tuple[Problem, ...]]:
    """Return the filters in a text, material to mm, and what is wrong with it."""
    if text.strip()[:1] == "{":
        return scalar(text), ()
    if text.strip() == "none":
        return {}, ()
    found: dict[str, object] = {}
    for part in text.split(","):
        name, equals, thickness = (piece.strip() for piece in part.partition("="))
        if not (name and equals):
            message = f"found {part[:60]!r}; expected MATERIAL=MM, as in aluminium=2.5"
            return {}, (Problem("/beam/filtration_mm", "not_a_pair", message),)
        if name in found:
            path = pointer(("beam", "filtration_mm", name))
            return {}, (Problem(path, "given_twice", "found it twice; expected once"),)
        found[name] = scalar(thickness)
    return found, ()


def _place(tree: dict[str, object], word: str, value: object) -> None:
    """Put a word's value where the request has it."""
    if word == "view" and isinstance(value, dict):
        _section(tree, "view").update(value)
    elif len(WORDS[word]) == 1:
        tree[WORDS[word][0]] = value
    else:
        section, name = WORDS[word]
        _section(tree, section)[name] = value


def _section(tree: dict[str, object], name: str) -> dict[str, object]:
    section = tree.setdefault(name, {})
    assert isinstance(section, dict)
    return section
