"""From a grid on a net to a closed mesh: its sides, its ends, and the seam of a closed axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.tessellation.caps import filled
from phantom.tessellation.grids import Grid, grid
from phantom.tessellation.mesh import Mesh, open_edges
from phantom.tessellation.nets import Net

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_FINER = 4.0
_TRIES = 5
SAME_MM = 1e-6
"""Corners nearer than this to one another, relative to the size of 1 mm or the ring, are one."""


def surface(net: Net, tolerance_mm: float) -> Mesh:
    """Tessellate a net: a closed mesh within ``tolerance_mm`` of it, normals outward.

    An outline that runs near to itself may cross itself once it is made of chords; then finer
    chords are taken.
    """
    for attempt in range(_TRIES):
        mesh, simple = _closed(net, grid(net, tolerance_mm / _FINER**attempt))
        if simple:
            break
    return mesh.outward()


def _closed(net: Net, cells: Grid) -> tuple[Mesh, bool]:
    rings, around = cells.points.shape[:2]
    rows = np.arange(rings * around).reshape(rings, around)
    points = cells.points.reshape(-1, 3)
    for end, ring in ((net.ends[0], 0), (net.ends[1], -1)):
        if end == "point":
            rows[ring] = rows[ring, 0]
    here, beside = rows, np.roll(rows, -1, axis=1)
    a, b, c, d = here[:-1], here[1:], beside[:-1], beside[1:]
    up = cells.rising[..., None]
    one = np.where(up, np.stack([a, b, d], axis=-1), np.stack([a, b, c], axis=-1))
    two = np.where(up, np.stack([a, d, c], axis=-1), np.stack([b, d, c], axis=-1))
    triangles = np.stack([one, two], axis=2).reshape(-1, 3)
    if net.ends[0] == "seam":
        return _sewn(points, triangles, rows), True
    triangles = _proper(triangles)
    mesh = Mesh(points, triangles, np.zeros(len(triangles), dtype=np.int64))
    simple = True
    for sheet, ring in ((1, rows[0]), (2, rows[-1])):
        if net.ends[sheet - 1] == "flat":
            edges = open_edges(mesh.triangles)
            edges = edges[np.isin(edges[:, 0], ring)]
            # The face runs along the open edges the other way, and so its normal points.
            normal = _newell(points[edges[:, ::-1]])
            mesh, sound = filled(mesh, edges, normal, sheet)
            simple &= sound
    return mesh.tidied(), simple


def _proper(triangles: Ints) -> Ints:
    """Leave out triangles that have lost an edge at a point."""
    one, two, three = triangles.T
    return np.asarray(triangles[(one != two) & (two != three) & (three != one)])


def _newell(edges: Floats) -> Floats:
    """Return the unit normal of flat loops given by their edges ``(E, 2, 3)``, in any order."""
    origin = edges[0, 0]
    total = np.cross(edges[:, 0] - origin, edges[:, 1] - origin).sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _sewn(points: Floats, triangles: Ints, rows: Ints) -> Mesh:
    """Join the last ring to the first: both lie on one curve, maybe turned along it."""
    first, last = rows[0], rows[-1]
    near = SAME_MM * max(1.0, float(np.ptp(points[first], axis=0).max()))
    turn = int(np.argmin(np.linalg.norm(points[first] - points[last[0]], axis=1)))
    partner = np.roll(first, -turn)
    if np.linalg.norm(points[partner] - points[last], axis=1).max() <= near:
        same = np.arange(len(points))
        same[last] = partner
        triangles = _proper(same[triangles])
    else:
        triangles = np.concatenate([triangles, _zipped(points, last, partner)])
    return Mesh(points, triangles, np.zeros(len(triangles), dtype=np.int64)).tidied()


def _zipped(points: Floats, low: Ints, high: Ints) -> Ints:
    """Fill the strip between two rings on one curve, always along the shorter diagonal."""
    found = []
    i = j = 0
    n, m = len(low), len(high)
    while i < n or j < m:
        a, b = low[i % n], high[j % m]
        c, d = low[(i + 1) % n], high[(j + 1) % m]
        ahead = np.linalg.norm(points[c] - points[b]) <= np.linalg.norm(points[d] - points[a])
        if j == m or (i < n and ahead):
            found.append((a, b, c))
            i += 1
        else:
            found.append((a, b, d))
            j += 1
    return np.array(found, dtype=np.int64)
