"""A raster of rays on tessellated leaves: the depth and the facet that each sees first.

Every crossing of a pixel's ray with the meshes is kept, so the operators are taken on the pixel's
own intervals, as the exact renderer takes them on those of the exact solids.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.vectors import dots
from phantom.scene import Phantom
from phantom.tessellation import Mesh
from phantom.visible.camera import Camera

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]

_CREASE = 0.8
"""Facets whose normals differ by more than this cosine are shaded apart."""

_ROOM = 6
_NEAR = 1e-9
SLIVER = 1e-7
"""What is thinner than this share of the depth of the picture is not seen."""


@dataclass(frozen=True, eq=False)
class Facets:
    """All triangles of a phantom's leaves.

    Attributes
    ----------
    corners
        ``(T, 3, 3)`` mm.
    normals
        ``(T, 3, 3)`` unit normals at the corners, smooth but for creases.
    leaf
        ``(T,)`` whose they are.
    tolerance_mm
        How far they lie from the surface at most.
    """

    corners: Floats
    normals: Floats
    leaf: Ints
    tolerance_mm: float


def facets(meshes: tuple[Mesh, ...], tolerance_mm: float) -> Facets:
    """Join the meshes of a phantom's leaves, and smooth the normals of their corners."""
    return Facets(
        np.concatenate([mesh.vertices[mesh.triangles] for mesh in meshes]),
        np.concatenate([_smooth(mesh) for mesh in meshes]),
        np.repeat(np.arange(len(meshes)), [len(mesh.triangles) for mesh in meshes]),
        tolerance_mm,
    )


def _smooth(mesh: Mesh) -> Floats:
    """Normals of corners ``(T, 3, 3)``: means over the facets around, but not over a crease."""
    own = mesh.normals()
    corners = mesh.vertices[mesh.triangles]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    # The mean over all of one sheet around a vertex; where a facet leans far from it, its own.
    sheets = int(mesh.sheets.max(initial=0)) + 1
    rows = mesh.triangles * sheets + mesh.sheets[:, None]
    mean = np.zeros((len(mesh.vertices) * sheets, 3))
    for k in range(3):
        np.add.at(mean, rows[:, k], own * areas[:, None])
    length = np.linalg.norm(mean, axis=1)
    mean /= np.where(length > 0, length, 1.0)[:, None]
    found = mean[rows]
    near = dots(found, own[:, None]) >= _CREASE
    return np.where(near[..., None], found, own[:, None])


@dataclass(frozen=True, eq=False)
class Depths:
    """What a band of a raster sees.

    Attributes
    ----------
    t
        ``(rows, columns)`` along each ray's direction; inf for nothing.
    hits
        ``(rows, columns, 4)`` as :data:`phantom.kernels.first_hit.SURFACE` and so on.
    normals
        ``(rows, columns, 3)`` of the facets, between those of their corners.
    """

    t: Floats
    hits: Ints
    normals: Floats


class _Scratch:
    """Arrays of one thread, for one band after the other: fresh memory costs as much as tracing."""

    def __init__(self, rows: int, columns: int) -> None:
        self.heads = np.empty((rows, columns), dtype=np.int64)
        self.t = np.empty((rows, columns))
        self.hits = np.empty((rows, columns, 4), dtype=np.int64)
        self.triangles = np.empty((rows, columns), dtype=np.int64)
        self.normals = np.empty((rows, columns, 3))
        self.make_room(_ROOM * rows * columns)

    def make_room(self, crossings: int) -> None:
        """Hold so many crossings."""
        self.links, self.owners = (np.empty(crossings, dtype=np.int64) for _ in range(2))
        self.depths = np.empty(crossings)


class ZBuffer:
    """The rays of a camera on facets, band by band."""

    def __init__(
        self,
        phantom: Phantom,
        model: Facets,
        camera: Camera,
        view: Floats,
        shown: Flags,
        samples: int,
    ) -> None:
        self._scene = phantom.compiled.scene
        self._model = model
        self._view = view
        self._shown = shown
        self._columns = camera.columns * samples
        self._corners = np.ascontiguousarray(model.corners - view[0])
        self._fields = _fields(model.corners, camera, samples)
        self._own = threading.local()

    def rows(self, first: int, last: int) -> Depths:
        """Look along the rays of rows of samples; the arrays are the thread's, until its next."""
        from phantom.kernels import zbuffer as kernels

        size = last - first
        held: _Scratch | None = getattr(self._own, "scratch", None)
        if held is None or len(held.heads) < size:
            held = self._own.scratch = _Scratch(size, self._columns)
        heads, t, hits = held.heads[:size], held.t[:size], held.hits[:size]
        triangles, normals = held.triangles[:size], held.normals[:size]
        while True:
            lists = (heads, held.links, held.depths, held.owners)
            if kernels.crossings(self._corners, self._fields, self._view, first, *lists) >= 0:
                break
            held.make_room(4 * len(held.links))
        kernels.resolve(
            self._scene, self._shown, self._model.leaf, SLIVER, *lists, t, hits, triangles
        )
        kernels.facets(self._corners, self._model.normals, self._view, first, t, triangles, normals)
        return Depths(t, hits, normals)


def _fields(corners: Floats, camera: Camera, samples: int) -> Ints:
    """Return ``(T, 4)`` rows and columns of samples, half-open, that may see each triangle."""
    right, down, forward = camera.axes
    away = corners - np.asarray(camera.eye)
    depth = dots(away, forward)
    scale = np.full(depth.shape, camera.pitch)
    behind: NDArray[np.bool_] = np.zeros(len(corners), dtype=np.bool_)
    if camera.parallel_width_mm is None:
        near = depth <= _NEAR
        behind = np.asarray(near.any(axis=1))
        scale = np.where(near, 1.0, depth) * camera.pitch
    found = np.empty((len(corners), 4), dtype=np.int64)
    for column, (axis, size) in enumerate(((down, camera.rows), (right, camera.columns))):
        at = dots(away, axis) / scale + (size - 1) / 2
        # The centre of sample k of pixel p lies at p + (k + 1/2) / samples - 1/2.
        low = np.ceil((at.min(axis=1) + 0.5) * samples - 0.5 - 1e-6)
        high = np.floor((at.max(axis=1) + 0.5) * samples - 0.5 + 1e-6) + 1
        low, high = np.where(behind, 0, low), np.where(behind, size * samples, high)
        found[:, 2 * column] = np.clip(low, 0, size * samples)
        found[:, 2 * column + 1] = np.clip(high, 0, size * samples)
    # What lies behind the eye with all its corners is not seen.
    if camera.parallel_width_mm is None:
        found[(depth <= 0).all(axis=1)] = 0
    return found
