"""A focal spot of finite size, as source points with weights."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from phantom.imaging.detection.acquisition import FocalSpot
from phantom.imaging.view import FloatArray, View

FWHM_PER_SIGMA: Final = 2 * math.sqrt(2 * math.log(2))

_REACH: Final = 3.0
"""A gaussian focal spot is cut off this many standard deviations from its middle."""


def source_points(view: View, spot: FocalSpot | None) -> list[tuple[float, FloatArray | None]]:
    """Return the source points of a view, each a weight and a (3,) point in mm.

    The weights add to one; intensities, not path lengths, are averaged with them. Along each axis
    the spot is cut into equal parts with a point in the middle of each, brought nearer together or
    farther apart so that their variance is that of the spot: the width of a penumbra, as a standard
    deviation, is then exact with any number of points above one.

    A parallel beam has one point, None, whatever the spot.
    """
    if view.source is None:
        return [(1.0, None)]
    source = np.asarray(view.source, dtype=np.float64)
    if spot is None:
        return [(1.0, source)]
    right, down = view.detector.axes
    across, along = (
        _along(size, count, spot.shape)
        for size, count in zip(spot.size_mm, spot.points, strict=True)
    )
    return [
        (wx * wy, source + x * right + y * down)
        for y, wy in zip(*along, strict=True)
        for x, wx in zip(*across, strict=True)
    ]


def _along(size_mm: float, count: int, shape: str) -> tuple[list[float], list[float]]:
    """Return the positions in mm and the weights of the points along one axis."""
    if count == 1:
        return [0.0], [1.0]
    middles = (np.arange(count) + 0.5) / count - 0.5
    if shape == "uniform":
        sigma = size_mm / math.sqrt(12)
        weights = np.full(count, 1 / count)
    else:
        from scipy.special import ndtr

        sigma = size_mm / FWHM_PER_SIGMA
        edges = 2 * _REACH * (np.arange(count + 1) / count - 0.5)
        weights = np.diff(ndtr(edges))
        weights = weights / weights.sum()
    positions = middles * (sigma / math.sqrt(float(weights @ middles**2)))
    return positions.tolist(), weights.tolist()
