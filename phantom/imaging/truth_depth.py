"""Where rays enter and leave the leaves: entry depths, and centroids of what the field shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from phantom.errors import CancelledError
from phantom.geometry.vectors import box_corners
from phantom.imaging.camera import Projection
from phantom.imaging.truth import Box, FloatArray
from phantom.imaging.view import View, unit

if TYPE_CHECKING:
    from phantom.scene import Phantom

Ints = NDArray[np.int64]

BAND_RAYS: Final = 2**16


@dataclass(frozen=True)
class Depths:
    """What the ends along the rays tell of each leaf.

    Attributes
    ----------
    entries_mm
        The depth of the first entry along the camera's axis, (rows, columns) of the leaf's box,
        nan where it is missed.
    centroids_mm
        Middle of the volume; None for a leaf that no ray meets.
    volumes_mm3
        Of the part between the source and the field.
    """

    entries_mm: tuple[FloatArray, ...]
    centroids_mm: tuple[tuple[float, float, float] | None, ...]
    volumes_mm3: tuple[float, ...]


def depths(
    phantom: Phantom,
    view: View,
    camera: Projection,
    leaves: tuple[int, ...],
    crops: list[tuple[Box | None, FloatArray]],
    cancelled: Callable[[], bool] | None,
) -> Depths:
    """Trace the rays to the pixels of all masks once more, for the ends along them.

    A pixel stands for a pyramid of rays (a prism for a parallel beam), as if all of them ran like
    the one to its centre: a piece from a to b has ∫ r² dr of the solid angle's volume.
    """
    from phantom.tracing import intervals

    channel = np.full(len(phantom.leaf_names), -1, dtype=np.int64)
    channel[list(leaves)] = np.arange(len(leaves))
    entries = [np.full(crop.shape, np.nan) for _, crop in crops]
    volumes, moments = np.zeros(len(leaves)), np.zeros((len(leaves), 3))
    for rows, columns in _seen(view, crops):
        if cancelled is not None and cancelled():
            raise CancelledError("the trace was cancelled")
        origins, along, ends = _rays(phantom, view, rows, columns)
        hits = intervals(phantom, origins, along)
        of = channel[hits.leaf]
        kept = (of >= 0) & (hits.entry_mm < ends[hits.ray])
        ray, of, near = hits.ray[kept], of[kept], hits.entry_mm[kept]
        far = np.minimum(hits.exit_mm[kept], ends[ray])
        depth = camera.depth_mm(origins[ray] + near[:, np.newaxis] * along[ray])
        for k in np.unique(of):
            box, first = crops[k][0], np.flatnonzero(of == k)
            if box is None:
                continue
            # Within a ray, pieces come by entry: the first of each ray is where it enters.
            which, at = np.unique(ray[first], return_index=True)
            y, x = rows[which] - box.first_row, columns[which] - box.first_column
            inside = (y >= 0) & (y < entries[k].shape[0]) & (x >= 0) & (x < entries[k].shape[1])
            entries[k][y[inside], x[inside]] = depth[first[at]][inside]
        volume, reach = _volumes(view, camera, ends[ray], near, far)
        middle = origins[ray] + reach[:, np.newaxis] * along[ray]
        volumes += np.bincount(of, volume, len(leaves))
        for axis in range(3):
            moments[:, axis] += np.bincount(of, volume * middle[:, axis], len(leaves))
    for k, (_, crop) in enumerate(crops):
        entries[k][crop == 0.0] = np.nan
    centroids = tuple(
        (float(x / v), float(y / v), float(z / v)) if v > 0 else None
        for v, (x, y, z) in zip(volumes, moments, strict=True)
    )
    return Depths(tuple(entries), centroids, tuple(float(v) for v in volumes))


def _seen(view: View, crops: list[tuple[Box | None, FloatArray]]) -> Iterator[tuple[Ints, Ints]]:
    """Yield rows and columns of the pixels that any mask has, so many at a time."""
    seen = np.zeros((view.detector.rows, view.detector.columns), dtype=np.bool_)
    for box, crop in crops:
        if box is not None:
            seen[box.first_row : box.last_row + 1, box.first_column : box.last_column + 1] |= (
                crop > 0
            )
    rows, columns = np.nonzero(seen)
    for start in range(0, len(rows), BAND_RAYS):
        yield rows[start : start + BAND_RAYS], columns[start : start + BAND_RAYS]


def _rays(
    phantom: Phantom, view: View, rows: Ints, columns: Ints
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return origins, unit directions and distances of the pixels."""
    detector = view.detector
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    pixels = detector.pixel(0, 0) + (
        columns[:, np.newaxis] * (pitch_x * right) + rows[:, np.newaxis] * (pitch_y * down)
    )
    if view.source is not None:
        origins = np.tile(np.asarray(view.source, dtype=np.float64), (len(pixels), 1))
    else:
        assert view.direction is not None
        beam = unit(view.direction)
        before = float((box_corners(phantom.bounds) @ beam).min()) - 1.0
        back = np.maximum(pixels @ beam - before, 1.0)
        origins = pixels - back[:, np.newaxis] * beam
    spans = pixels - origins
    lengths = np.linalg.norm(spans, axis=1)
    return origins, spans / lengths[:, np.newaxis], lengths


def _volumes(
    view: View, camera: Projection, ends: FloatArray, near: FloatArray, far: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the volume of each piece, and how far along the ray its middle is."""
    pitch_x, pitch_y = view.detector.pitch_xy_mm
    if camera.distance_mm is None:
        assert view.direction is not None
        across = abs(float(unit(view.direction) @ view.detector.normal))
        return pitch_x * pitch_y * across * (far - near), 0.5 * (near + far)
    solid_angle = pitch_x * pitch_y * camera.distance_mm / ends**3
    cubes = (far**3 - near**3) / 3.0
    reach = (far**4 - near**4) / 4.0 / np.maximum(cubes, np.finfo(np.float64).tiny)
    return solid_angle * cubes, reach
