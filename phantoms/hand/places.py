"""Where things are in the hand: words for bones and joints, and places in and on a bone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from phantom.document import Point
from phantoms.hand.frames import FloatArray, Frame
from phantoms.hand.sizes import DISTAL, METACARPAL, MIDDLE, PROXIMAL
from phantoms.hand.skeleton import BoneName, Placed
from phantoms.parts import Station

_JOINTS: Final = {
    "metacarpophalangeal": (METACARPAL, PROXIMAL),
    "interphalangeal": (PROXIMAL, DISTAL),
    "proximal interphalangeal": (PROXIMAL, MIDDLE),
    "distal interphalangeal": (MIDDLE, DISTAL),
}
DIRECTIONS: Final = np.array(
    [
        (x, y, z)
        for x in (-0.7, 0.0, 0.7)
        for y in (-0.7, 0.0, 0.7)
        for z in (-1.0, -0.7, 0.0, 0.7, 1.0)
        if 0.9 < math.hypot(x, y, z) < 1.25
    ]
)


def touches(placed: Placed, points: FloatArray) -> bool:
    """Whether a point is in a bone: its shaft or base, or an ellipsoid of its head."""
    local = (points - placed.frame.origin) @ placed.frame.axes
    outer = placed.shape.outer
    for x, y, z in local:
        if outer[0].at[2] <= z <= outer[-1].at[2]:
            wide, deep = half_mm(outer, z)
            if math.hypot(x / wide, (y - bowed_mm(outer, z)) / deep) < 1.0:
                return True
        for knob in placed.shape.knobs:
            away = (np.array((x, y, z)) - knob.center) / np.array(knob.semi_axes)
            if np.linalg.norm(away) < 1.0:
                return True
    return False


def bone_of(word: str) -> BoneName:
    """Return the bone that a word like ``index proximal`` names."""
    digit, _, kind = word.partition(" ")
    return (digit, kind)


def joint_of(word: str) -> tuple[BoneName, BoneName]:
    """Return the two bones of a joint."""
    digit, _, kind = word.partition(" ")
    inner, outer = _JOINTS[kind]
    return ((digit, inner), (digit, outer))


def half_mm(outer: Sequence[Station], z: float) -> tuple[float, float]:
    """Return half the width and half the depth of a bone at a place."""
    at = [station.at[2] for station in outer]
    wide = np.interp(z, at, [station.x[1] for station in outer])
    deep = np.interp(z, at, [station.b[1] for station in outer])
    return float(wide), float(deep)


def bowed_mm(outer: Sequence[Station], z: float) -> float:
    """Return how far a bone is bowed at a place."""
    return float(np.interp(z, [s.at[2] for s in outer], [s.at[1] for s in outer]))


def point_at(frame: Frame, local: Point) -> Point:
    """Return where a point of a bone's own frame is in the hand, rounded to a nanometre."""
    x, y, z = (round(float(value), 6) for value in frame.point(local))
    return (x, y, z)
