"""Whether a generalized cylinder runs into itself somewhere else along its axis.

Segments whose boxes meet and whose ranges of u do not are looked at in pairs: the surface of one,
lateral and end caps, is sampled, the samples nearest to the other's inside are moved uphill until
the depth no longer grows, and the deepest point decides. Local overlap is judged elsewhere
(:func:`phantom.compiled.segments.check_local_overlap`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from phantom.compiled.changing import ChangingTable
from phantom.compiled.segments import Segments
from phantom.compiled.tables import StarTable
from phantom.geometry import tolerances
from phantom.geometry.polynomials import derivative, evaluate
from phantom.geometry.refusal import RefusalError
from phantom.geometry.star import chart_rays, pseudo_angle
from phantom.geometry.swept import Shape

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Table = StarTable | ChangingTable | None

_ALONG, _ROUND, _RINGS, _STARTS = 7, 32, 4, 6
_CLIMBS = 80
_MOVES = np.array(
    [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]], dtype=np.float64
)


@dataclass(frozen=True)
class Traced:
    """One part of a cylinder as it is traced."""

    shape: Shape
    segments: Segments
    tables: tuple[Table, ...]


def check_global_overlap(parts: list[Traced]) -> None:
    """Refuse a cylinder that overlaps itself more than :data:`tolerances.OVERLAP_MM` deep.

    Raises
    ------
    RefusalError
        At the leaf itself, with both u and the depth.
    """
    where = [(p, k) for p, part in enumerate(parts) for k in range(len(part.segments.origins))]
    groups: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for one, two in _near(parts, where):
        for (p, k), (q, m) in ((one, two), (two, one)):
            groups.setdefault((p, q), []).append((k, m))
    for (p, q), pairs in groups.items():
        climber = _Climber(parts[p], parts[q])
        for sheet in ("side", "start", "end"):
            depth, u, other = climber.deepest(sheet, np.array(pairs, dtype=np.intp))
            if depth > tolerances.OVERLAP_MM:
                raise RefusalError(
                    "",
                    "global_overlap",
                    f"the solid runs into itself: its surface at u = {u:.6g} lies {depth:.3g} mm "
                    f"inside it at u = {other:.6g}; expected at most {tolerances.OVERLAP_MM:g} mm",
                )


def _near(
    parts: list[Traced], where: list[tuple[int, int]]
) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Pairs of segments that lie apart along u and whose boxes meet."""
    cut = [(parts[p].segments, k) for p, k in where]
    axes = np.array([s.axes[k] for s, k in cut])
    boxes = np.array([s.boxes[k] for s, k in cut])
    middle = np.array([s.origins[k] for s, k in cut])
    middle = middle + np.einsum("nai,na->ni", axes, boxes.mean(axis=2))
    half = 0.5 * np.ptp(boxes, axis=2)
    radius = np.linalg.norm(half, axis=1)
    pairs = KDTree(middle).query_pairs(2 * float(radius.max()), output_type="ndarray")
    i, j = pairs[:, 0], pairs[:, 1]
    low = np.array([s.knots[k] for s, k in cut])
    high = np.array([s.knots[k + 1] for s, k in cut])
    span = high.max() - low.min()
    apart = (low[j] > high[i] + 1e-12 * span) | (low[i] > high[j] + 1e-12 * span)
    if parts[0].shape.curve.closed:
        around = (low[i] - low.min() + high.max() - high[j] <= 1e-12 * span) | (
            low[j] - low.min() + high.max() - high[i] <= 1e-12 * span
        )
        apart &= ~around
    apart &= np.linalg.norm(middle[i] - middle[j], axis=1) <= radius[i] + radius[j]
    i, j = i[apart], j[apart]
    met = _boxes_meet(axes[i], half[i], axes[j], half[j], middle[j] - middle[i])
    i, j = i[met], j[met]
    divided = _divided(parts, where, i, j) | _divided(parts, where, j, i)
    return [(where[a], where[b]) for a, b in zip(i[~divided], j[~divided], strict=True)]


def _divided(
    parts: list[Traced], where: list[tuple[int, int]], i: Ints, j: Ints
) -> NDArray[np.bool_]:
    """Say which pairs an end plane of segment i divides: its own body lies on the inner side.

    Most segments that follow each other round a bend are told apart so.
    """
    found = np.zeros(len(i), dtype=bool)
    samples: dict[int, Floats] = {}
    for row, (a, b) in enumerate(zip(i, j, strict=True)):
        if b not in samples:
            samples[b] = _surface(parts[where[b][0]], where[b][1])
        cut, k = parts[where[a][0]].segments, where[a][1]
        heights = samples[b] @ cut.planes[[k, k + 1], :3].T - cut.planes[[k, k + 1], 3]
        # What the surface may bulge beyond its samples.
        slack = 0.01 * float(np.ptp(heights, axis=0).max())
        found[row] = heights[:, 0].max() < -slack or heights[:, 1].min() > slack
    return found


def _surface(traced: Traced, k: int) -> Floats:
    """Points of the surface of a segment, ``(P, 3)``."""
    u = np.linspace(traced.segments.knots[k], traced.segments.knots[k + 1], 5)
    piece = np.repeat(traced.shape.pieces(traced.segments.knots[[k, k + 1]]), 5)
    placed = traced.shape.sections(u, piece)
    phi = traced.shape.points(u, 48)
    phi = np.broadcast_to(phi, (5, *phi.shape[1:]))
    return np.asarray(
        (placed.middle[:, None] + np.einsum("nij,nvj->nvi", placed.spread, phi)).reshape(-1, 3)
    )


def _boxes_meet(
    axes_i: Floats, half_i: Floats, axes_j: Floats, half_j: Floats, between: Floats
) -> NDArray[np.bool_]:
    """Separating axes of two boxes: their faces, then the products of their edges."""
    met = np.ones(len(between), dtype=bool)
    products = np.cross(axes_i[:, :, None], axes_j[:, None, :]).reshape(len(between), 9, 3)
    for directions in (axes_i, axes_j, products):
        reach = np.zeros(directions.shape[:2])
        for axes, half in ((axes_i, half_i), (axes_j, half_j)):
            reach = reach + np.einsum(
                "na,nka->nk", half, np.abs(np.einsum("nkx,nax->nka", directions, axes))
            )
        distance = np.abs(np.einsum("nkx,nx->nk", directions, between))
        met &= (distance <= reach + 1e-9).all(axis=1)
    return met


@dataclass(frozen=True)
class _Climber:
    """Finds where the surface of one part lies deepest in another part."""

    one: Traced
    two: Traced

    def deepest(self, sheet: str, pairs: Ints) -> tuple[float, float, float]:
        """Return the depth in mm (negative: nowhere inside), and u on both."""
        last = len(self.one.segments.origins) - 1
        rows = _ALONG
        if sheet != "side":
            if self.one.shape.curve.closed:
                return -np.inf, 0.0, 0.0
            pairs, rows = pairs[pairs[:, 0] == (0 if sheet == "start" else last)], _RINGS
        if not len(pairs):
            return -np.inf, 0.0, 0.0
        r, c = np.meshgrid(np.linspace(0, 1, rows), np.arange(_ROUND) / _ROUND, indexing="ij")
        grid = np.stack([r.ravel(), c.ravel()], axis=-1)
        owner = np.repeat(np.arange(len(pairs)), len(grid))
        at = np.tile(grid, (len(pairs), 1))
        depth, _, _ = self._depths(sheet, pairs[owner], at)
        # The few best of each pair go on.
        order = np.argsort(-depth.reshape(len(pairs), -1), axis=1)[:, :_STARTS]
        chosen = (order + np.arange(len(pairs))[:, None] * len(grid)).ravel()
        step = np.array([1.0 / rows, 1.0 / _ROUND])
        return self._climb(sheet, pairs[owner[chosen]], at[chosen], step)

    def _climb(
        self, sheet: str, pairs: Ints, at: Floats, step: Floats
    ) -> tuple[float, float, float]:
        """Pattern search uphill; a point that cannot get inside any more is dropped."""
        extent = np.ptp(self.one.segments.boxes, axis=2)[pairs[:, 0]]
        # How far one step goes, in mm: along the axis, and round the section.
        size = np.hypot(extent[:, 2] * step[0], 4.0 * extent[:, :2].max(axis=1) * step[1])
        shrink = np.ones(len(at))
        depth, u, other = self._depths(sheet, pairs, at)
        best = (-np.inf, 0.0, 0.0)
        for _ in range(_CLIMBS):
            top = int(np.argmax(depth))
            best = max(best, (float(depth[top]), float(u[top]), float(other[top])))
            if best[0] > tolerances.OVERLAP_MM:
                break
            # What a few more steps of this length could gain.
            alive = depth + 4.0 * shrink * size > tolerances.OVERLAP_MM
            alive &= shrink * size > 1e-8
            if not alive.any():
                break
            pairs, at, depth, u, other = (v[alive] for v in (pairs, at, depth, u, other))
            shrink, size = shrink[alive], size[alive]
            tried = at[:, None] + _MOVES * (shrink[:, None, None] * step)
            tried[..., 0] = np.clip(tried[..., 0], 0.0, 1.0)
            count = len(_MOVES)
            found = self._depths(sheet, np.repeat(pairs, count, axis=0), tried.reshape(-1, 2))
            depths, us, others = (f.reshape(len(at), count) for f in found)
            rows, choice = np.arange(len(at)), np.argmax(depths, axis=1)
            better = depths[rows, choice] > depth
            at = np.where(better[:, None], tried[rows, choice], at)
            depth = np.where(better, depths[rows, choice], depth)
            u, other = (
                np.where(better, new[rows, choice], old) for new, old in ((us, u), (others, other))
            )
            shrink = np.where(better, shrink, 0.5 * shrink)
        return best

    def _depths(self, sheet: str, pairs: Ints, at: Floats) -> tuple[Floats, Floats, Floats]:
        """Depth of surface points of one in two, mm, and both u."""
        knots = self.one.segments.knots
        start, end = knots[pairs[:, 0]], knots[pairs[:, 0] + 1]
        if sheet == "side":
            u, scale = start + at[:, 0] * (end - start), np.ones(len(at))
        else:
            u, scale = (start if sheet == "start" else end), at[:, 0]
        piece = self.one.shape.pieces(knots)[pairs[:, 0]]
        placed = self.one.shape.sections(u, piece)
        phi = scale[:, None] * _contour(self.one.shape, 8.0 * np.mod(at[:, 1], 1.0), u)
        x = placed.middle + np.einsum("nij,nj->ni", placed.spread, phi)
        depth, other = _inside(self.two, pairs[:, 1], x)
        return depth, u, other


def _contour(shape: Shape, T: Floats, u: Floats) -> Floats:
    """Points of the contour in unit coordinates, each at its own pseudo-angle and u."""
    rays = chart_rays(T)
    size = shape.unit_radii(T, u) / np.linalg.norm(rays, axis=1)
    return np.asarray(rays * size[:, None])


def _inside(traced: Traced, m: Ints, points: Floats) -> tuple[Floats, Floats]:
    """Depth of points in a segment each, by the gauge of its section and its planes, and u there.

    A shared plane is no wall, for its neighbour is looked at too; the depth is let run past planes
    by the tolerance only, so that nothing outside counts as inside.
    """
    cut = traced.segments
    x = points - cut.origins[m]
    polynomials = cut.polynomials[m]
    slopes = derivative(polynomials)
    tau = np.zeros(len(x))

    def row(p: Floats, index: int) -> Floats:
        parts = [evaluate(p[:, index + i], tau) for i in range(4)]
        return np.asarray(x[:, 0] * parts[0] + x[:, 1] * parts[1] + x[:, 2] * parts[2] - parts[3])

    for _ in range(8):
        rate = row(slopes, 0)
        step = np.where(rate < 0, -row(polynomials, 0) / np.where(rate < 0, rate, -1.0), 0.0)
        tau = np.clip(tau + step, -1.0, 1.0)
        if np.abs(step).max() < 1e-12:
            break
    phi = np.stack([row(polynomials, 4), row(polynomials, 8)], axis=-1)
    gauge = np.sqrt(np.maximum(_gauge(traced.tables, m, phi, tau), 0.0))
    # To leave, the gauge must grow to 1; per mm it grows by no more than this.
    across = polynomials[:, [[4, 5, 6], [8, 9, 10]], 0]
    stretch = np.linalg.svd(across, compute_uv=False)[:, 0]
    size = np.linalg.norm(phi, axis=1)
    growth = stretch * np.where(size > 1e-9, gauge / np.maximum(size, 1e-9), 1.0)
    depth = (1.0 - gauge) / np.maximum(growth, 1e-12)
    for side, plane in ((1.0, cut.planes[m]), (-1.0, cut.planes[m + 1])):
        height = side * (np.einsum("ni,ni->n", points, plane[:, :3]) - plane[:, 3])
        depth = np.minimum(depth, height + tolerances.OVERLAP_MM)
    u = cut.knots[m] + 0.5 * (tau + 1) * (cut.knots[m + 1] - cut.knots[m])
    return depth, u


def _gauge(tables: tuple[Table, ...], m: Ints, phi: Floats, tau: Floats) -> Floats:
    """Square of the gauge at unit coordinates: ``X^2 g`` on the chart."""
    result: Floats = np.asarray(np.einsum("ni,ni->n", phi, phi))
    T = pseudo_angle(phi)
    distinct = {id(tables[k]): tables[k] for k in np.unique(m)}
    owners = np.array([id(table) for table in tables])[m]
    for key, table in distinct.items():
        if table is None:
            continue
        rows = np.flatnonzero(owners == key)
        at = T[rows]
        cell = np.searchsorted(table.edges, at, side="right") - 1
        cell = np.clip(cell, 0, len(table.cells) - 1)
        low, high = table.edges[cell], table.edges[cell + 1]
        cells = table.cells[cell]
        if isinstance(table, ChangingTable):
            cells = evaluate(cells, tau[rows][:, None])
        major = np.abs(phi[rows]).max(axis=1)
        result[rows] = major**2 * evaluate(cells, (2 * at - low - high) / (high - low))
    return np.asarray(result)
