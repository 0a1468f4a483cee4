"""Closing an open mesh with flat faces, and cutting one by a plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.halfspaces import Halfspaces
from phantom.tessellation.mesh import Mesh, open_edges
from phantom.tessellation.polygons import triangulated

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def loops_of(edges: Ints, flat: Floats) -> list[Ints]:
    """Chain directed edges into loops; ``flat`` are the vertices in a plane seen from outside.

    Where two loops touch at a vertex, each turns as sharply to the left as it can: so they stay
    two.
    """
    leaving: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        leaving.setdefault(start, []).append(end)
    loops = []
    while leaving:
        first = next(iter(leaving))
        loop, here = [first], leaving[first].pop()
        if not leaving[first]:
            del leaving[first]
        while here != first:
            loop.append(here)
            ends = leaving[here]
            choice = 0
            if len(ends) > 1:
                back = flat[loop[-2]] - flat[here]
                away = flat[ends] - flat[here]
                turns = np.arctan2(back[1], back[0]) - np.arctan2(away[:, 1], away[:, 0])
                choice = int(np.argmin(np.mod(turns, 2 * np.pi)))
            here_next = ends.pop(choice)
            if not ends:
                del leaving[here]
            here = here_next
        loops.append(np.array(loop, dtype=np.int64))
    return loops


def filled(mesh: Mesh, edges: Ints, normal: Floats, sheet: int) -> tuple[Mesh, bool]:
    """Close the open edges of a mesh, which lie in one plane, by a flat face.

    Parameters
    ----------
    mesh
        With edges that have no other.
    edges
        Those to close, as :func:`~phantom.tessellation.mesh.open_edges` gives them.
    normal
        Of the plane, pointing outward.
    sheet
        Number of the new face.

    Returns
    -------
    The mesh, and whether the outlines were simple.
    """
    if not len(edges):
        return mesh, True
    axis = np.eye(3)[int(np.argmin(np.abs(normal)))]
    e1 = np.cross(normal, axis)
    e1 /= np.linalg.norm(e1)
    flat = mesh.vertices @ np.stack([e1, np.cross(normal, e1)], axis=-1)
    # The face runs along every open edge the other way.
    triangles, simple = triangulated(flat, loops_of(edges[:, ::-1], flat))
    return Mesh(
        mesh.vertices,
        np.concatenate([mesh.triangles, triangles]),
        np.concatenate([mesh.sheets, np.full(len(triangles), sheet)]),
    ), simple


def cut(mesh: Mesh, planes: Halfspaces, snap_mm: float) -> Mesh:
    """Cut a closed mesh by planes, one after the other, and close it again.

    A vertex nearer to a plane than ``snap_mm`` is moved onto it, so that no slivers arise.
    """
    for normal, offset in zip(planes.normals, planes.offsets, strict=True):
        mesh = _cut_once(mesh, normal, float(offset), snap_mm)
    return mesh


def _cut_once(mesh: Mesh, normal: Floats, offset: float, snap_mm: float) -> Mesh:
    height = mesh.vertices @ normal - offset
    near = np.abs(height) <= snap_mm
    vertices = np.where(near[:, None], mesh.vertices - height[:, None] * normal, mesh.vertices)
    height = np.where(near, 0.0, height)
    side = np.sign(height).astype(np.int64)
    sides = side[mesh.triangles]
    if not np.any(side > 0):
        return mesh
    kept = (sides <= 0).all(axis=1) & (sides < 0).any(axis=1)
    split = (sides > 0).any(axis=1) & (sides < 0).any(axis=1)
    rows = np.flatnonzero(split)
    new, born = _split(mesh.triangles[rows], sides[rows], vertices, height)
    found = Mesh(
        np.concatenate([vertices, born]),
        np.concatenate([mesh.triangles[kept], new[0]]),
        np.concatenate([mesh.sheets[kept], mesh.sheets[rows][new[1]]]),
    )
    sheet = int(mesh.sheets.max(initial=0)) + 1
    return filled(found, open_edges(found.triangles), normal, sheet)[0].tidied()


def _split(
    triangles: Ints, sides: Ints, vertices: Floats, height: Floats
) -> tuple[tuple[Ints, Ints], Floats]:
    """Return what is left of triangles that cross a plane, whose they were, and new vertices."""
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]]
    crossed = sides[:, [0, 1, 2]] * sides[:, [1, 2, 0]] < 0
    pairs = np.sort(edges[crossed], axis=1)
    distinct, which = np.unique(pairs, axis=0, return_inverse=True)
    one, two = distinct[:, 0], distinct[:, 1]
    share = height[one] / (height[one] - height[two])
    born = vertices[one] + share[:, None] * (vertices[two] - vertices[one])
    point = np.full(crossed.shape, -1, dtype=np.int64)
    point[crossed] = len(vertices) + which.reshape(-1)
    left, owner = [], []
    for row in range(len(triangles)):
        # Walk round: corners that stay, and the points where an edge crosses.
        ring: list[int] = []
        for k in range(3):
            if sides[row, k] <= 0:
                ring.append(int(triangles[row, k]))
            if point[row, k] >= 0:
                ring.append(int(point[row, k]))
        left += [[ring[0], ring[k], ring[k + 1]] for k in range(1, len(ring) - 1)]
        owner += [row] * (len(ring) - 2)
    pieces = np.array(left, dtype=np.int64).reshape(-1, 3)
    return (pieces, np.array(owner, dtype=np.int64)), born
