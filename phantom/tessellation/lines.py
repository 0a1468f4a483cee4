"""What a wireframe draws of a leaf: rings and lines of its net, and the edges that cuts leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.halfspaces import Halfspaces
from phantom.tessellation.leaves import drawn, leaf_mesh
from phantom.tessellation.mesh import Mesh
from phantom.tessellation.nets import Net, pieces_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Kind = Literal["ring", "line", "edge"]

_LEAST, _EACH = 96, 6
_FINE = 1024
_ON_PLANE = 1e-9


@dataclass(frozen=True, eq=False)
class Line:
    """A line on a leaf's surface.

    Attributes
    ----------
    kind
        ``ring`` at one u, ``line`` at one v, ``edge`` where a flat face meets the surface.
    runs
        Its stretches, each ``(n, 3)`` mm: what cuts leave of it.
    """

    kind: Kind
    runs: tuple[Floats, ...]


def lines_of(leaf: doc.Leaf, rings: int, lines: int, tolerance_mm: float) -> list[Line]:
    """Return what is drawn of a valid leaf, in its own coordinates.

    Parameters
    ----------
    leaf
        Of what.
    rings
        Sections of each net, evenly spread over u, both ends included where they are no points; of
        a closed axis so many without the one that is both ends.
    lines
        Lines along u of each net, spread so that they are equally far apart round the middle
        section.
    tolerance_mm
        Of the edges.
    """
    found = drawn(leaf)
    result = []
    for net in found.nets:
        result += [Line("ring", _kept(run, found.planes)) for run in _rings(net, rings)]
        result += [Line("line", _kept(run, found.planes)) for run in _lines(net, lines)]
    if len(found.planes.offsets) or found.block is not None:
        edges = edges_of(leaf_mesh(leaf, tolerance_mm))
        result += [Line("edge", (run,)) for run in edges]
    return [line for line in result if line.runs]


def _rings(net: Net, count: int) -> list[Floats]:
    first, last = net.u_breaks[[0, -1]]
    share = np.linspace(0, 1, count + 1)[:-1] if net.ends[0] == "seam" else np.linspace(0, 1, count)
    # A section that is a point is not drawn.
    points = [end == "point" for end in net.ends]
    share = share[int(points[0]) : len(share) - int(points[1])]
    u = first + share * (last - first)
    v = _spread(net.v_breaks)
    v_piece = np.minimum(pieces_of(net.v_breaks, v), len(net.v_breaks) - 2)
    return list(net.points(u, pieces_of(net.u_breaks, u), v, v_piece))


def _lines(net: Net, count: int) -> list[Floats]:
    u = _spread(net.u_breaks)
    middle = 0.5 * (net.u_breaks[:1] + net.u_breaks[-1:])
    fine = np.linspace(net.v_breaks[0], net.v_breaks[-1], _FINE + 1)
    section = net.points(
        middle, pieces_of(net.u_breaks, middle), fine, pieces_of(net.v_breaks, fine)
    )[0]
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(section, axis=0), axis=1)))
    v = np.interp(along[-1] * np.arange(count) / count, along, fine)
    points = net.points(u, pieces_of(net.u_breaks, u), v, pieces_of(net.v_breaks, v))
    return list(np.swapaxes(points, 0, 1))


def _spread(breaks: Floats) -> Floats:
    """Spread parameters over every piece, breaks included."""
    each = max(_EACH, -(-_LEAST // (len(breaks) - 1)))
    inner = breaks[:-1, None] + np.arange(each) / each * np.diff(breaks)[:, None]
    return np.append(inner.ravel(), breaks[-1])


def _kept(run: Floats, planes: Halfspaces) -> tuple[Floats, ...]:
    """Return the stretches of a run that no plane cuts away."""
    runs = [run]
    for normal, offset in zip(planes.normals, planes.offsets, strict=True):
        runs = [part for whole in runs for part in _below(whole, normal, float(offset))]
    return tuple(runs)


def _below(run: Floats, normal: Floats, offset: float) -> list[Floats]:
    height = run @ normal - offset
    height[np.abs(height) <= _ON_PLANE * (1 + np.abs(run).max())] = 0.0
    if not np.any(height > 0):
        return [run]
    found: list[list[Floats]] = [[]]
    for k in range(len(run)):
        if k and height[k - 1] * height[k] < 0:
            share = height[k - 1] / (height[k - 1] - height[k])
            found[-1].append(run[k - 1] + share * (run[k] - run[k - 1]))
        if height[k] <= 0:
            found[-1].append(run[k])
        elif found[-1]:
            found.append([])
    return [np.array(part) for part in found if len(part) > 1]


def edges_of(mesh: Mesh) -> list[Floats]:
    """Return the edges between different sheets of a mesh, chained, each ``(n, 3)`` mm."""
    pairs = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    sheets = np.repeat(mesh.sheets, 3)
    distinct, which = np.unique(pairs, axis=0, return_inverse=True)
    which = which.reshape(-1)
    low = np.full(len(distinct), np.iinfo(np.int64).max)
    high = np.full(len(distinct), -1)
    np.minimum.at(low, which, sheets)
    np.maximum.at(high, which, sheets)
    return [mesh.vertices[chain] for chain in _chained(distinct[low != high])]


def _chained(edges: Ints) -> list[Ints]:
    """Join edges to chains that end, or turn off, only where more or fewer than two meet."""
    neighbours: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    left = {frozenset(edge) for edge in edges.tolist()}
    # Chains from joints first; what is left then are rings.
    starts = [k for k, near in neighbours.items() if len(near) != 2] + list(neighbours)
    found = []
    for start in starts:
        for first in neighbours[start]:
            if frozenset((start, first)) not in left:
                continue
            chain, before, here = [start], start, first
            left.discard(frozenset((before, here)))
            while len(neighbours[here]) == 2 and here != start:
                chain.append(here)
                one, two = neighbours[here]
                before, here = here, two if one == before else one
                left.discard(frozenset((before, here)))
            found.append(np.array([*chain, here], dtype=np.int64))
    return found
