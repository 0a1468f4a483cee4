"""Short ways to write a value on a command line or in a query string."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final

from phantom.document import decode_json
from phantom.errors import Problem, pointer

Read = tuple[object, tuple[Problem, ...]]
"""A value, and what is wrong with it."""

Path = tuple[str, ...]


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


def plain(text: str, path: Path) -> Read:
    """Return what the text is by itself."""
    return scalar(text), ()


def filters(text: str, path: Path) -> Read:
    """Return the filters in a text, material to mm: JSON, MATERIAL=MM with commas, or ``none``."""
    if text.strip()[:1] == "{":
        return scalar(text), ()
    if text.strip() == "none":
        return {}, ()
    found: dict[str, object] = {}
    for part in text.split(","):
        name, equals, thickness = (piece.strip() for piece in part.partition("="))
        if not (name and equals):
            message = f"found {part[:60]!r}; expected MATERIAL=MM, as in aluminium=2.5"
            return {}, (Problem(pointer(path), "not_a_pair", message),)
        if name in found:
            twice = pointer((*path, name))
            return {}, (Problem(twice, "given_twice", "found it twice; expected once"),)
        found[name] = scalar(thickness)
    return found, ()


def both(text: str, path: Path) -> Read:
    """Return one number for both directions as a pair; an array stays as it is."""
    value = scalar(text)
    return ([value, value] if type(value) in (int, float) else value), ()


def switch(text: str, path: Path) -> Read:
    """Return an object of defaults for ``true``, null for ``false``; an object stays as it is."""
    value = scalar(text)
    return ({True: {}, False: None}[value] if isinstance(value, bool) else value), ()


def optional(text: str, path: Path) -> Read:
    """Return null for ``none``, else what the text is by itself."""
    return (None if text.strip() == "none" else scalar(text)), ()


def grid(text: str, path: Path) -> Read:
    """Return PRIMARY,SCATTER as a grid of these transmissions, null for ``none``; or JSON."""
    if text.strip()[:1] == "{":
        return scalar(text), ()
    if text.strip() == "none":
        return None, ()
    parts = text.split(",")
    if len(parts) != 2:
        message = f"found {text[:60]!r}; expected PRIMARY,SCATTER transmission, as in 0.7,0.1"
        return None, (Problem(pointer(path), "not_a_pair", message),)
    primary, scatter = map(scalar, parts)
    return {"primary_transmission": primary, "scatter_transmission": scatter}, ()


def kinds(text: str, path: Path) -> Read:
    """Return KIND,KIND,… as an array, every kind of ground truth for ``all``; or JSON."""
    from phantom.imaging.truth import KINDS

    if text.strip() == "all":
        return list(KINDS), ()
    if text.strip()[:1] == "[":
        return scalar(text), ()
    return [part.strip() for part in text.split(",") if part.strip()], ()


def plane(text: str, path: Path) -> Read:
    """Return a number as a plane at that depth; a word or an object stays as it is."""
    value = scalar(text)
    return ({"plane_mm": value} if type(value) in (int, float) else value), ()


def screen(text: str, path: Path) -> Read:
    """Return PITCH,DISTANCE,EYES in mm as a screen; an object stays as it is."""
    if text.strip()[:1] == "{":
        return scalar(text), ()
    parts = text.split(",")
    if len(parts) != 3:
        message = f"found {text[:60]!r}; expected PITCH,DISTANCE,EYES in mm, as in 0.27,600,63"
        return None, (Problem(pointer(path), "wrong_length", message),)
    names = ("pixel_pitch_mm", "distance_mm", "ipd_mm")
    return dict(zip(names, map(scalar, parts), strict=True)), ()


def names(text: str, path: Path) -> Read:
    """Return NAME,NAME,… as an array; JSON stays as it is."""
    if text.strip()[:1] == "[":
        return scalar(text), ()
    return [part.strip() for part in text.split(",") if part.strip()], ()


def color(text: str, path: Path) -> Read:
    """Return RED,GREEN,BLUE as an array, ``black`` and ``white`` as what they are; or JSON."""
    known = {"black": [0.0, 0.0, 0.0], "white": [1.0, 1.0, 1.0]}
    if text.strip() in known:
        return known[text.strip()], ()
    return (scalar(text) if text.strip()[:1] == "[" else list(map(scalar, text.split(",")))), ()


FORMS: Final[Mapping[str, Callable[[str, Path], Read]]] = {
    "acquisition": optional,
    "filtration": filters,
    "scatter": switch,
    "grid": grid,
    "focal_spot_mm": both,
    "samples": both,
    "truth": kinds,
    "zero_parallax": plane,
    "screen": screen,
    "hide": names,
    "background": color,
}
"""How the words with a way of their own are written; all others are :func:`plain`."""
