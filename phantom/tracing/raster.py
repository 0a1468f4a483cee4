"""A detector raster: the path lengths from source to every pixel."""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.geometry import tolerances
from phantom.scene import Phantom
from phantom.tracing.fields import leaf_fields, segment_fields
from phantom.tracing.pool import cut_bands, run_bands

Floats = NDArray[np.float64]

Each = Callable[[int, Floats], None]

_BAND_PIXELS = 8192
_ROOM = 256
_SLOTS = 64


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
    each: Each | None = None,
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
    each
        Called with every band as soon as it is traced; see :func:`raster_bands`.

    Returns
    -------
    ``(rows, columns, M)`` mm of each material between source and pixel; the pixels of one material
    lie together.

    Raises
    ------
    CancelledError
        Where ``cancelled`` said yes.
    """
    view = _view(phantom, source, direction, first_pixel, column_step, row_step, columns, rows)
    out = np.zeros((len(phantom.material_names), rows, columns))
    _fill(phantom, view, columns, rows, out, each, workers, cancelled, progress)
    return np.moveaxis(out, 0, -1)


def raster_bands(
    phantom: Phantom,
    each: Each,
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
) -> None:
    """Trace a raster band by band, and keep no more of it than the bands at work.

    Parameters
    ----------
    each
        Called with the first row of a band and its path lengths, ``(M, rows, columns)`` mm, on the
        thread that traced them; the array is filled anew after that. The numbers are those that
        :func:`raster` gives.

    The others are those of :func:`raster`.

    Raises
    ------
    CancelledError
        Where ``cancelled`` said yes.
    """
    view = _view(phantom, source, direction, first_pixel, column_step, row_step, columns, rows)
    _fill(phantom, view, columns, rows, None, each, workers, cancelled, progress)


def _fill(
    phantom: Phantom,
    view: Floats,
    columns: int,
    rows: int,
    out: Floats | None,
    each: Each | None,
    workers: int | None,
    cancelled: Callable[[], bool] | None,
    progress: Callable[[int, int], None] | None,
) -> None:
    """Trace into ``out`` (M, rows, columns) of zeros, or into an array a thread where None."""
    from phantom.kernels.lanes import TILE_COLUMNS, TILE_ROWS
    from phantom.kernels.scratch import scratch
    from phantom.kernels.tiles import tiles

    scene = phantom.compiled.scene
    seen = leaf_fields(scene, view, rows, columns), segment_fields(scene, view, rows, columns)
    channels = len(phantom.material_names)
    size = max(1, _BAND_PIXELS // max(columns, 1) // TILE_ROWS) * TILE_ROWS
    slots = 2 * len(scene.leaf_radius) + _SLOTS
    own = threading.local()

    def band(start: int, end: int) -> None:
        if not hasattr(own, "held"):
            own.held = scratch(scene, channels, slots)
            own.into = np.empty((channels, size, columns)) if out is None else out
        into, above = own.into, 0
        if out is None:
            into.view(np.uint8).fill(0)  # faster than to fill in 0.0
            above = start
        failed = np.empty((-(-size // TILE_ROWS) * -(-columns // TILE_COLUMNS), 2), dtype=np.int64)
        count = tiles(
            scene, view, *seen, start, end, tolerances.CHORD_MM, own.held, into, above, failed
        )
        for row, column in failed[:count]:
            last = min(row + TILE_ROWS, end)
            tile = into[:, row - above : last - above, column : column + TILE_COLUMNS]
            _ray_by_ray(scene, view, int(row), int(column), tile)
        if each is not None:
            each(start, into[:, start - above : end - above])

    run_bands(band, cut_bands(rows, size), workers=workers, cancelled=cancelled, progress=progress)


def _view(
    phantom: Phantom,
    source: Floats | None,
    direction: Floats | None,
    first_pixel: Floats,
    column_step: Floats,
    row_step: Floats,
    columns: int,
    rows: int,
) -> Floats:
    """Return (6, 3): origin, its steps to the next row and column, way to the pixel, its steps."""
    first, across, down = (
        np.asarray(a, dtype=np.float64) for a in (first_pixel, column_step, row_step)
    )
    view = np.zeros((6, 3))
    if source is not None:
        view[0], view[3] = source, first - np.asarray(source, dtype=np.float64)
        view[4], view[5] = down, across
        return view
    along = np.asarray(direction, dtype=np.float64)
    along = along / np.linalg.norm(along)
    along *= _before(phantom, along, first, across * (columns - 1), down * (rows - 1))
    view[0], view[1], view[2], view[3] = first - along, down, across, along
    return view


def _ray_by_ray(scene: Scene, view: Floats, row: int, column: int, out: Floats) -> None:
    """Fill a tile (M, rows, columns) that meets more than the batched kernels have room for."""
    from phantom.kernels import rays as kernels

    found = np.zeros((*out.shape[1:], out.shape[0]))
    at, room, counter = 0, _ROOM, np.zeros(1, dtype=np.int64)
    while at < len(found):
        stopped = kernels.raster(
            scene, view, row + at, column, tolerances.CHORD_MM, room, found[at:], counter
        )
        if stopped < 0:
            break
        # The row that ran out of room is done anew, whole.
        found[at + stopped] = 0.0
        at, room = at + stopped, 4 * room
    out[:] = np.moveaxis(found, -1, 0)


def _before(phantom: Phantom, along: Floats, first: Floats, width: Floats, height: Floats) -> float:
    """How far before the detector a parallel ray must start to lie before the whole scene."""
    scene = phantom.compiled.scene
    corners = first + np.array([[0.0], [1.0], [0.0], [1.0]]) * width
    corners = corners + np.array([[0.0], [0.0], [1.0], [1.0]]) * height
    nearest = float((scene.leaf_center @ along - scene.leaf_radius).min())
    return max(float((corners @ along).max()) - nearest, 0.0) + 1.0
