"""Closed triangle meshes: what a tessellated solid is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.transforms import Similarity

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface of triangles.

    Attributes
    ----------
    vertices
        ``(V, 3)`` mm.
    triangles
        ``(T, 3)`` rows of vertices, anticlockwise as seen from outside. Every edge belongs to as
        many triangles in the one direction as in the other: the mesh is watertight.
    sheets
        ``(T,)`` which smooth face a triangle belongs to: 0 for the swept or quadric surface, above
        it one number for each flat end, cut or side of a box.
    """

    vertices: Floats
    triangles: Ints
    sheets: Ints

    @property
    def volume_mm3(self) -> float:
        """What the surface encloses, by the divergence theorem; negative where it is inside out."""
        # About a point of its own, so that a solid far from the origin loses no digits.
        corners = (self.vertices - self._origin)[self.triangles]
        return float(np.einsum("ij,ij->", corners[:, 0], _cross(corners)) / 6)

    @property
    def centroid_mm(self) -> Floats:
        """Return the centre of mass of the solid, ``(3,)`` mm."""
        corners = (self.vertices - self._origin)[self.triangles]
        volumes = np.einsum("ij,ij->i", corners[:, 0], _cross(corners)) / 6
        return np.asarray(self._origin + volumes @ corners.sum(axis=1) / (4 * volumes.sum()))

    @property
    def _origin(self) -> Floats:
        return np.asarray(self.vertices[:1].sum(axis=0))

    def moved(self, to: Similarity) -> Mesh:
        """Return the mesh moved by a similarity; a mirror turns the triangles round."""
        mirror = bool(np.linalg.det(to.rotation) < 0)
        return replace(self if not mirror else self.reversed(), vertices=to.points(self.vertices))

    def reversed(self) -> Mesh:
        """Return the mesh inside out."""
        return replace(self, triangles=np.ascontiguousarray(self.triangles[:, ::-1]))

    def outward(self) -> Mesh:
        """Return the mesh with its normals pointing outward, all turned round if need be."""
        return self if self.volume_mm3 >= 0 else self.reversed()

    def normals(self) -> Floats:
        """Return the unit normals ``(T, 3)`` of the triangles; zeros where one has no area."""
        found = _cross(self.vertices[self.triangles])
        length = np.linalg.norm(found, axis=1)
        return np.asarray(found / np.where(length > 0, length, 1.0)[:, None])

    def tidied(self) -> Mesh:
        """Return the mesh without vertices that no triangle uses."""
        used = np.zeros(len(self.vertices), dtype=np.bool_)
        used[self.triangles] = True
        row = np.cumsum(used) - 1
        return replace(self, vertices=self.vertices[used], triangles=row[self.triangles])


def collapsed(mesh: Mesh, short_mm: float) -> Mesh:
    """Return the mesh with every edge shorter than ``short_mm`` drawn together to a point.

    What remains is closed still; two triangles that come to lie back to back go.
    """
    corners = mesh.vertices[mesh.triangles]
    lengths = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=-1)
    rows, sides = np.nonzero(lengths < short_mm)
    if not len(rows):
        return mesh
    home = np.arange(len(mesh.vertices))
    for row, side in zip(rows.tolist(), sides.tolist(), strict=True):
        one, two = mesh.triangles[row, side], mesh.triangles[row, (side + 1) % 3]
        while home[one] != one:
            one = home[one]
        while home[two] != two:
            two = home[two]
        home[max(one, two)] = min(one, two)
    while np.any(home != home[home]):
        home = home[home]
    found = home[mesh.triangles]
    kept = np.all(found != np.roll(found, -1, axis=1), axis=1)
    kept[kept] = _alone(found[kept])
    return Mesh(mesh.vertices, found[kept], mesh.sheets[kept]).tidied()


def _alone(triangles: Ints) -> NDArray[np.bool_]:
    """Tell which triangles have no other on the same corners that faces the other way."""
    order = np.argsort(triangles, axis=1)
    sense = np.where((order[:, 1] - order[:, 0]) % 3 == 1, 1, -1)
    _, which = np.unique(np.sort(triangles, axis=1), axis=0, return_inverse=True)
    which = which.reshape(-1)
    balance = np.bincount(which, sense)
    count = np.bincount(which)
    return np.asarray((count[which] == 1) | (balance[which] * sense > 0))


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Return several meshes as one; sheets keep their numbers."""
    if not meshes:
        return Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64))
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(
            [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
        ),
        np.concatenate([mesh.sheets for mesh in meshes]),
    )


def open_edges(triangles: Ints) -> Ints:
    """Return the directed edges ``(E, 2)`` without one the other way; none if watertight.

    An edge that runs k times one way and l times the other is listed ``max(k - l, 0)`` times.
    """
    if not len(triangles):
        return np.zeros((0, 2), dtype=np.int64)
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    size = int(edges.max()) + 1
    low, high = edges.min(axis=1), edges.max(axis=1)
    pairs, which = np.unique(low * size + high, return_inverse=True)
    sense = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    balance = np.bincount(which, sense, len(pairs)).astype(np.int64)
    rows = np.repeat(np.flatnonzero(balance), np.abs(balance[balance != 0]))
    ends = np.stack([pairs[rows] // size, pairs[rows] % size], axis=-1)
    return np.asarray(np.where((balance[rows] > 0)[:, None], ends, ends[:, ::-1]))


def _cross(corners: Floats) -> Floats:
    return np.asarray(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
