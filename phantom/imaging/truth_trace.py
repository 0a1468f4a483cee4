"""Tracing the ground truth: the picture's own rays, with a channel for every leaf.

The scene is that of the radiograph but for the channels that path lengths are added to, so the
leaves of a material add up to that material's path length.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.camera import Projection, projection
from phantom.imaging.truth import KINDS, Box, FloatArray, Kind, Landmark, LeafTruth, Truth
from phantom.imaging.truth_depth import Depths, depths
from phantom.imaging.view import View
from phantom.scene import Phantom

if TYPE_CHECKING:
    from phantom.document import Document

BAND_NUMBERS: Final = 2**25
"""Most numbers, pixels times leaves, that are traced at once."""


@dataclass(frozen=True, eq=False)
class _Apart(Phantom):
    """A phantom whose every named leaf counts as a material of its own."""

    names: tuple[str, ...]

    @property
    def material_names(self) -> tuple[str, ...]:
        return self.names


def ground_truth(
    phantom: Phantom,
    view: View,
    kinds: Iterable[str] = KINDS,
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Truth:
    """Return what a radiograph of the phantom from this view shows, leaf by leaf.

    Rays run from the view's source to the centres of the pixels.

    Parameters
    ----------
    phantom, view
        As for :func:`phantom.imaging.radiograph`.
    kinds
        Some of :data:`phantom.imaging.truth.KINDS`. ``entry_depth`` and ``centroids`` need the ends
        of every leaf along every ray, a second trace.
    workers, cancelled, progress
        As in :func:`phantom.tracing.raster`.

    Raises
    ------
    InvalidInputError
        An unknown kind.
    CancelledError
        ``cancelled`` turned true.
    """
    chosen = check_kinds(kinds)
    camera = projection(view)
    leaves = phantom.named_leaves
    names = tuple(phantom.leaf_names[i] for i in leaves)
    size = (view.detector.columns, view.detector.rows)
    crops: list[tuple[Box | None, FloatArray]] = [(None, np.zeros((0, 0)))] * len(leaves)
    if leaves and {*chosen} - {"landmarks"}:
        crops = _traced(phantom, view, leaves, names, workers, cancelled, progress)
    found: Depths | None = None
    if leaves and {"entry_depth", "centroids"} & {*chosen}:
        found = depths(phantom, view, camera, leaves, crops, cancelled)
    materials = [phantom.material_names[phantom.leaf_materials[i]] for i in leaves]
    entries = found.entries_mm if found is not None and "entry_depth" in chosen else None
    measured = found if found is not None and "centroids" in chosen else None
    parts = tuple(
        LeafTruth(
            name=names[k],
            material=materials[k],
            size=size,
            box=box,
            thickness_in_box_mm=_sealed(crop),
            entry_in_box_mm=None if entries is None else _sealed(entries[k]),
            centroid_mm=None if measured is None else measured.centroids_mm[k],
            volume_mm3=None if measured is None else measured.volumes_mm3[k],
        )
        for k, (box, crop) in enumerate(crops)
    )
    document = phantom.document
    return Truth(
        kinds=chosen,
        size=size,
        leaves=parts,
        centroids_px=tuple(_pixel(camera, leaf.centroid_mm) for leaf in parts),
        landmarks=_landmarks(document, camera, size),
        findings=tuple((f.name, tuple(f.leaves)) for f in document.findings),
    )


def check_kinds(kinds: Iterable[str]) -> tuple[Kind, ...]:
    """Return the kinds in the order of :data:`KINDS`, each once.

    Raises
    ------
    InvalidInputError
        One is not known (``/truth``).
    """
    given = [kinds] if isinstance(kinds, str) else list(kinds)
    unknown = [
        Problem(f"/truth/{i}", "unknown_value", f"found {k!r}; expected one of {', '.join(KINDS)}")
        for i, k in enumerate(given)
        if k not in KINDS
    ]
    if unknown:
        raise InvalidInputError(unknown)
    return tuple(kind for kind in KINDS if kind in given)


def _traced(
    phantom: Phantom,
    view: View,
    leaves: tuple[int, ...],
    names: tuple[str, ...],
    workers: int | None,
    cancelled: Callable[[], bool] | None,
    progress: Callable[[int, int], None] | None,
) -> list[tuple[Box | None, FloatArray]]:
    """Return each leaf's box and its thickness there, traced in bands of rows."""
    from phantom.tracing import raster

    scene = phantom.compiled.scene
    channels = np.full(len(scene.leaf_material), -1, dtype=np.int64)
    channels[list(leaves)] = np.arange(len(leaves))
    channels.setflags(write=False)
    compiled = replace(phantom.compiled, scene=scene._replace(leaf_material=channels))
    apart = _Apart(phantom.document, compiled, names)
    detector = view.detector
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    size = max(1, BAND_NUMBERS // (detector.columns * len(leaves)))
    pieces: list[list[tuple[int, int, FloatArray]]] = [[] for _ in leaves]
    for start in range(0, detector.rows, size):
        rows = min(size, detector.rows - start)

        def told(done: int, _: int, start: int = start) -> None:
            assert progress is not None
            progress(start + done, detector.rows)

        lengths = raster(
            apart,
            source=None if view.source is None else np.asarray(view.source, dtype=np.float64),
            direction=None if view.direction is None else np.asarray(view.direction, np.float64),
            first_pixel=detector.pixel(0, 0) + start * (pitch_y * down),
            column_step=pitch_x * right,
            row_step=pitch_y * down,
            columns=detector.columns,
            rows=rows,
            workers=workers,
            cancelled=cancelled,
            progress=None if progress is None else told,
        )
        for k in range(len(leaves)):
            part = _cropped(lengths[..., k])
            if part is not None:
                row, column, values = part
                pieces[k].append((start + row, column, values))
    return [_joined(parts) for parts in pieces]


def _cropped(values: FloatArray) -> tuple[int, int, FloatArray] | None:
    """Return the first row, the first column and the part of an array that is above 0."""
    (rows,) = np.nonzero(values.any(axis=1))
    if not len(rows):
        return None
    band = values[rows[0] : rows[-1] + 1]
    (columns,) = np.nonzero(band.any(axis=0))
    return int(rows[0]), int(columns[0]), band[:, columns[0] : columns[-1] + 1].copy()


def _joined(parts: list[tuple[int, int, FloatArray]]) -> tuple[Box | None, FloatArray]:
    """Return the box around the parts, and what is in it."""
    if not parts:
        return None, np.zeros((0, 0))
    top, left = min(row for row, _, _ in parts), min(column for _, column, _ in parts)
    bottom = max(row + part.shape[0] for row, _, part in parts)
    edge = max(column + part.shape[1] for _, column, part in parts)
    whole = np.zeros((bottom - top, edge - left))
    for row, column, part in parts:
        y, x = row - top, column - left
        whole[y : y + part.shape[0], x : x + part.shape[1]] = part
    return Box(left, top, edge - 1, bottom - 1), whole


def _landmarks(
    document: Document, camera: Projection, size: tuple[int, int]
) -> dict[str, Landmark]:
    found = {}
    for name, point in document.landmarks.items():
        world = (float(point[0]), float(point[1]), float(point[2]))
        pixel = _pixel(camera, world)
        inside = pixel is not None and all(
            -0.5 < at < count - 0.5 for at, count in zip(pixel, size, strict=True)
        )
        found[name] = Landmark(world, pixel, inside)
    return found


def _pixel(
    camera: Projection, point: tuple[float, float, float] | None
) -> tuple[float, float] | None:
    """Return the column and row of a point; None for none, and at or behind the source."""
    if point is None:
        return None
    column, row = camera.project(np.array([point]))[0]
    return None if np.isnan(column) else (float(column), float(row))


def _sealed(array: NDArray[np.float64]) -> FloatArray:
    array.setflags(write=False)
    return array
