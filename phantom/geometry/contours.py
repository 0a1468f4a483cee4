"""Contours as star-shaped outlines about a centre, in unit coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.formula_curves import formula_outline, polar_formula_outline
from phantom.geometry.outlines import (
    CircleOutline,
    EdgesOutline,
    Outline,
    PlacedOutline,
    PolarOutline,
    RoundedOutline,
    ScaledOutline,
    SplineOutline,
    SuperellipseOutline,
    finer,
)
from phantom.geometry.partition import star_parts
from phantom.geometry.refusal import RefusalError
from phantom.geometry.simple import check_simple
from phantom.geometry.splines import periodic
from phantom.geometry.vectors import plane_cross

Floats = NDArray[np.float64]

_STAR_MARGIN = 1e-3
_GOOD_MARGIN = 0.05
_PART_MARGIN = 0.05


@dataclass(frozen=True)
class Contour:
    """A closed curve: the unit circle, or an outline, mapped by ``matrix @ unit + center`` to mm.

    ``outline`` is None for the unit circle; otherwise it is star-shaped about the unit origin and
    its farthest point lies at distance 1 (a superellipse's corners reach farther).
    """

    matrix: Floats  # (2, 2) mm
    center: Floats  # (2,) mm
    outline: Outline | None

    def unit_points(self, count: int) -> Floats:
        """Return about ``count`` points of the curve in unit coordinates, ``(n, 2)``."""
        if self.outline is None:
            angle = 2 * np.pi * np.arange(count) / count
            return np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        return outline_points(self.outline, count)


def outline_points(outline: Outline, count: int) -> Floats:
    """Spread about ``count`` points over the pieces of an outline, at least four on each."""
    return np.asarray(outline_samples(outline, count)[0])


def outline_samples(outline: Outline, count: int, shift: float = 0.0) -> Floats:
    """Return ``(3, n, 2)``: points, first and second derivatives, in order along the curve.

    ``shift`` moves the samples on by a share of their spacing.
    """
    breaks = outline.breaks
    each = max(4, int(np.ceil(count / (len(breaks) - 1))))
    fractions = (np.arange(each) + shift) / each
    v = breaks[:-1, None] + fractions * np.diff(breaks)[:, None]
    piece = np.repeat(np.arange(len(breaks) - 1), each)
    return outline.derivatives(v.ravel(), piece)


def outline_hull(outline: Outline, count: int) -> tuple[Floats, float]:
    """Return points ``(1, n, 2)`` of an outline and how far it reaches beyond their hull.

    Between two samples a curve stays within ``max |c''| dv^2 / 8`` of their chord; half as much
    again covers what c'' does between them.
    """
    breaks = outline.breaks
    each = max(4, int(np.ceil(count / (len(breaks) - 1))))
    points, _, second = outline_samples(outline, count)
    step = np.repeat(np.diff(breaks), each) / each
    sagitta = np.linalg.norm(second, axis=1) * step**2 / 8
    return points[None], 1.5 * float(sagitta.max()) + 1e-9


def contours(spec: doc.Contour) -> tuple[Contour, ...]:
    """Turn a contour of a document into star-shaped parts: one, unless no point sees it whole.

    Raises
    ------
    RefusalError
        Below ``/contour``: arcs that do not fit, a curve that crosses itself or is not closed.
    """
    match spec:
        case doc.CircleContour():
            return (Contour(np.eye(2) * spec.radius, np.zeros(2), None),)
        case doc.EllipseContour():
            return (Contour(_diagonal(spec.semi_axes), np.zeros(2), None),)
        case doc.SuperellipseContour():
            round_ = spec.exponent == 2
            outline = None if round_ else SuperellipseOutline(float(spec.exponent))
            return (Contour(_diagonal(spec.semi_axes), np.zeros(2), outline),)
        case _:
            return _stars(plane_outline(spec))


def _diagonal(semi_axes: tuple[float, float]) -> Floats:
    return np.diag(np.array(semi_axes, dtype=np.float64))


def plane_outline(spec: doc.Contour) -> Outline:
    """Return any contour as an outline in mm, about the origin of the contour plane."""
    match spec:
        case doc.CircleContour():
            return ScaledOutline(CircleOutline(), np.eye(2) * spec.radius)
        case doc.EllipseContour():
            return ScaledOutline(CircleOutline(), _diagonal(spec.semi_axes))
        case doc.SuperellipseContour():
            return ScaledOutline(
                SuperellipseOutline(float(spec.exponent)), _diagonal(spec.semi_axes)
            )
        case doc.PolarContour() if spec.formula is not None:
            polar = polar_formula_outline(spec.formula)
            _check_polar(polar, "formula")
            return polar
        case doc.PolarContour():
            assert spec.radii is not None
            radii = np.array([*spec.radii, spec.radii[0]], dtype=np.float64)
            theta = np.linspace(0.0, 2 * np.pi, len(radii))
            outline: Outline = PolarOutline(periodic(theta, radii))
            _check_polar(outline, "radii")
            return outline
        case doc.SplineContour():
            points = np.array([*spec.points, spec.points[0]], dtype=np.float64)
            lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
            knots = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
            return SplineOutline(periodic(knots, points))
        case doc.PolygonContour():
            points = np.array(spec.points, dtype=np.float64)
            return _rounded(points, float(spec.corner_radius))
        case doc.FormulaContour():
            return formula_outline(spec)


def _check_polar(outline: Outline, field: str) -> None:
    """Refuse a polar spline that swings through zero between its radii."""
    samples = outline_samples(outline, 4096)
    breaks = outline.breaks
    each = len(samples[0]) // (len(breaks) - 1)
    theta = (breaks[:-1, None] + np.arange(each) / each * np.diff(breaks)[:, None]).ravel()
    radius = np.cos(theta) * samples[0][:, 0] + np.sin(theta) * samples[0][:, 1]
    lowest = int(np.argmin(radius))
    if radius[lowest] <= 0:
        raise RefusalError(
            f"/contour/{field}",
            "crossing_contour",
            f"the radius reaches r = {radius[lowest]:.4g} mm at theta = "
            f"{np.degrees(theta[lowest]):.4g} degrees; expected r > 0 all round",
        )


def _rounded(points: Floats, radius: float) -> Outline:
    """Give every corner a tangent arc of the radius."""
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    into, out = points - before, after - points
    lengths = np.linalg.norm(out, axis=1)
    for k, length in enumerate(lengths):
        if length == 0:
            raise RefusalError(
                f"/contour/points/{k}", "equal_neighbours", "this corner equals the next one"
            )
    into, out = into / np.linalg.norm(into, axis=1)[:, None], out / lengths[:, None]
    turn = np.arctan2(
        into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0], np.einsum("ij,ij->i", into, out)
    )
    straight = np.abs(turn) < 1e-12
    if straight.any():
        # A corner that does not turn is none.
        return _rounded(points[~straight], radius)
    if radius == 0:
        return EdgesOutline(points)
    reach = radius * np.tan(np.minimum(np.abs(turn), np.pi - 1e-9) / 2)
    needed = reach + np.roll(reach, -1)
    worst = int(np.argmax(needed - lengths))
    if needed[worst] > lengths[worst]:
        raise RefusalError(
            "/contour/corner_radius",
            "corner_radius",
            f"arcs of radius {radius:g} mm need {needed[worst]:.4g} mm of the edge after corner "
            f"{worst}, which is {lengths[worst]:.4g} mm long; expected a smaller radius",
        )
    arc_starts = points - into * reach[:, None]
    arc_ends = points + out * reach[:, None]
    side = np.where(turn >= 0, 1.0, -1.0)
    centers = arc_starts + radius * side[:, None] * np.stack([-into[:, 1], into[:, 0]], axis=-1)
    # Edge k runs from the arc at corner k to the arc at corner k + 1.
    return RoundedOutline(
        arc_ends,
        np.roll(arc_starts, -1, axis=0),
        np.roll(centers, -1, axis=0),
        np.roll(turn, -1),
    )


def _stars(outline: Outline) -> tuple[Contour, ...]:
    """Return the outline as one star-shaped contour, or as the fewest parts a few tries give."""
    check_simple(outline)
    one = star(outline, None, _PART_MARGIN)
    if one is not None:
        return (one,)
    parts = star_parts(outline, lambda part: star(part, None, _PART_MARGIN))
    if parts is None:
        raise RefusalError(
            "/contour",
            "contour_detail",
            "the contour cannot be cut into star-shaped parts; expected a simpler one",
        )
    return tuple(parts)


def star(
    outline: Outline, center: Floats | None = None, least_margin: float = _STAR_MARGIN
) -> Contour | None:
    """Place an outline about a point that sees it whole, scaled to reach 1; None if there is none.

    With ``center`` given, only that point is tried. The margin is how far inside all tangents the
    point must lie, as a share of the outline's size.
    """
    samples = outline_samples(outline, 1024)
    points, first = samples[0], samples[1]
    area = 0.5 * plane_cross(points, np.roll(points, -1, axis=0)).sum()
    reverse = bool(area < 0)
    keep = np.linalg.norm(first, axis=1) > 0
    edges = first[keep] / np.linalg.norm(first[keep], axis=1)[:, None] * (-1.0 if reverse else 1.0)
    edge_points = points[keep]
    size = float(np.ptp(points, axis=0).max())
    if center is None:
        center = _centroid(points)
        margin = _margin(center, edge_points, edges)
        if margin < _GOOD_MARGIN * size:
            center = _deepest(edge_points, edges, size)
            margin = _margin(center, edge_points, edges)
    else:
        margin = _margin(center, edge_points, edges)
    winding = np.unwrap(np.arctan2(*(points - center).T[::-1]), period=2 * np.pi)
    turns = abs(winding[-1] - winding[0]) / (2 * np.pi)
    if margin < least_margin * size or turns > 1.5:
        return None
    scale = float(np.linalg.norm(points - center, axis=1).max())
    placed = PlacedOutline(outline, center, scale, reverse)
    return Contour(np.eye(2) * scale, center, finer(placed))


def _centroid(points: Floats) -> Floats:
    following = np.roll(points, -1, axis=0)
    weights = plane_cross(points, following)
    if abs(weights.sum()) <= 1e-9 * np.abs(weights).sum():
        # A curve that crosses itself may enclose nothing in all.
        return np.asarray(points.mean(axis=0))
    return np.asarray(((points + following) * weights[:, None]).sum(axis=0) / (3 * weights.sum()))


def _margin(center: Floats, points: Floats, edges: Floats) -> float:
    """Distance from the centre to the nearest tangent line, negative outside one."""
    return float(plane_cross(edges, center - points).min())


def _deepest(points: Floats, edges: Floats, size: float) -> Floats:
    """Return the point farthest inside all tangent lines (a linear programme)."""
    from scipy.optimize import linprog

    # cross(e, c - p) >= m for all samples; maximise m over c = (x, y).
    rows = np.stack([edges[:, 1], -edges[:, 0], np.ones(len(edges))], axis=-1)
    limits = -plane_cross(edges, points)
    span = [(-size + points[:, k].min(), size + points[:, k].max()) for k in range(2)]
    answer = linprog([0, 0, -1], A_ub=rows, b_ub=limits, bounds=[*span, (-2 * size, size)])
    return np.asarray(answer.x, dtype=np.float64)[:2]
