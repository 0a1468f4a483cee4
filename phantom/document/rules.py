"""Rules that several shapes share: points apart, directions that are not parallel."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pydantic import ValidationInfo

from phantom.document.base import Point, Vector, refuse, same_place

PARALLEL_TOLERANCE = 1e-6
"""Sine of the angle under which two directions count as parallel."""


def end_apart(end: Point, info: ValidationInfo) -> Point:
    """Refuse an ``end`` at the ``start``."""
    if "start" in info.data and same_place(info.data["start"], end):
        refuse("degenerate", ((), "found the point of start; expected end apart from start"))
    return end


def neighbours_apart(points: Sequence[tuple[float, ...]], *, closed: bool, field: str) -> None:
    """Refuse points that equal the one before; on a closed curve the last also meets the first."""
    problems: list[tuple[tuple[str | int, ...], str]] = [
        ((field, i), f"found the same point as {field}/{i - 1}; expected neighbours apart")
        for i in range(1, len(points))
        if same_place(points[i - 1], points[i])
    ]
    last = len(points) - 1
    if closed and last > 0 and same_place(points[last], points[0]):
        message = f"found the same point as {field}/0; expected a closed curve not to repeat it"
        problems.append(((field, last), message))
    if problems:
        refuse("equal_points", *problems, whole=True)


def rejection(vector: Sequence[float], axis: Sequence[float]) -> Vector:
    """Return the part of a vector that is orthogonal to an axis."""
    length = math.hypot(*axis)
    unit = [component / length for component in axis]
    along = sum(v * e for v, e in zip(vector, unit, strict=True))
    x, y, z = (v - along * e for v, e in zip(vector, unit, strict=True))
    return (x, y, z)


def parallel(one: Sequence[float], other: Sequence[float]) -> bool:
    """Tell whether two directions are parallel, either way round."""
    return math.hypot(*rejection(one, other)) < PARALLEL_TOLERANCE * math.hypot(*one)
