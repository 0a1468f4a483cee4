"""Volumes from ray sums: the integral of parallel path lengths over a plane is the volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.scene import Phantom
from phantom.tracing.rays import trace

Floats = NDArray[np.float64]

_START = 64
_FINEST = 1024
_TARGET = 2e-4


@dataclass(frozen=True)
class Measure:
    """Volumes in mm3.

    Attributes
    ----------
    volume_mm3
        Of everything that is present; where densities overlap it counts for each.
    volume_by_material_mm3
        ``(M,)`` in the order of ``material_names``.
    relative_error
        Estimated from the last two resolutions, of the total.
    """

    volume_mm3: float
    volume_by_material_mm3: Floats
    relative_error: float


def measure(phantom: Phantom, *, cancelled: Callable[[], bool] | None = None) -> Measure:
    """Measure volumes by parallel rays on finer and finer grids, each ray exact.

    The rays run along a direction that is aligned with nothing, over a grid shifted by golden
    ratios, so that flat faces do not fall between rays. Raises :class:`CancelledError` once
    ``cancelled`` says yes.
    """
    along = np.array([0.2863, 0.4421, 0.8500])
    along /= np.linalg.norm(along)
    e1 = np.cross(along, [1.0, 0.0, 0.0])
    e1 /= np.linalg.norm(e1)
    e2 = np.cross(along, e1)
    low, high = phantom.bounds
    corners = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )
    a, b = corners @ e1, corners @ e2
    depth = float((corners @ along).min()) - 1.0
    previous: Floats | None = None
    size = _START
    while True:
        origins, area = _grid(e1, e2, (a.min(), np.ptp(a)), (b.min(), np.ptp(b)), size)
        origins += depth * along
        directions = np.broadcast_to(along, origins.shape).copy()
        volumes = trace(phantom, origins, directions, cancelled).mean(axis=0) * area
        total = float(volumes.sum())
        if previous is not None:
            # Twice the resolution leaves at most half of the error for boundaries of any kind;
            # material by material, so that what one gains another does not hide.
            error = float(np.abs(volumes - previous).sum()) / max(total, 1e-300)
            if error <= _TARGET or size >= _FINEST:
                return Measure(total, volumes, error)
        previous, size = volumes, 2 * size


def _grid(
    e1: Floats,
    e2: Floats,
    across: tuple[float, float],
    up: tuple[float, float],
    size: int,
) -> tuple[Floats, float]:
    """Return ``size**2`` points of a rectangle, each column shifted, and its area."""
    i, j = np.meshgrid(np.arange(size), np.arange(size), indexing="ij")
    x = (i.ravel() + 0.5) / size
    y = np.mod((j.ravel() + 0.5) / size + x * 0.6180339887498949, 1.0)
    points = (across[0] + x * across[1])[:, None] * e1 + (up[0] + y * up[1])[:, None] * e2
    return points, float(across[1] * up[1])
