"""Lines on a raster: how much of each pixel a line of some width covers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_STEP = 0.1
"""Dots along a line, in pixels: the ripple of the edge they leave is a hundredth of a pixel."""


def covered(runs: Sequence[Floats], rows: int, columns: int, width: float) -> Floats:
    """Return the share (rows, columns) of each pixel that lines cover, 0 to 1.

    Parameters
    ----------
    runs
        Each ``(n, 2)`` columns and rows; the centre of a pixel is at whole numbers.
    rows, columns
        Size of the raster.
    width
        Of the lines, in pixels; their ends are round.
    """
    found = np.zeros(rows * columns)
    reach = int(np.ceil(0.5 * width + 0.5))
    steps = np.arange(-reach, reach + 1)
    for run in runs:
        dots = _dots(run)
        seen = np.all((dots > -reach - 1) & (dots < np.array([columns, rows]) + reach), axis=1)
        dots = dots[seen]
        nearest = np.rint(dots).astype(np.int64)
        for below in steps:
            for across in steps:
                column, row = nearest[:, 0] + across, nearest[:, 1] + below
                inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
                away = np.hypot(column - dots[:, 0], row - dots[:, 1])
                share = np.clip(0.5 * width + 0.5 - away, 0.0, 1.0) * min(width, 1.0)
                np.maximum.at(found, (row * columns + column)[inside], share[inside])
    return found.reshape(rows, columns)


def _dots(run: Floats) -> Floats:
    """Spread points along a run."""
    lengths = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(run, axis=0), axis=1)))
    count = int(lengths[-1] / _STEP) + 2
    at = np.linspace(0.0, lengths[-1], count)
    return np.stack([np.interp(at, lengths, run[:, k]) for k in (0, 1)], axis=-1)
