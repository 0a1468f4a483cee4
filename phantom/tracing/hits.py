"""First hits of a raster of rays, band by band, and of free rays."""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.scene import Phantom
from phantom.tracing.fields import leaf_fields, segment_fields

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]

_ROOM = 256
_SLOTS = 64


def picking_mm(phantom: Phantom) -> float:
    """Return what a solid must last along a ray to be seen: 1e-9 of the phantom's size."""
    return tolerances.PICKING * float(np.linalg.norm(np.ptp(phantom.bounds, axis=0)))


def face_slack_mm(phantom: Phantom) -> float:
    """Return how far a hit may lie from the plane or the section it is said to be on."""
    return 10.0 * tolerances.SURFACE_MM + picking_mm(phantom)


def hits_of_rays(
    phantom: Phantom, start: Floats, along: Floats, shown: Flags
) -> tuple[Floats, Ints]:
    """Return the distances (N,), inf for a miss, and the hits (N, 4) of rays already checked.

    What the four columns are, :mod:`phantom.kernels.first_hit` says.
    """
    from phantom.kernels import first_hit as kernels

    distances = np.full(len(start), np.inf)
    hits = np.full((len(start), 4), -1, dtype=np.int64)
    counter = np.zeros(1, dtype=np.int64)
    at, room = 0, _ROOM
    while at < len(start):
        stopped = kernels.first_hits(
            phantom.compiled.scene,
            start[at:],
            along[at:],
            shown,
            tolerances.CHORD_MM,
            picking_mm(phantom),
            room,
            distances[at:],
            hits[at:],
            counter,
        )
        if stopped < 0:
            break
        at, room = at + stopped, 4 * room
    return distances, hits


class HitRaster:
    """The first hits of a raster; rows may be asked for from several threads at once.

    Parameters
    ----------
    phantom
        What is traced.
    view
        (6, 3): origin of the ray of row 0 and column 0, its steps to the next row and column; the
        way to its end, which must lie beyond the phantom, and the steps of that way.
    rows, columns
        Size of the raster.
    shown
        (L,) 1 for the leaves that are seen.
    """

    def __init__(
        self, phantom: Phantom, view: Floats, rows: int, columns: int, shown: Flags
    ) -> None:
        self.phantom, self.view, self.columns, self.shown = phantom, view, columns, shown
        scene = phantom.compiled.scene
        self._fields = (
            leaf_fields(scene, view, rows, columns),
            segment_fields(scene, view, rows, columns),
        )
        self._own = threading.local()

    def rows(self, start: int, end: int) -> tuple[Floats, Ints]:
        """Return the distances (rows, columns) and the hits (rows, columns, 4) of some rows."""
        from phantom.kernels.first_hit import tile_hits
        from phantom.kernels.lanes import TILE_COLUMNS, TILE_ROWS
        from phantom.kernels.scratch import scratch

        scene = self.phantom.compiled.scene
        held = getattr(self._own, "scratch", None)
        if held is None:
            held = self._own.scratch = scratch(scene, 1, 2 * len(scene.leaf_radius) + _SLOTS)
        distances = np.full((end - start, self.columns), np.inf)
        hits = np.full((end - start, self.columns, 4), -1, dtype=np.int64)
        tiles = -(-(end - start) // TILE_ROWS) * -(-self.columns // TILE_COLUMNS)
        failed = np.empty((tiles, 2), dtype=np.int64)
        count = tile_hits(
            scene,
            self.view,
            *self._fields,
            start,
            end,
            tolerances.CHORD_MM,
            picking_mm(self.phantom),
            self.shown,
            held,
            distances,
            hits,
            failed,
        )
        for row, column in failed[:count]:
            part = (
                slice(row - start, min(row + TILE_ROWS, end) - start),
                slice(column, min(column + TILE_COLUMNS, self.columns)),
            )
            shape = distances[part].shape
            i, j = np.meshgrid(np.arange(shape[0]), np.arange(shape[1]), indexing="ij")
            origins, ways = self._rays((row + i).ravel(), (column + j).ravel())
            found = hits_of_rays(self.phantom, origins, ways, self.shown)
            distances[part], hits[part] = found[0].reshape(shape), found[1].reshape(*shape, 4)
        return distances, hits

    def _rays(self, row: Ints, column: Ints) -> tuple[Floats, Floats]:
        """Return origins and unit directions of some rays of the raster."""
        v, r, c = self.view, row[:, None], column[:, None]
        ways = v[3] + r * v[4] + c * v[5]
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        return v[0] + r * v[1] + c * v[2], ways
