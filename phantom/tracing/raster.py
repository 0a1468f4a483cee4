"""A detector raster: the path lengths from source to every pixel."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.scene import Phantom
from phantom.tracing.pool import cut_bands, run_bands

Floats = NDArray[np.float64]

_BAND_PIXELS = 16384
_ROOM = 256


def raster(
    phantom: Phantom,
    *,
    source: Floats | None,
    direction: Floats | None,
    first_pixel: Floats,
    column_step: Floats,
    row_step: Floats,
    columns: int,
    rows: int,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Floats:
    """Trace one ray to the centre of every pixel.

    Parameters
    ----------
    phantom
        What is traced.
    source
        Point source in mm, or None for a parallel beam.
    direction
        Direction of a parallel beam, of any length; its rays start before the whole scene.
    first_pixel
        Centre of pixel (row 0, column 0) in mm.
    column_step, row_step
        From one pixel centre to the next along a row, and to the next row, in mm.
    columns, rows
        Size of the raster.
    workers, cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts rows.

    Returns
    -------
    ``(rows, columns, M)`` mm of each material between source and pixel.

    Raises
    ------
    CancelledError
        Where ``cancelled`` said yes.
    """
    from phantom.kernels import rays as kernels

    first = np.ascontiguousarray(first_pixel, dtype=np.float64)
    across = np.ascontiguousarray(column_step, dtype=np.float64)
    down = np.ascontiguousarray(row_step, dtype=np.float64)
    parallel = source is None
    if source is not None:
        origin = np.ascontiguousarray(source, dtype=np.float64)
    else:
        along = np.asarray(direction, dtype=np.float64)
        along = along / np.linalg.norm(along)
        origin = -along * _before(phantom, along, first, across * (columns - 1), down * (rows - 1))
    out = np.zeros((rows, columns, len(phantom.material_names)))

    def band(start: int, end: int) -> None:
        room, at = _ROOM, start
        counter = np.zeros(1, dtype=np.int64)
        while at < end:
            stopped = kernels.raster(
                phantom.compiled.scene,
                origin,
                parallel,
                first,
                across,
                down,
                at,
                tolerances.CHORD_MM,
                room,
                out[at:end],
                counter,
            )
            if stopped < 0:
                return
            # The row that ran out of room is done anew, whole.
            out[at + stopped] = 0.0
            at, room = at + stopped, 4 * room

    size = max(1, _BAND_PIXELS // max(columns, 1))
    run_bands(band, cut_bands(rows, size), workers=workers, cancelled=cancelled, progress=progress)
    return out


def _before(phantom: Phantom, along: Floats, first: Floats, width: Floats, height: Floats) -> float:
    """How far before the detector a parallel ray must start to lie before the whole scene."""
    scene = phantom.compiled.scene
    corners = first + np.array([[0.0], [1.0], [0.0], [1.0]]) * width
    corners = corners + np.array([[0.0], [0.0], [1.0], [1.0]]) * height
    nearest = float((scene.leaf_center @ along - scene.leaf_radius).min())
    return max(float((corners @ along).max()) - nearest, 0.0) + 1.0
