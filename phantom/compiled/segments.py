"""Cutting a generalized cylinder into segments that a kernel can trace with a guarantee.

Per segment and about its own origin, degree-6 polynomials in tau give the section plane through a
point, ``F(x, tau) = N.x - c``, and the point in unit contour coordinates, ``phi = M x - m``. A
segment is accepted when

* the traced surface lies within the tolerance of the defined one, measured at three times the
  density of the fit;
* its body lies between its two end planes;
* ``J = -dF/dtau > 0`` at every corner of (box and wedge), for all tau, by Bernstein coefficients:
  J is linear in x, so it is positive throughout and each point there has exactly one tau.

Otherwise it is halved.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.geometry.polynomials import (
    DEGREE,
    bernstein_matrix,
    derivative,
    interpolation_matrix,
    lobatto_nodes,
    powers,
)
from phantom.geometry.refusal import RefusalError
from phantom.geometry.swept import Hull, Sections, Shape

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_CHECKS = np.linspace(-1, 1, 3 * DEGREE + 2)[1:-1]
_TRIPLES = np.array(list(combinations(range(8), 3)))
_HULL_POINTS = 192
_NEARLY_STRAIGHT = 1e-3
"""An axis whose curvature times the section's reach stays below this is looked at no closer."""


@dataclass(frozen=True)
class Segments:
    """K segments in mm; ``planes`` holds the K + 1 section planes they share."""

    knots: Floats  # (K + 1,) u
    planes: Floats  # (K + 1, 4) unit normal and offset: n.x - h
    origins: Floats  # (K, 3)
    polynomials: Floats  # (K, 12, 7): Nx Ny Nz c, then M1 m1, then M2 m2; powers of tau
    axes: Floats  # (K, 3, 3) rows e1, e2, t of the box
    boxes: Floats  # (K, 3, 2) about the origin along those axes
    error_mm: float  # worst displacement of the traced surface that was measured
    j_min: float  # proven lower bound of J over all boxes and wedges


@dataclass(frozen=True)
class _Candidates:
    """A batch of segments under test."""

    start: Floats  # (K,)
    end: Floats
    piece: Ints
    origins: Floats
    polynomials: Floats
    axes: Floats
    boxes: Floats
    error_mm: Floats
    body_margin: Floats
    j_min: Floats

    def where(self, keep: NDArray[np.bool_]) -> _Candidates:
        return _Candidates(**{f.name: getattr(self, f.name)[keep] for f in fields(self)})


def segments(shape: Shape, tolerance_mm: float) -> Segments:
    """Cut a shape into accepted segments.

    Raises
    ------
    RefusalError
        At the leaf itself: where the section overlaps itself, or where no cutting meets the
        tolerance, with u and the figure.
    """
    check_local_overlap(shape)
    breaks = shape.breaks
    pieces = shape.pieces(breaks)
    start, end, piece = breaks[:-1], breaks[1:], pieces
    accepted: list[_Candidates] = []
    total = 0
    limit_mm = tolerance_mm * tolerances.FIT_SHARE
    for _ in range(60):
        trial = _fit(shape, start, end, piece, limit_mm)
        good = (trial.error_mm <= limit_mm) & (trial.body_margin >= -1e-7) & (trial.j_min > 0)
        accepted.append(trial.where(good))
        total += int(good.sum())
        if good.all():
            return _assemble(shape, accepted)
        rest = trial.where(~good)
        total_next = total + 2 * len(rest.start)
        if total_next > tolerances.MAX_SEGMENTS or np.any(rest.end - rest.start < 1e-12):
            break
        middle = 0.5 * (rest.start + rest.end)
        start, end = np.concatenate([rest.start, middle]), np.concatenate([middle, rest.end])
        piece = np.concatenate([rest.piece, rest.piece])
    worst = int(np.argmax(rest.error_mm))
    rest = _fit(shape, rest.start, rest.end, rest.piece)
    raise RefusalError(
        "",
        "not_traceable",
        f"near u = {rest.start[worst]:.6g} the surface changes too fast: after cutting it to "
        f"{rest.end[worst] - rest.start[worst]:.3g} of u it is {rest.error_mm[worst]:.3g} mm off "
        f"(J at least {rest.j_min[worst]:.3g}); expected {tolerance_mm:g} mm with at most "
        f"{tolerances.MAX_SEGMENTS} segments",
    )


def check_local_overlap(shape: Shape) -> None:
    """Refuse a section that reaches the centre of curvature: 1 - kappa n.s <= 0 somewhere.

    The extent counts only toward that centre. The worst of the samples is looked at closer.
    """
    breaks = shape.breaks
    pieces = shape.pieces(breaks)
    fractions = np.linspace(0, 1, 65)
    u = breaks[:-1, None] + fractions * np.diff(breaks)[:, None]
    u[:, -1] = breaks[1:]
    reach, radius, thin = _reach(shape, u.ravel(), np.repeat(pieces, 65))
    if thin.min() < tolerances.SMALLEST_SECTION_MM:
        raise RefusalError(
            "/sweep",
            "thin_section",
            f"the section at u = {u.ravel()[int(np.argmin(thin))]:.6g} is {thin.min():.3g} mm "
            f"thin; expected at least {tolerances.SMALLEST_SECTION_MM:g} mm",
        )
    if reach.max() < _NEARLY_STRAIGHT:
        return
    row, column = divmod(int(np.argmax(reach)), 65)
    low, high = u[row, max(column - 1, 0)], u[row, min(column + 1, 64)]
    for _ in range(4):
        near = np.linspace(low, high, 17)
        reach, radius, _ = _reach(shape, near, np.repeat(pieces[row], 17))
        worst = int(np.argmax(reach))
        low, high = near[max(worst - 1, 0)], near[min(worst + 1, 16)]
    if reach[worst] >= 1:
        raise RefusalError(
            "",
            "local_overlap",
            f"the solid folds into itself at u = {near[worst]:.6g}: the section reaches "
            f"{reach[worst] * radius[worst]:.4g} mm toward the centre of curvature, which is "
            f"{radius[worst]:.4g} mm away (curvature x extent = {reach[worst]:.4g}); "
            "expected less than 1",
        )


def _reach(shape: Shape, u: Floats, piece: Ints) -> tuple[Floats, Floats, Floats]:
    """Return curvature times extent toward its centre, the radius of curvature, the thinness."""
    at = shape.sections(u, piece)
    speed2 = np.einsum("ni,ni->n", at.first, at.first)
    along = np.einsum("ni,ni->n", at.first, at.second) / speed2
    curvature = (at.second - along[:, None] * at.first) / speed2[:, None]
    hull = shape.hull(u, _HULL_POINTS)
    reach = np.einsum("ni,ni->n", at.middle - at.axis, curvature) + _support(
        Hull(hull.points, 0.0), np.einsum("nij,ni->nj", at.spread, curvature)
    )
    radius = 1 / np.maximum(np.linalg.norm(curvature, axis=1), 1e-300)
    thin = np.linalg.svd(at.spread, compute_uv=False)[:, 1]
    return np.asarray(reach), np.asarray(radius), np.asarray(thin)


def _support(hull: Hull, directions: Floats) -> Floats:
    """Return the largest ``direction . phi`` over the unit contour, rounded up.

    ``directions`` is ``(n, ..., 2)``; the hull has as many members, or one.
    """
    length = np.linalg.norm(directions, axis=-1)
    if hull.points is None:
        return np.asarray(length)
    flat = directions.reshape(len(directions), -1, 2)
    reach = (flat @ np.swapaxes(hull.points, 1, 2)).max(axis=-1)
    return np.asarray(reach.reshape(directions.shape[:-1]) + hull.margin * length)


def _fit(
    shape: Shape, start: Floats, end: Floats, piece: Ints, limit_mm: float = np.inf
) -> _Candidates:
    """Fit a batch of segments and measure what decides on them.

    Of those that are off by more than the limit only this is measured.
    """
    count, nodes = len(start), lobatto_nodes()
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    u = middle[:, None] + half[:, None] * nodes
    u[:, 0], u[:, -1] = start, end
    at = shape.sections(u.ravel(), np.repeat(piece, len(nodes)))
    grid = (count, len(nodes))
    origins = at.axis.reshape(*grid, 3)[:, DEGREE // 2]
    normal, level, to_phi, shift = _plane_and_map(at, origins, half, grid)
    values = np.concatenate(
        [
            normal,
            level[..., None],
            to_phi[..., 0, :],
            shift[..., :1],
            to_phi[..., 1, :],
            shift[..., 1:],
        ],
        axis=-1,
    )
    polynomials = np.einsum("pn,knv->kvp", interpolation_matrix(), values)
    error = _displacement(shape, start, end, piece, origins, polynomials)
    # What is too far off is halved whatever else it does.
    near = error <= limit_mm
    axes, boxes = np.zeros((count, 3, 3)), np.zeros((count, 3, 2))
    margin, j_min = np.full(count, -np.inf), np.full(count, -np.inf)
    if near.any():
        at = Sections(*(value[np.repeat(near, len(nodes))] for value in vars(at).values()))
        grid = (int(near.sum()), len(nodes))
        hull = _hulls(shape, start[near], end[near])
        body = _body(at, origins[near], grid)
        axes[near] = _axes(at, grid)
        boxes[near] = _boxes(body, axes[near], hull)
        margin[near] = _body_margin(body, values[near], hull)
        j_min[near] = _smallest_j(polynomials[near], axes[near], boxes[near], values[near])
    return _Candidates(start, end, piece, origins, polynomials, axes, boxes, error, margin, j_min)


def _hulls(shape: Shape, start: Floats, end: Floats) -> Hull:
    """Hulls that hold the contour over the whole of each segment."""
    fractions = np.linspace(0.0, 1.0, 5)
    u = start[:, None] + fractions * (end - start)[:, None]
    hull = shape.hull(u.ravel(), _HULL_POINTS)
    if hull.points is None or len(hull.points) == 1:
        return hull
    # Between the samples a changing contour may bulge: as much as it moves from one to the next.
    sampled = hull.points.reshape(len(start), len(fractions), -1, 2)
    moved = float(np.linalg.norm(np.diff(sampled, axis=1), axis=-1).max())
    return Hull(sampled.reshape(len(start), -1, 2), hull.margin + moved)


def _plane_and_map(
    at: Sections, origins: Floats, half: Floats, grid: tuple[int, int]
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return N, c, M and m at the nodes, about the origins."""
    first = at.first.reshape(*grid, 3)
    normal = first / (np.einsum("kni,kni->kn", first, first) * half[:, None])[..., None]
    level = np.einsum("kni,kni->kn", normal, at.axis.reshape(*grid, 3) - origins[:, None])
    to_phi = at.inverse.reshape(*grid, 2, 3)
    middle = at.middle.reshape(*grid, 3) - origins[:, None]
    return normal, level, to_phi, np.einsum("knij,knj->kni", to_phi, middle)


def _body(at: Sections, origins: Floats, grid: tuple[int, int]) -> tuple[Floats, Floats]:
    """Bernstein control points of the body, ``x = X0 + X1 phi``: (K, 7, 3) and (K, 7, 3, 2)."""
    change = bernstein_matrix(DEGREE) @ interpolation_matrix()
    middle = at.middle.reshape(*grid, 3) - origins[:, None]
    spread = at.spread.reshape(*grid, 3, 2)
    return (
        np.einsum("bn,kni->kbi", change, middle),
        np.einsum("bn,knij->kbij", change, spread),
    )


def _axes(at: Sections, grid: tuple[int, int]) -> Floats:
    """Rows e1, e2, t at the middle node.

    e1 points along the curvature, which keeps J positive over the box, or, where there is next to
    none, along the contour's first axis.
    """
    first = at.first.reshape(*grid, 3)[:, DEGREE // 2]
    second = at.second.reshape(*grid, 3)[:, DEGREE // 2]
    t = first / np.linalg.norm(first, axis=1)[:, None]
    spread = at.spread.reshape(*grid, 3, 2)[:, DEGREE // 2, :, 0]
    bend = second - t * np.einsum("ki,ki->k", second, t)[:, None]
    weak = np.linalg.norm(bend, axis=1) <= 1e-9 * np.einsum("ki,ki->k", first, first) / (
        np.linalg.norm(spread, axis=1)
    )
    e1 = np.where(weak[:, None], spread, bend)
    e1 = e1 - t * np.einsum("ki,ki->k", e1, t)[:, None]
    e1 /= np.linalg.norm(e1, axis=1)[:, None]
    return np.stack([e1, np.cross(t, e1), t], axis=1)


def _boxes(body: tuple[Floats, Floats], axes: Floats, hull: Hull) -> Floats:
    """Boxes that hold the hull of the control points, hence the body."""
    x0, x1 = body
    center = np.einsum("kai,kbi->kab", axes, x0)
    directions = np.einsum("kai,kbij->kabj", axes, x1)
    high = (center + _support(hull, directions)).max(axis=2)
    low = (center - _support(hull, -directions)).min(axis=2)
    slack = 1e-6 + 1e-7 * (high - low)
    return np.stack([low - slack, high + slack], axis=-1)


def _body_margin(body: tuple[Floats, Floats], values: Floats, hull: Hull) -> Floats:
    """How far the body stays inside its end planes, in mm: at least about 0 where it does."""
    x0, x1 = body
    margins = []
    for node, side in ((0, 1.0), (-1, -1.0)):
        normal = values[:, node, :3] / np.linalg.norm(values[:, node, :3], axis=1)[:, None]
        level = values[:, node, 3] / np.linalg.norm(values[:, node, :3], axis=1)
        height = side * (np.einsum("ki,kbi->kb", normal, x0) - level[:, None])
        reach = _support(hull, -side * np.einsum("ki,kbij->kbj", normal, x1))
        margins.append((height - reach).min(axis=1))
    return np.asarray(np.minimum(margins[0], margins[1]))


def _displacement(
    shape: Shape,
    start: Floats,
    end: Floats,
    piece: Ints,
    origins: Floats,
    polynomials: Floats,
) -> Floats:
    """Worst distance between points of the defined surface and where they are traced, mm."""
    count = len(start)
    u = 0.5 * (start + end)[:, None] + 0.5 * (end - start)[:, None] * _CHECKS
    at = shape.sections(u.ravel(), np.repeat(piece, len(_CHECKS)))
    phi = shape.points(u.ravel(), 16)
    phi = np.broadcast_to(phi, (count * len(_CHECKS), *phi.shape[1:]))
    phi = phi.reshape(count, len(_CHECKS), -1, 2)
    spread = at.spread.reshape(count, len(_CHECKS), 3, 2)
    middle = at.middle.reshape(count, len(_CHECKS), 3) - origins[:, None]
    x = middle[:, :, None] + phi @ np.swapaxes(spread, 2, 3)

    def at_tau(p: Floats, tau: Floats) -> Floats:
        """Every four rows of p as a plane: ``row.x - level``, second axis the planes."""
        at = np.moveaxis(powers(tau.reshape(count, -1), DEGREE + 1), 0, 1)
        rows = (p @ at).reshape(count, -1, 4, *tau.shape[1:])
        return np.asarray(np.einsum("kricv,kcvi->krcv", rows[:, :, :3], x) - rows[:, :, 3])

    # One Newton step on F finds the traced tau: the error is already tiny.
    plane = np.concatenate([polynomials[:, :4], derivative(polynomials[:, :4])], axis=1)
    found = at_tau(plane, np.broadcast_to(_CHECKS[None, :, None], (count, len(_CHECKS), 1)))
    tau = _CHECKS[:, None] - found[:, 0] / found[:, 1]
    traced = at_tau(polynomials[:, 4:], tau)
    off = (np.moveaxis(traced, 1, -1) - phi) @ np.swapaxes(spread, 2, 3)
    distance = np.linalg.norm(off, axis=-1).max(axis=(1, 2))
    # A changing contour's table meets the rest of the tolerance only with room to spare in tau.
    distance = distance + 2.0 * shape.fit_error(start, end)
    return np.asarray(np.where(np.isfinite(distance), distance, np.inf))


def _smallest_j(polynomials: Floats, axes: Floats, boxes: Floats, values: Floats) -> Floats:
    """Lower bound of J over (box and wedge) and all tau, by its Bernstein coefficients."""
    count = len(axes)
    # Eight half-spaces rows.x <= limits: the box's six, then the two section planes.
    rows = np.empty((count, 8, 3))
    limits = np.empty((count, 8))
    rows[:, 0:3], limits[:, 0:3] = axes, boxes[..., 1]
    rows[:, 3:6], limits[:, 3:6] = -axes, -boxes[..., 0]
    for index, node, side in ((6, 0, -1.0), (7, -1, 1.0)):
        length = np.linalg.norm(values[:, node, :3], axis=1)
        rows[:, index] = side * values[:, node, :3] / length[:, None]
        limits[:, index] = side * values[:, node, 3] / length
    triples, rhs = rows[:, _TRIPLES], limits[:, _TRIPLES]
    determinant = np.linalg.det(triples)
    solvable = np.abs(determinant) > 1e-9
    triples = np.where(solvable[..., None, None], triples, np.eye(3))
    corners = np.linalg.solve(triples, rhs[..., None])[..., 0]
    size = np.ptp(boxes, axis=-1).max(axis=1)
    inside = (
        np.einsum("kai,kci->kca", rows, corners) <= limits[:, None] + 1e-9 * size[:, None, None]
    )
    usable = solvable & inside.all(axis=-1)
    slopes = derivative(polynomials[:, :4]) @ bernstein_matrix(DEGREE).T
    j = slopes[:, 3, None, :] - np.einsum("kci,kib->kcb", corners, slopes[:, :3])
    return np.asarray(np.where(usable[..., None], j, np.inf).min(axis=(1, 2)))


def _assemble(shape: Shape, batches: list[_Candidates]) -> Segments:
    """Put the accepted segments in order and store each shared plane once."""
    start = np.concatenate([b.start for b in batches])
    order = np.argsort(start)

    def joined(name: str) -> Floats:
        return np.asarray(np.concatenate([getattr(b, name) for b in batches])[order])

    knots = np.append(joined("start"), joined("end")[-1])
    piece = joined("piece").astype(np.intp)
    at = shape.sections(knots, np.append(piece, piece[-1]))
    normal = at.first / np.linalg.norm(at.first, axis=1)[:, None]
    planes = np.column_stack([normal, np.einsum("ki,ki->k", normal, at.axis)])
    if shape.curve.closed:
        planes[-1] = planes[0]
    return Segments(
        knots,
        planes,
        joined("origins"),
        joined("polynomials"),
        joined("axes"),
        joined("boxes"),
        float(joined("error_mm").max()),
        float(joined("j_min").min()),
    )
