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

from phantom.compiled.changing import ChangingTable
from phantom.compiled.meeting import Table, Traced, meeting_pairs
from phantom.geometry import tolerances
from phantom.geometry.polynomials import derivative, evaluate, powers
from phantom.geometry.refusal import RefusalError
from phantom.geometry.star import chart_rays, pseudo_angle

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_ALONG, _ROUND, _RINGS, _STARTS = 7, 32, 4, 6
_CLIMBS = 80
_MOVES = np.array(
    [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]], dtype=np.float64
)


def check_global_overlap(parts: list[Traced]) -> None:
    """Refuse a cylinder that overlaps itself more than :data:`tolerances.OVERLAP_MM` deep.

    Raises
    ------
    RefusalError
        At the leaf itself, with both u and the depth.
    """
    one, two = meeting_pairs(parts)
    one, two = np.concatenate([one, two]), np.concatenate([two, one])
    for p, q in np.unique(np.stack([one[:, 0], two[:, 0]], axis=-1), axis=0):
        rows = (one[:, 0] == p) & (two[:, 0] == q)
        pairs = np.stack([one[rows, 1], two[rows, 1]], axis=-1)
        climber = _Climber(parts[p], parts[q])
        for sheet in ("side", "start", "end"):
            depth, u, other = climber.deepest(sheet, pairs)
            if depth > tolerances.OVERLAP_MM:
                raise RefusalError(
                    "",
                    "global_overlap",
                    f"the solid runs into itself: its surface at u = {u:.6g} lies {depth:.3g} mm "
                    f"inside it at u = {other:.6g}; expected at most {tolerances.OVERLAP_MM:g} mm",
                )


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
        knots, segment = self.one.segments.knots, pairs[:, 0]
        start, end = knots[segment], knots[segment + 1]
        if sheet == "side":
            share, scale = at[:, 0], np.ones(len(at))
        else:
            share, scale = np.full(len(at), 0.0 if sheet == "start" else 1.0), at[:, 0]
        u = start + share * (end - start)
        placed = self.one.shape.sections(u, self.one.shape.pieces(knots)[segment])
        # The contour as it is traced: on the ray of a pseudo-angle, where the gauge is 1.
        rays = chart_rays(8.0 * np.mod(at[:, 1], 1.0))
        gauge = _gauge(self.one.tables, segment, rays, 2.0 * share - 1.0)
        phi = (scale / np.sqrt(gauge))[:, None] * rays
        x = placed.middle + np.einsum("nij,nj->ni", placed.spread, phi)
        depth, other = _inside(self.two, pairs[:, 1], x)
        return depth, u, other


def _inside(traced: Traced, m: Ints, points: Floats) -> tuple[Floats, Floats]:
    """Depth of points in a segment each, by the gauge of its section and its planes, and u there.

    A shared plane is no wall, for its neighbour is looked at too; the depth is let run past planes
    by the tolerance only, so that nothing outside counts as inside.
    """
    cut = traced.segments
    x = np.column_stack([points - cut.origins[m], np.full(len(points), -1.0)])
    polynomials = cut.polynomials
    # Rows of x each: F, its rate, and the two of phi, as polynomials of tau.
    f = np.einsum("nip,ni->np", polynomials[m, :4], x)
    rate = derivative(f)
    tau = np.zeros(len(x))
    for _ in range(8):
        slope = evaluate(rate, tau)
        step = np.where(slope < 0, -evaluate(f, tau) / np.where(slope < 0, slope, -1.0), 0.0)
        tau = np.clip(tau + step, -1.0, 1.0)
        if np.abs(step).max() < 1e-12:
            break
    rows = np.einsum("nrp,pn->nr", polynomials[m, 4:], powers(tau, polynomials.shape[-1]))
    phi = np.einsum("nri,ni->nr", rows.reshape(-1, 2, 4), x)
    gauge = np.sqrt(np.maximum(_gauge(traced.tables, m, phi, tau), 0.0))
    # To leave, the gauge must grow to 1; per mm it grows by no more than this.
    across = polynomials[:, [[4, 5, 6], [8, 9, 10]], 0]
    stretch = np.linalg.svd(across, compute_uv=False)[m, 0]
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
