"""Which leaves leave the field of a detector.

A leaf is cut by the field where a ray to the detector's border meets it. A leaf that no border ray
meets lies wholly inside or wholly outside, and its projected bounding box says which.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.vectors import box_corners
from phantom.imaging.camera import Projection
from phantom.imaging.view import FloatArray, View, unit

if TYPE_CHECKING:
    from phantom.scene import Phantom


def border(view: View) -> FloatArray:
    """Return (B, 3) world points around the edge of the field, about one pixel apart, in mm.

    The edge runs half a pixel outside the outermost pixel centres.
    """
    detector = view.detector
    columns, rows = detector.columns, detector.rows
    across = np.linspace(-0.5, columns - 0.5, columns + 1)
    along = np.linspace(-0.5, rows - 0.5, rows + 1)
    grid = np.concatenate(
        [
            np.column_stack([across, np.full_like(across, -0.5)]),
            np.column_stack([across, np.full_like(across, rows - 0.5)]),
            np.column_stack([np.full_like(along, -0.5), along]),
            np.column_stack([np.full_like(along, columns - 0.5), along]),
        ]
    )
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    points: FloatArray = detector.pixel(0, 0) + (
        grid[:, :1] * (pitch_x * right) + grid[:, 1:] * (pitch_y * down)
    )
    return points


def truncated(phantom: Phantom, view: View, camera: Projection) -> tuple[str, ...]:
    """Return the names of the leaves that are not wholly in the field, in the document's order."""
    shown = np.asarray(phantom.leaf_materials) >= 0
    boxes = np.asarray(phantom.leaf_bounds, dtype=np.float64)
    corners = np.stack([box_corners(box) for box in boxes]).reshape(-1, 3)
    with np.errstate(invalid="ignore"):  # a leaf without bounds is inside of nothing
        inside = _in_field(camera.project(corners), view).reshape(-1, 8).all(axis=1)
    doubtful = shown & ~inside
    if not doubtful.any():
        return ()
    cut = _cut_by_border(phantom, view)
    centers = np.mean(phantom.leaf_bounds, axis=1)
    outside = ~_in_field(camera.project(centers), view)
    leaves = doubtful & (cut | outside)
    return tuple(name for name, out in zip(phantom.leaf_names, leaves, strict=True) if out)


def _in_field(image: FloatArray, view: View) -> NDArray[np.bool_]:
    size = np.array([view.detector.columns, view.detector.rows])
    found: NDArray[np.bool_] = np.all((image > -0.5) & (image < size - 0.5), axis=-1)
    return found


def _cut_by_border(phantom: Phantom, view: View) -> NDArray[np.bool_]:
    """Return (L,) whether the border's rays meet the leaf between the source and the detector."""
    from phantom.tracing import intervals

    ends = border(view)
    if view.source is not None:
        origins = np.broadcast_to(np.asarray(view.source, dtype=np.float64), ends.shape)
    else:
        assert view.direction is not None
        reach = np.abs(np.asarray(phantom.bounds)).max() + np.abs(ends).max()
        origins = ends - 4.0 * reach * unit(view.direction)
    lengths = np.linalg.norm(ends - origins, axis=1)
    hits = intervals(phantom, np.ascontiguousarray(origins), ends - origins)
    cut = np.zeros(len(phantom.leaf_names), dtype=np.bool_)
    cut[hits.leaf[hits.entry_mm < lengths[hits.ray]]] = True
    return cut
