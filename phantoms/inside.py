"""Whether a point lies inside a swept part, as seen from the sections that it lies between."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from phantom.document import Vector

if TYPE_CHECKING:
    from phantoms.parts import Station

FloatArray = NDArray[np.float64]


def inside(
    stations: Sequence[Station],
    point: FloatArray,
    margin_mm: float = 0.0,
    up: Vector = (1.0, 0.0, 0.0),
) -> bool:
    """Whether a point lies in the elliptic sections of a part, that far from its surface.

    Parameters
    ----------
    stations, up
        As for :func:`phantoms.parts.swept`; sections of any outline are taken as ellipses.
    margin_mm
        Taken off every half-width; a negative one is put on.
    """
    for before, after in pairwise(stations):
        start, end = np.array(before.at), np.array(after.at)
        along = end - start
        share = float((point - start) @ along / (along @ along))
        if not 0.0 <= share <= 1.0:
            continue
        tangent = along / np.linalg.norm(along)
        across = np.array(up) - (tangent @ np.array(up)) * tangent
        across /= np.linalg.norm(across)
        away = point - start - share * along
        low, high = (
            (1 - share) * np.array([before.x[end_], before.b[end_]])
            + share * np.array([after.x[end_], after.b[end_]])
            for end_ in (0, 1)
        )
        place = np.array([away @ across, away @ np.cross(tangent, across)])
        half = (high - low) / 2 - margin_mm
        if (half > 0).all() and np.linalg.norm((place - (high + low) / 2) / half) < 1.0:
            return True
    return False
