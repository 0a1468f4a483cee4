"""Generalized cylinders with formulas, matrices, morphs and sharp or non-star contours.

As in ``cylinders``: project a point onto the axis, then ask the section there. Inside, the
parameter runs over [0, 1]; formulas and profiles see the document's u.
"""

import itertools

import numpy as np
from scipy.interpolate import CubicSpline

from tests.oracles import contours, cylinders, naive
from tests.oracles.formula_text import bend, function, slope

TURNING_SAMPLES = 4000


class FormulaAxis(cylinders.Axis):
    def __init__(self, axis):
        low, high = axis["range"]
        span = high - low
        parts = [function(axis[k], "u") for k in "xyz"]
        self.breaks = np.array([0.0, 1.0])
        self.closed = bool(axis.get("closed", False))

        def stacked(one):
            return lambda s: np.stack([one(f, low + span * s) for f in parts], axis=1)

        step = 2e-3 * span
        self._parts = (
            stacked(lambda f, u: f(u)),
            stacked(lambda f, u: span * slope(f, u)),
            stacked(lambda f, u: span**2 * bend(f, u, step)),
        )


def axis_of(axis):
    return FormulaAxis(axis) if axis["type"] == "formula" else cylinders.Axis(axis)


def inside(contour):
    """Function of x, y that tells whether they are inside."""
    kind = contour["type"]
    if kind == "polar" and "formula" in contour:
        radius = function(contour["formula"], "theta")
        return lambda x, y: np.hypot(x, y) <= radius(np.mod(np.arctan2(y, x), 2 * np.pi))
    if kind == "formula":
        x, y = (function(contour[k], "v") for k in "xy")
        return _inside_curve(x, y, *contour["range"])
    return contours.inside(contour)


def _inside_curve(x, y, first, last):
    """Even-odd rule along +x, the curve cut where x or y turns round."""
    v = np.linspace(first, last, TURNING_SAMPLES + 1)
    cuts = [[first, last]]
    for part in (x, y):
        rate = np.sign(slope(part, v))
        turns = np.flatnonzero(rate[1:] != rate[:-1])
        low, high = v[turns], v[turns + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            same = np.sign(slope(part, middle)) == rate[turns]
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        cuts.append(0.5 * (low + high))
    cuts = np.unique(np.concatenate(cuts))
    corners = np.stack([x(cuts), y(cuts)], axis=1)
    corners[-1] = corners[0]
    return contours.even_odd(cuts, corners, lambda v: (x(v), y(v)))


def radius(contour):
    """r(theta) about the origin of a contour that is star-shaped there."""
    kind = contour["type"]
    if kind == "circle":
        return lambda theta: np.full(theta.shape, float(contour["radius"]))
    if kind in ("ellipse", "superellipse"):
        a, b = contour["semi_axes"]
        k = contour.get("exponent", 2)
        return lambda theta: (
            (np.abs(np.cos(theta) / a) ** k + np.abs(np.sin(theta) / b) ** k) ** (-1 / k)
        )
    if kind == "polar" and "formula" in contour:
        return function(contour["formula"], "theta")
    if kind == "polar":
        spline = contours.polar(contour["radii"])
        return lambda theta: spline(np.mod(theta, 2 * np.pi))
    test, far = inside(contour), extent(contour)

    def by_halves(theta):
        low, high = np.zeros(theta.shape), np.full(theta.shape, far)
        for _ in range(56):
            middle = 0.5 * (low + high)
            within = test(middle * np.cos(theta), middle * np.sin(theta))
            low, high = np.where(within, middle, low), np.where(within, high, middle)
        return 0.5 * (low + high)

    return by_halves


def extent(contour):
    """A radius about the origin that holds the contour."""
    if contour["type"] == "polar" and "formula" in contour:
        theta = np.linspace(0, 2 * np.pi, 4000)
        return 1.01 * function(contour["formula"], "theta")(theta).max()
    if contour["type"] == "formula":
        v = np.linspace(*contour["range"], 4000)
        return 1.01 * np.hypot(*(function(contour[k], "v")(v) for k in "xy")).max()
    return contours.extent(contour)


def profile(value):
    """Function of u, and the u where it may have a jump in a derivative."""
    if isinstance(value, dict) and "formula" in value:
        return function(value["formula"], "u"), ()
    if isinstance(value, dict):
        u, values = np.array(value["knots"], float).T
        return CubicSpline(u, values, bc_type="not-a-knot"), tuple(u)
    return (lambda u: np.full(np.shape(u), float(value))), ()


class LinearSection:
    """Contour coordinates times a matrix, plus an offset."""

    def __init__(self, sweep, contour):
        scale = sweep.get("scale", 1.0)
        given = list(scale) if isinstance(scale, list | tuple) else [scale, scale]
        given += [sweep.get("rotate_deg", 0.0), sweep.get("shear", 0.0)]
        given += list(sweep.get("offset", (0.0, 0.0)))
        self.rows = "matrix" in sweep
        if self.rows:
            given = [row[k] for row in sweep["matrix"] for k in (0, 1)]
        read = [profile(value) for value in given]
        self.parts = [f for f, _ in read]
        self.breaks = [u for _, knots in read for u in knots]
        self.inside = inside(contour)
        self.size = extent(contour)

    def matrix(self, u):
        p = np.array([f(u) for f in self.parts])
        if self.rows:
            return np.array([[p[0], p[2]], [p[1], p[3]]]).transpose(2, 0, 1), p[4:].T
        a = np.radians(p[2])
        turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        one, zero = np.ones_like(u), np.zeros_like(u)
        rest = np.array([[p[0], p[3] * p[1]], [zero, one * p[1]]])
        return np.einsum("ijn,jkn->nik", turn, rest), p[4:].T

    def reach(self, u):
        matrix, offset = self.matrix(u)
        most = np.linalg.norm(matrix, axis=(1, 2)).max() * self.size
        return most + np.linalg.norm(offset, axis=1).max()

    def __call__(self, plane, u):
        matrix, offset = self.matrix(u)
        local = np.linalg.solve(matrix, (plane - offset)[:, :, None])[:, :, 0]
        return self.inside(local[:, 0], local[:, 1])


class MorphSection:
    """For each theta the profile through the radii of the contours."""

    def __init__(self, sweep, _contour):
        self.breaks = [stop["at"] for stop in sweep["contours"]]
        self.blend = CubicSpline(self.breaks, np.eye(len(self.breaks)), bc_type="not-a-knot")
        self.radii = [radius(stop["contour"]) for stop in sweep["contours"]]
        self.inside = [inside(stop["contour"]) for stop in sweep["contours"]]

    def reach(self, u):
        theta = np.linspace(0, 2 * np.pi, 500)
        radii = np.array([r(theta) for r in self.radii])
        return 1.05 * (self.blend(u) @ radii).max()

    def fails(self, u):
        """Whether the origin is outside a contour, or the blended radius shrinks to nothing."""
        if not all(test(np.zeros(1), np.zeros(1))[0] for test in self.inside):
            return True
        theta = np.linspace(0, 2 * np.pi, 500)
        return (self.blend(u) @ np.array([r(theta) for r in self.radii])).min() <= 0

    def __call__(self, plane, u):
        theta = np.arctan2(plane[:, 1], plane[:, 0])
        radii = np.stack([r(theta) for r in self.radii], axis=1)
        return np.hypot(*plane.T) <= (self.blend(u) * radii).sum(axis=1)


class FormulaSection:
    """The inverse that the document gives, then the contour."""

    def __init__(self, sweep, contour):
        self.breaks = []
        self.forward = [function(text, "x", "y", "u") for text in sweep["forward"]]
        self.inverse = [function(text, "x", "y", "u") for text in sweep["inverse"]]
        self.inside, self.radius = inside(contour), radius(contour)

    def reach(self, u):
        theta = np.linspace(0, 2 * np.pi, 500)
        x, y = ((self.radius(theta) * f(theta))[:, None] for f in (np.cos, np.sin))
        return 1.05 * np.hypot(*(f(x, y, u[::20]) for f in self.forward)).max()

    def __call__(self, plane, u):
        return self.inside(*(f(plane[:, 0], plane[:, 1], u) for f in self.inverse))


SECTIONS = {"linear": LinearSection, "morph": MorphSection, "formula": FormulaSection}


class Solid(cylinders.Solid):
    def __init__(self, leaf, samples=400):
        sweep = leaf.get("sweep", {"type": "linear"})
        self.axis = axis_of(leaf["axis"])
        self.range = leaf["axis"].get("range", (0.0, 1.0))
        self.normal = cylinders.frame(leaf.get("frame", "rotation_minimizing"), self.axis)
        self.section = SECTIONS[sweep["type"]](sweep, leaf.get("contour"))
        knots = (np.array(self.section.breaks) - self.range[0]) / np.ptp(self.range)
        breaks = np.unique(np.concatenate([self.axis.breaks, np.clip(knots, 0, 1)]))
        count = max(8, samples // (len(breaks) - 1))
        grid = [np.linspace(a, b, count + 1) for a, b in itertools.pairwise(breaks)]
        self.grid = np.unique(np.concatenate(grid))
        self.a, self.first = self.axis(self.grid), self.axis(self.grid, 1)
        step = np.linalg.norm(np.diff(self.a, axis=0), axis=1).max()
        self.far = 1.02 * self.section.reach(self._u(self.grid)) + 2 * step

    def __call__(self, x):
        out = np.zeros(len(x), dtype=bool)
        ahead = x @ self.first.T >= (self.a * self.first).sum(axis=1)
        who, cell = np.nonzero(ahead[:, 1:] != ahead[:, :-1])
        near = np.linalg.norm(x[who] - self.a[cell], axis=1) <= self.far
        who, cell = who[near], cell[near]
        s = self._foot(x[who], self.grid[cell], self.grid[cell + 1])
        n = self.normal(s)
        b = np.cross(self.axis.tangent(s), n)
        y = x[who] - self.axis(s)
        plane = np.stack([(y * n).sum(axis=1), (y * b).sum(axis=1)], axis=1)
        np.logical_or.at(out, who, self.section(plane, self._u(s)))
        return out

    def is_none(self):
        """Whether sections are none, or reach the axis's centre of curvature, somewhere.

        The latter is looked for on grids of the plane, finer and finer about the deepest point.
        """
        if isinstance(self.section, MorphSection) and self.section.fails(self._u(self.grid)):
            return True
        size = self.far
        s, x, y = np.unique(np.linspace(0, 1, 301)), 0.0, 0.0
        for shrink in (1.0, 0.1, 0.02, 0.004):
            step = size * shrink * np.linspace(-1, 1, 41)
            grid = np.stack(np.meshgrid(s, x + step, y + step, indexing="ij"), axis=-1)
            grid = grid.reshape(-1, 3)
            depth = self._toward_centre(grid)
            worst = int(np.argmax(depth))
            if depth[worst] >= 1:
                return True
            s, x, y = grid[worst]
            s = np.clip(s + shrink * np.linspace(-0.01, 0.01, 31), 0, 1)
        return False

    def _toward_centre(self, grid):
        """(x - a) . a'' / |a'|^2 of points (s, x, y) of the sections, -inf outside them."""
        depth = []
        for s, x, y in (part.T for part in np.array_split(grid, max(1, len(grid) // 20_000))):
            n = self.normal(s)
            b = np.cross(self.axis.tangent(s), n)
            away = x[:, None] * n + y[:, None] * b
            reach = (away * self.axis(s, 2)).sum(axis=1) / (self.axis(s, 1) ** 2).sum(axis=1)
            inside = self.section(np.stack([x, y], axis=1), self._u(s))
            depth.append(np.where(inside, reach, -np.inf))
        return np.concatenate(depth)

    def _u(self, s):
        return self.range[0] + s * (self.range[1] - self.range[0])


class Twin(naive.Twin):
    """The naive twin of any document."""

    def _leaf(self, leaf):
        if leaf["type"] != "generalized_cylinder":
            return super()._leaf(leaf)
        index = len(self.leaves)
        self.leaves.append(leaf)
        shape = Solid(leaf, self.samples_of_u)
        cuts = [(np.array(c["point"]), np.array(c["normal"])) for c in leaf.get("cuts", ())]

        def state(x):
            kept = shape(x)
            for point, normal in cuts:
                kept &= (x - point) @ normal <= 0
            return {index: kept}

        return state
