"""Generalized cylinders by their definition: project a point onto the axis, undo the sweep.

A point is inside if at some u with (x - a(u)) . a'(u) = 0 its place in the plane of n and b,
brought back by the inverse of the sweep, is inside the contour.
"""

import itertools

import numpy as np
from scipy.interpolate import BSpline, CubicSpline

from tests.oracles import contours

FOOT = 2e-15


class Axis:
    """a(u) and its derivatives, with the places where a third derivative may jump."""

    def __init__(self, axis):
        kind = axis["type"]
        self.breaks = np.array([0.0, 1.0])
        self.closed = bool(axis.get("closed", False)) or abs(axis.get("angle_deg", 0)) == 360
        if kind == "line":
            start, end = np.array(axis["start"], float), np.array(axis["end"], float)
            one = np.ones((1, 3))
            self._parts = (
                lambda u: start + u[:, None] * (end - start),
                lambda u: np.broadcast_to(end - start, (len(u), 3)),
                lambda u: 0 * u[:, None] * one,
            )
        elif kind in ("spline", "bspline"):
            curve = _spline(axis) if kind == "spline" else _bspline(axis)
            self.breaks = np.unique(curve.x if kind == "spline" else curve.t)
            self._parts = tuple(lambda u, k=k: curve(u, k) for k in range(3))
        else:
            self._parts = _turning(axis)

    def __call__(self, u, order=0):
        return self._parts[order](np.asarray(u, float))

    def tangent(self, u):
        first = self(u, 1)
        return first / np.linalg.norm(first, axis=1)[:, None]


def _spline(axis):
    points = np.array(axis["points"], float)
    if axis.get("closed"):
        points = np.vstack([points, points[:1]])
    chord = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    ends = "periodic" if axis.get("closed") else "not-a-knot"
    return CubicSpline(chord / chord[-1], points, bc_type=ends)


def _bspline(axis):
    points, degree = np.array(axis["control_points"], float), axis["degree"]
    inner = np.linspace(0, 1, len(points) - degree + 1)
    return BSpline(np.concatenate([[0] * degree, inner, [1] * degree]), points, degree)


def _turning(axis):
    """A circle, or a circle with an advance along its normal."""
    center, start = np.array(axis["center"], float), np.array(axis["start"], float)
    k = np.array(axis["normal"] if axis["type"] == "arc" else axis["axis"], float)
    k /= np.linalg.norm(k)
    height = (start - center) @ k
    x = start - center - height * k
    y = np.cross(k, x)
    if axis["type"] == "arc":
        angle, rise = np.radians(axis["angle_deg"]), 0.0
    else:
        # Each turn advances by the pitch, left-handed turns too.
        angle, rise = 2 * np.pi * axis["turns"], axis["pitch"] * abs(axis["turns"])
    base = center + height * k

    def at(u):
        a = (angle * u)[:, None]
        return base + np.cos(a) * x + np.sin(a) * y + rise * u[:, None] * k

    def first(u):
        a = (angle * u)[:, None]
        return angle * (np.cos(a) * y - np.sin(a) * x) + rise * k

    def second(u):
        a = (angle * u)[:, None]
        return -(angle**2) * (np.cos(a) * x + np.sin(a) * y)

    return at, first, second


class RotationMinimizing:
    """Double reflection (Wang et al. 2008) on a fine grid that holds the breaks."""

    def __init__(self, axis, steps=3000):
        self.axis = axis
        count = max(40, steps // (len(axis.breaks) - 1))
        grid = [
            np.linspace(a, b, count + 1) for a, b in zip(axis.breaks, axis.breaks[1:], strict=False)
        ]
        self.grid = np.unique(np.concatenate(grid))
        tangents = axis.tangent(self.grid)
        world = np.array([0.0, 1.0, 0.0] if abs(tangents[0, 0]) > 0.9 else [1.0, 0.0, 0.0])
        n = world - (world @ tangents[0]) * tangents[0]
        self.n = [n / np.linalg.norm(n)]
        places = axis(self.grid)
        turns = _turn(places[:-1], places[1:], tangents[:-1], tangents[1:])
        for turn in turns:
            self.n.append(turn @ self.n[-1])
        self.n = np.array(self.n)
        self.leftover = 0.0
        if axis.closed:
            b = np.cross(tangents[0], self.n[0])
            self.leftover = np.arctan2(self.n[-1] @ b, self.n[-1] @ self.n[0])
            if self.leftover <= -np.pi + 1e-12:
                self.leftover = np.pi

    def __call__(self, u):
        i = np.clip(np.searchsorted(self.grid, u, side="right") - 1, 0, len(self.grid) - 2)
        start = self.grid[i]
        turns = _turn(
            self.axis(start), self.axis(u), self.axis.tangent(start), self.axis.tangent(u)
        )
        n = np.einsum("nij,nj->ni", turns, self.n[i])
        t = self.axis.tangent(u)
        turn = (-self.leftover * u)[:, None]
        return np.cos(turn) * n + np.sin(turn) * np.cross(t, n)


def _turn(x0, x1, t0, t1):
    """Matrices (k, 3, 3) that carry a frame from x0 to x1: a reflection in the plane between the
    two points, then one that brings the tangent onto that at x1."""
    first = _reflection(x1 - x0)
    return _reflection(t1 - np.einsum("nij,nj->ni", first, t0)) @ first


def _reflection(v):
    square = (v * v).sum(axis=1)[:, None, None]
    outer = v[:, :, None] * v[:, None, :]
    return np.eye(3) - 2 * np.where(square == 0, 0.0, outer) / np.where(square == 0, 1.0, square)


def frame(kind, axis):
    """n as a function of u."""
    if kind == "rotation_minimizing":
        return RotationMinimizing(axis)
    if kind == "frenet":
        u = np.linspace(0, 1, 500)
        bend = np.linalg.norm(np.cross(axis(u, 1), axis(u, 2)), axis=1)
        if bend.max() < 1e-9 * np.linalg.norm(axis(u, 1), axis=1).max() ** 2:
            return RotationMinimizing(axis)

        def toward(u):
            return axis(u, 2)

    else:
        up = np.array(kind["up"], float)

        def toward(u):
            return np.broadcast_to(up, (len(u), 3))

    def normal(u):
        t, v = axis.tangent(u), toward(u)
        n = v - (v * t).sum(axis=1)[:, None] * t
        return n / np.linalg.norm(n, axis=1)[:, None]

    return normal


def profile(value):
    """Function of u."""
    if isinstance(value, dict):
        u, values = np.array(value["knots"], float).T
        return CubicSpline(u, values, bc_type="not-a-knot")
    return lambda u: np.full(np.shape(u), float(value))


class Sweep:
    """The matrix R H D and the offset at u."""

    def __init__(self, sweep):
        scale = sweep.get("scale", 1.0)
        both = scale if isinstance(scale, list | tuple) else (scale, scale)
        self.scale = [profile(s) for s in both]
        self.angle = profile(sweep.get("rotate_deg", 0.0))
        self.shear = profile(sweep.get("shear", 0.0))
        self.offset = [profile(s) for s in sweep.get("offset", (0.0, 0.0))]
        given = [*both, *(sweep.get(k, 0.0) for k in ("rotate_deg", "shear"))]
        given += list(sweep.get("offset", (0.0, 0.0)))
        knots = [[k[0] for k in g["knots"]] for g in given if isinstance(g, dict)]
        self.breaks = np.unique(np.concatenate([[0.0, 1.0], *knots]))

    def __call__(self, u):
        zero, one = np.zeros_like(u), np.ones_like(u)
        a = np.radians(self.angle(u))
        turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        shear = np.array([[one, self.shear(u)], [zero, one]])
        scale = np.array([[self.scale[0](u), zero], [zero, self.scale[1](u)]])
        matrix = np.einsum("ijn,jkn,kln->nil", turn, shear, scale)
        return matrix, np.stack([self.offset[0](u), self.offset[1](u)], axis=1)


class Solid:
    """One generalized cylinder of a document."""

    def __init__(self, leaf, samples=400):
        self.axis = Axis(leaf["axis"])
        self.normal = frame(leaf.get("frame", "rotation_minimizing"), self.axis)
        self.sweep = Sweep(leaf.get("sweep", {}))
        self.contour = leaf["contour"]
        self.inside = contours.inside(self.contour)
        breaks = np.unique(np.concatenate([self.axis.breaks, self.sweep.breaks]))
        count = max(8, samples // (len(breaks) - 1))
        grid = [np.linspace(a, b, count + 1) for a, b in itertools.pairwise(breaks)]
        self.grid = np.unique(np.concatenate(grid))
        self.a, self.first = self.axis(self.grid), self.axis(self.grid, 1)
        matrix, offset = self.sweep(self.grid)
        reach = np.linalg.norm(matrix, axis=(1, 2)).max() * contours.extent(self.contour)
        step = np.linalg.norm(np.diff(self.a, axis=0), axis=1).max()
        self.far = 1.02 * reach + np.linalg.norm(offset, axis=1).max() + 2 * step

    def __call__(self, x):
        out = np.zeros(len(x), dtype=bool)
        f = x @ self.first.T - (self.a * self.first).sum(axis=1)
        ahead = f >= 0
        who, cell = np.nonzero(ahead[:, 1:] != ahead[:, :-1])
        # Where the axis is farther than any section reaches, nothing is to be found.
        near = np.linalg.norm(x[who] - self.a[cell], axis=1) <= self.far
        who, cell = who[near], cell[near]
        u = self._foot(x[who], self.grid[cell], self.grid[cell + 1])
        local = self.unswept(x[who], u)
        np.logical_or.at(out, who, self.inside(local[:, 0], local[:, 1]))
        return out

    def unswept(self, x, u):
        """The point in the plane of the contour as it was before the sweep."""
        n = self.normal(u)
        b = np.cross(self.axis.tangent(u), n)
        y = x - self.axis(u)
        matrix, offset = self.sweep(u)
        plane = np.stack([(y * n).sum(axis=1), (y * b).sum(axis=1)], axis=1) - offset
        return np.linalg.solve(matrix, plane[:, :, None])[:, :, 0]

    def _foot(self, x, low, high):
        """The root of (x - a) . a' between low and high: Newton steps, or halves where they leave.

        A point is done when its step is some 1e-12 mm along the axis.
        """
        u = 0.5 * (low + high)
        low, high, out = low.copy(), high.copy(), u.copy()
        left = np.arange(len(x))
        ahead = self._ahead(x, low) >= 0
        for _ in range(60):
            if not len(left):
                break
            first, away = self.axis(u, 1), x - self.axis(u)
            value = (away * first).sum(axis=1)
            same = (value >= 0) == ahead
            low, high = np.where(same, u, low), np.where(same, high, u)
            slope = (away * self.axis(u, 2)).sum(axis=1) - (first**2).sum(axis=1)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = u - value / slope
            good = (step >= low) & (step <= high)
            new = np.where(good, step, 0.5 * (low + high))
            out[left] = new
            on = np.abs(new - u) > FOOT
            left, x, u, low, high, ahead = (v[on] for v in (left, x, new, low, high, ahead))
        return out

    def _ahead(self, x, u):
        return ((x - self.axis(u)) * self.axis(u, 1)).sum(axis=1)


def membership(leaf, samples=400):
    """Inside test of a generalized cylinder, without its cuts."""
    return Solid(leaf, samples)


def volume(leaf, nodes=60):
    """V = integral of A (1 - kappa n . g) |a'| du, g the centroid of the section.

    Gauss's rule between the breaks. With n the direction to the centre of curvature,
    kappa n = a'' across the tangent over |a'|^2.
    """
    solid = Solid(leaf, 8)
    area, centroid = contours.moments(solid.contour)
    node, weight = np.polynomial.legendre.leggauss(nodes)
    breaks = np.unique(np.concatenate([solid.axis.breaks, solid.sweep.breaks]))
    total = 0.0
    for a, b in itertools.pairwise(breaks):
        u = 0.5 * (a + b) + 0.5 * (b - a) * node
        first, second, t = solid.axis(u, 1), solid.axis(u, 2), solid.axis.tangent(u)
        speed = np.linalg.norm(first, axis=1)
        bend = (second - (second * t).sum(axis=1)[:, None] * t) / speed[:, None] ** 2
        n = solid.normal(u)
        across = np.cross(t, n)
        matrix, offset = solid.sweep(u)
        g = matrix @ centroid + offset
        g = g[:, :1] * n + g[:, 1:] * across
        share = np.abs(np.linalg.det(matrix)) * (1 - (bend * g).sum(axis=1)) * speed
        total += area * (share * weight).sum() * 0.5 * (b - a)
    return total
