"""Axes as curves: position and derivatives of every axis the document has.

A curve is cut at its breaks (where a derivative may jump) into smooth pieces. Evaluation names
the piece, so that both one-sided values at a break can be had.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial, perm
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry import tolerances
from phantom.geometry.formula_curves import formula_curve
from phantom.geometry.refusal import RefusalError
from phantom.geometry.splines import Cubics, not_a_knot, periodic

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_CLOSER = 12  # looks between samples, each four times as close
_STEEP = 16.0  # a place this many times as high as it is steep does not go on to 0


class Curve(Protocol):
    """A space curve over ``breaks[0] <= u <= breaks[-1]``, smooth between breaks."""

    @property
    def breaks(self) -> Floats:
        """Parameters where a derivative may jump, both ends included."""

    @property
    def closed(self) -> bool:
        """Whether the end meets the start with the same tangent."""

    def derivatives(self, u: Floats, piece: Ints, order: int) -> Floats:
        """Return ``(order + 1, n, 3)``: position and derivatives by u on the named pieces."""


@dataclass(frozen=True)
class PiecewiseCurve:
    """A piecewise polynomial curve: lines, splines and B-splines."""

    breaks: Floats
    coefficients: Floats  # (pieces, degree + 1, 3), increasing powers of u - breaks[piece]
    closed: bool = False

    def derivatives(self, u: Floats, piece: Ints, order: int) -> Floats:
        """Evaluate by Horner's rule on the pieces' own polynomials."""
        coefficients = self.coefficients[piece]
        local = (u - self.breaks[piece])[:, None]
        result = np.zeros((order + 1, len(u), 3))
        for k in range(order + 1):
            for power in range(coefficients.shape[1] - 1, k - 1, -1):
                result[k] = result[k] * local + float(perm(power, k)) * coefficients[:, power]
        return result


@dataclass(frozen=True)
class TurningCurve:
    """An arc or a helix: ``centre + cos a e0 + sin a e1 + u advance`` with a = turn * u."""

    center: Floats
    e0: Floats
    e1: Floats
    turn_rad: float
    advance: Floats
    closed: bool

    @property
    def breaks(self) -> Floats:
        """A single smooth piece over [0, 1]."""
        return np.array([0.0, 1.0])

    def derivatives(self, u: Floats, piece: Ints, order: int) -> Floats:
        """Evaluate in closed form; each derivative turns the phase by a quarter."""
        result = np.empty((order + 1, len(u), 3))
        angle = self.turn_rad * u[:, None]
        for k in range(order + 1):
            phase = angle + k * np.pi / 2
            result[k] = self.turn_rad**k * (np.cos(phase) * self.e0 + np.sin(phase) * self.e1)
        result[0] += self.center + u[:, None] * self.advance
        if order >= 1:
            result[1] += self.advance
        return result


def _piecewise(spline: Cubics, closed: bool = False) -> PiecewiseCurve:
    return PiecewiseCurve(
        np.asarray(spline.x, dtype=np.float64),
        np.ascontiguousarray(np.moveaxis(spline.c[::-1], 0, 1), dtype=np.float64),
        closed,
    )


def _chord_knots(points: Floats) -> Floats:
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    knots = np.concatenate([[0.0], np.cumsum(lengths)])
    return np.asarray(knots / knots[-1])


def _spline(axis: doc.SplineAxis) -> Curve:
    points = np.array(axis.points, dtype=np.float64)
    if not axis.closed:
        return _piecewise(not_a_knot(_chord_knots(points), points))
    points = np.vstack([points, points[:1]])
    return _piecewise(periodic(_chord_knots(points), points), closed=True)


def _bspline(axis: doc.BSplineAxis) -> Curve:
    from scipy.interpolate import BSpline

    points = np.array(axis.control_points, dtype=np.float64)
    inner = len(points) - axis.degree + 1
    knots = np.concatenate(
        [np.zeros(axis.degree), np.linspace(0.0, 1.0, inner), np.ones(axis.degree)]
    )
    spline = BSpline(knots, points, axis.degree)
    breaks = np.linspace(0.0, 1.0, inner)
    # Taylor coefficients from the right at every break are the piece's own polynomial.
    orders = range(axis.degree + 1)
    taylor = [
        spline.derivative(k)(breaks[:-1]) / factorial(k) if k else spline(breaks[:-1])
        for k in orders
    ]
    return PiecewiseCurve(breaks, np.ascontiguousarray(np.stack(taylor, axis=1)))


def _arc(axis: doc.ArcAxis) -> Curve:
    center = np.array(axis.center, dtype=np.float64)
    normal = np.array(axis.normal, dtype=np.float64)
    normal /= np.linalg.norm(normal)
    e0 = np.array(axis.start, dtype=np.float64) - center
    # ``start`` was checked to lie in the plane; what rounding left along the normal goes.
    e0 -= normal * (e0 @ normal)
    return TurningCurve(
        center,
        e0,
        np.cross(normal, e0),
        float(np.radians(axis.angle_deg)),
        np.zeros(3),
        abs(axis.angle_deg) == 360,
    )


def _helix(axis: doc.HelixAxis) -> Curve:
    center = np.array(axis.center, dtype=np.float64)
    along = np.array(axis.axis, dtype=np.float64)
    along /= np.linalg.norm(along)
    offset = np.array(axis.start, dtype=np.float64) - center
    height = along * (offset @ along)
    e0 = offset - height
    return TurningCurve(
        center + height,
        e0,
        np.cross(along, e0),
        float(2 * np.pi * axis.turns),
        along * axis.pitch * abs(axis.turns),
        closed=False,
    )


def curve(axis: doc.Axis) -> Curve:
    """Turn an axis of a document into a curve, or refuse it.

    Raises
    ------
    RefusalError
        Below ``/axis``, where the curve is not regular or its tangent jumps.
    """
    match axis:
        case doc.LineAxis():
            start, end = np.array(axis.start), np.array(axis.end)
            result: Curve = PiecewiseCurve(
                np.array([0.0, 1.0]), np.stack([start, end - start])[None].astype(np.float64)
            )
        case doc.SplineAxis():
            result = _spline(axis)
        case doc.BSplineAxis():
            result = _bspline(axis)
        case doc.ArcAxis():
            result = _arc(axis)
        case doc.HelixAxis():
            result = _helix(axis)
        case doc.FormulaAxis():
            result = formula_curve(axis)
    _check(result)
    return result


def sample_parameters(breaks: Floats, per_piece: int) -> tuple[Floats, Ints]:
    """Spread ``per_piece`` parameters over every piece, both ends included, with their pieces."""
    fractions = np.linspace(0.0, 1.0, per_piece)
    u = breaks[:-1, None] + fractions * np.diff(breaks)[:, None]
    u[:, -1] = breaks[1:]
    piece = np.repeat(np.arange(len(breaks) - 1), per_piece)
    return u.ravel(), piece


def lowest(
    measure: Callable[[Floats, Ints], Floats], breaks: Floats, per_piece: int
) -> tuple[float, float]:
    """Return where a positive measure is smallest, and its value there.

    It may dip to 0 between two samples. On the way to 0 it falls, from one sample to the next, by
    more than it is still high; low places where it falls by some share of that are looked at
    closer and closer.
    """
    u, piece = sample_parameters(breaks, per_piece)
    values = measure(u, piece)
    worst = int(np.argmin(values))
    place, least = float(u[worst]), float(values[worst])
    rows = values.reshape(-1, per_piece)
    fall = np.abs(np.diff(rows, axis=1))
    edge = np.zeros((len(rows), 1))
    steepest = np.maximum(np.hstack([edge, fall]), np.hstack([fall, edge]))
    beside = np.full((len(rows), 1), np.inf)
    low = (rows <= np.hstack([beside, rows[:, :-1]])) & (rows <= np.hstack([rows[:, 1:], beside]))
    row, column = np.nonzero(low & (rows <= _STEEP * steepest))
    grid = u.reshape(-1, per_piece)
    first = grid[row, np.maximum(column - 1, 0)]
    last = grid[row, np.minimum(column + 1, per_piece - 1)]
    for _ in range(_CLOSER):
        if not len(row):
            break
        near = np.linspace(first, last, 9)
        at = measure(near.ravel(), np.tile(row, 9)).reshape(near.shape)
        best, each = np.argmin(at, axis=0), np.arange(len(row))
        values = at[best, each]
        if values.min() < least:
            worst = int(np.argmin(values))
            place, least = float(near[best, each][worst]), float(values[worst])
        first, last = near[np.maximum(best - 1, 0), each], near[np.minimum(best + 1, 8), each]
        on = values <= _STEEP * np.abs(np.diff(at, axis=0)).max(axis=0)
        row, first, last = row[on], first[on], last[on]
    return place, least


def _check(candidate: Curve) -> None:
    u, piece = sample_parameters(candidate.breaks, 65)
    _, first = candidate.derivatives(u, piece, 1)
    speed = np.linalg.norm(first, axis=1)

    def speeds(u: Floats, piece: Ints) -> Floats:
        return np.asarray(np.linalg.norm(candidate.derivatives(u, piece, 1)[1], axis=1))

    place, slowest = lowest(speeds, candidate.breaks, 65)
    if slowest <= tolerances.IRREGULAR_SPEED * speed.mean():
        raise RefusalError(
            "/axis",
            "irregular_axis",
            f"the axis stops at u = {place:.6g} (speed {slowest:.3g} mm per unit of u, "
            f"mean {speed.mean():.3g}); expected a regular curve",
        )
    tangents = (first / speed[:, None]).reshape(-1, 65, 3)
    ends, starts, places = tangents[:-1, -1], tangents[1:, 0], candidate.breaks[1:-1]
    if candidate.closed:
        ends = np.vstack([ends, tangents[-1:, -1]])
        starts = np.vstack([starts, tangents[:1, 0]])
        places = np.append(places, candidate.breaks[-1])
    if len(ends) == 0:
        return
    angles = np.arctan2(
        np.linalg.norm(np.cross(ends, starts), axis=1), np.einsum("ij,ij->i", ends, starts)
    )
    worst = int(np.argmax(angles))
    if angles[worst] > tolerances.TANGENT_JUMP_RAD:
        raise RefusalError(
            "/axis",
            "tangent_jump",
            f"the tangent turns by {np.degrees(angles[worst]):.3g} degrees at once "
            f"at u = {places[worst]:.6g}; expected a smooth axis",
        )
