"""Which pixels of a raster can see a leaf or a segment: the shadow of its box."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MARGIN = 1e-6
"""Pixels that a shadow is taken wider by, against rounding."""

_CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def leaf_fields(scene: Scene, view: Floats, rows: int, columns: int) -> Ints:
    """Return (L, 4): first and last row and column, half-open, of every leaf's box."""
    box = scene.leaf_box
    return _fields(
        np.where(_CORNERS[None] == 1, box[:, None, 1], box[:, None, 0]), view, rows, columns
    )


def segment_fields(scene: Scene, view: Floats, rows: int, columns: int) -> Ints:
    """Return (S, 4): first and last row and column, half-open, of every segment's box."""
    parts = np.repeat(np.arange(len(scene.first_segment) - 1), np.diff(scene.first_segment))
    leaf = np.repeat(np.arange(len(scene.leaf_radius)), np.diff(scene.first_part))[parts]
    along = np.where(_CORNERS[None] == 1, scene.boxes[:, None, :, 1], scene.boxes[:, None, :, 0])
    corners = np.einsum("sca,sax->scx", along, scene.axes)
    corners += (scene.origins + scene.leaf_center[leaf])[:, None]
    return _fields(corners, view, rows, columns)


def _fields(corners: Floats, view: Floats, rows: int, columns: int) -> Ints:
    """Project (n, 8, 3) corners; where one is not before the source, everything may be seen."""
    away = corners - view[0]
    # Either the origin moves from pixel to pixel or the direction does.
    if view[1].any() or view[2].any():
        i, j, _ = np.linalg.solve(
            np.stack([view[1], view[2], view[3]], axis=1), away.reshape(-1, 3).T
        )
        depth = np.ones_like(i)
    else:
        i, j, depth = np.linalg.solve(
            np.stack([view[4], view[5], view[3]], axis=1), away.reshape(-1, 3).T
        )
    shape = corners.shape[:2]
    depth = depth.reshape(shape)
    behind = depth.min(axis=1) <= 1e-9
    with np.errstate(divide="ignore", invalid="ignore"):
        i, j = i.reshape(shape) / depth, j.reshape(shape) / depth
    fields = np.empty((len(corners), 4), dtype=np.int64)
    for column, (at, size) in enumerate(((i, rows), (j, columns))):
        low, high = at.min(axis=1) - _MARGIN, at.max(axis=1) + _MARGIN
        low, high = np.where(behind, 0.0, low), np.where(behind, float(size), high)
        fields[:, 2 * column] = np.clip(np.ceil(low), 0, size)
        fields[:, 2 * column + 1] = np.clip(np.floor(high) + 1, 0, size)
    return fields
