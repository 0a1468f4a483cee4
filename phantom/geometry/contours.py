"""Contours as star-shaped outlines about a centre, in unit coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from phantom import document as doc
from phantom.geometry.outlines import (
    Outline,
    PlacedOutline,
    PolarOutline,
    RoundedOutline,
    SplineOutline,
    SuperellipseOutline,
)
from phantom.geometry.refusal import RefusalError

Floats = NDArray[np.float64]

_STAR_MARGIN = 1e-3
_GOOD_MARGIN = 0.05


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

    def points(self, count: int) -> Floats:
        """Return about ``count`` points of the curve in mm, ``(n, 2)``."""
        return np.asarray(self.unit_points(count) @ self.matrix.T + self.center)


def outline_points(outline: Outline, count: int) -> Floats:
    """Spread about ``count`` points over the pieces of an outline, at least four on each."""
    return np.asarray(outline_samples(outline, count)[0])


def outline_samples(outline: Outline, count: int) -> Floats:
    """Return ``(3, n, 2)``: points, first and second derivatives, in order along the curve."""
    breaks = outline.breaks
    each = max(4, int(np.ceil(count / (len(breaks) - 1))))
    fractions = np.arange(each) / each
    v = breaks[:-1, None] + fractions * np.diff(breaks)[:, None]
    piece = np.repeat(np.arange(len(breaks) - 1), each)
    return outline.derivatives(v.ravel(), piece)


def contour(spec: doc.Contour) -> Contour:
    """Turn a contour of a document into its star-shaped form, or refuse it.

    Raises
    ------
    RefusalError
        Below ``/contour``: arcs that do not fit, a curve that crosses itself, or one that is not
        star-shaped about any point.
    """
    match spec:
        case doc.CircleContour():
            return Contour(np.eye(2) * spec.radius, np.zeros(2), None)
        case doc.EllipseContour():
            return Contour(np.diag(np.array(spec.semi_axes, dtype=np.float64)), np.zeros(2), None)
        case doc.SuperellipseContour():
            matrix = np.diag(np.array(spec.semi_axes, dtype=np.float64))
            if spec.exponent == 2:
                return Contour(matrix, np.zeros(2), None)
            return Contour(matrix, np.zeros(2), SuperellipseOutline(float(spec.exponent)))
        case doc.PolarContour():
            radii = np.array([*spec.radii, spec.radii[0]], dtype=np.float64)
            theta = np.linspace(0.0, 2 * np.pi, len(radii))
            outline: Outline = PolarOutline(CubicSpline(theta, radii, bc_type="periodic"))
            _check_polar(outline)
        case doc.SplineContour():
            points = np.array([*spec.points, spec.points[0]], dtype=np.float64)
            lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
            knots = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
            outline = SplineOutline(CubicSpline(knots, points, bc_type="periodic"))
        case doc.PolygonContour():
            outline = _rounded(np.array(spec.points, dtype=np.float64), float(spec.corner_radius))
    return _star(outline)


def _check_polar(outline: Outline) -> None:
    """Refuse a polar spline that swings through zero between its radii."""
    samples = outline_samples(outline, 4096)
    breaks = outline.breaks
    each = len(samples[0]) // (len(breaks) - 1)
    theta = (breaks[:-1, None] + np.arange(each) / each * np.diff(breaks)[:, None]).ravel()
    radius = np.cos(theta) * samples[0][:, 0] + np.sin(theta) * samples[0][:, 1]
    lowest = int(np.argmin(radius))
    if radius[lowest] <= 0:
        raise RefusalError(
            "/contour/radii",
            "crossing_contour",
            f"the curve through the radii reaches r = {radius[lowest]:.4g} mm at theta = "
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


def _star(outline: Outline) -> Contour:
    """Find the point the outline is star-shaped about, and scale it to reach 1."""
    samples = outline_samples(outline, 1024)
    points, first = samples[0], samples[1]
    area = 0.5 * _cross(points, np.roll(points, -1, axis=0)).sum()
    reverse = bool(area < 0)
    keep = np.linalg.norm(first, axis=1) > 0
    edges = first[keep] / np.linalg.norm(first[keep], axis=1)[:, None] * (-1.0 if reverse else 1.0)
    edge_points = points[keep]
    size = float(np.ptp(points, axis=0).max())
    center = _centroid(points)
    margin = _margin(center, edge_points, edges)
    if margin < _GOOD_MARGIN * size:
        center = _deepest(edge_points, edges, size)
        margin = _margin(center, edge_points, edges)
    winding = np.unwrap(np.arctan2(*(points - center).T[::-1]), period=2 * np.pi)
    turns = abs(winding[-1] - winding[0]) / (2 * np.pi)
    if margin < _STAR_MARGIN * size or turns > 1.5:
        _refuse(points, margin)
    scale = float(np.linalg.norm(points - center, axis=1).max())
    return Contour(np.eye(2) * scale, center, PlacedOutline(outline, center, scale, reverse))


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _centroid(points: Floats) -> Floats:
    following = np.roll(points, -1, axis=0)
    weights = _cross(points, following)
    return np.asarray(((points + following) * weights[:, None]).sum(axis=0) / (3 * weights.sum()))


def _margin(center: Floats, points: Floats, edges: Floats) -> float:
    """Distance from the centre to the nearest tangent line, negative outside one."""
    return float(_cross(edges, center - points).min())


def _deepest(points: Floats, edges: Floats, size: float) -> Floats:
    """Return the point farthest inside all tangent lines (a linear programme)."""
    from scipy.optimize import linprog

    # cross(e, c - p) >= m for all samples; maximise m over c = (x, y).
    rows = np.stack([edges[:, 1], -edges[:, 0], np.ones(len(edges))], axis=-1)
    limits = -_cross(edges, points)
    span = [(-size + points[:, k].min(), size + points[:, k].max()) for k in range(2)]
    answer = linprog([0, 0, -1], A_ub=rows, b_ub=limits, bounds=[*span, (-2 * size, size)])
    return np.asarray(answer.x, dtype=np.float64)[:2]


def _refuse(points: Floats, margin: float) -> None:
    """Say which it is: a curve that crosses itself, or a simple one that is not a star."""
    a, b = points, np.roll(points, -1, axis=0)
    d = b - a
    side_a = _cross(d[:, None], a[None] - a[:, None])
    side_b = _cross(d[:, None], b[None] - a[:, None])
    crossing = (side_a * side_b < 0) & (side_a.T * side_b.T < 0)
    if crossing.any():
        i, j = np.argwhere(crossing)[0]
        raise RefusalError(
            "/contour",
            "crossing_contour",
            f"the contour crosses itself near ({a[i][0]:.4g}, {a[i][1]:.4g}) mm, at "
            f"{i / len(a):.3f} and {j / len(a):.3f} of its length; expected a simple closed curve",
        )
    raise RefusalError(
        "/contour",
        "not_star_shaped",
        f"no point sees the whole contour (best margin {margin:.3g} mm); "
        "expected a contour that is star-shaped about some point",
    )
