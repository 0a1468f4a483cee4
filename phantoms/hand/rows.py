"""Bones drawn by level sections in the hand's frame: carpals and the ends of the forearm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phantom.document import Point
from phantoms.parts import Station

Row = tuple[float, float, float, float, float]
"""A section: z, x of the ulnar and of the radial border, y of the palmar and of the back face."""


def upright(rows: Sequence[Row], scale: float) -> list[Station]:
    """Return the sections, that much larger, on one upright axis, so that each is level."""
    table = scale * np.array(rows)
    x, y = float(table[:, 1:3].mean()), float(table[:, 3:5].mean())
    return [
        Station((x, y, z), (low - x, high - x), (palm - y, back - y))
        for z, low, high, palm, back in table.tolist()
    ]


def times(values: Point, by: float) -> Point:
    """Return a point or the semi-axes of an ellipsoid that much larger."""
    x, y, z = values
    return (by * x, by * y, by * z)


def plus(values: Point, more: float) -> Point:
    """Return semi-axes longer by that much."""
    x, y, z = values
    return (x + more, y + more, z + more)
