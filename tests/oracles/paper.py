"""The paper's own algorithm (Hsu and Chelberg 1993, II.C-F and III.C), slow and readable.

The ray is brought into the plane of every section, ``w(u) = -a'.(p - a) / (a'.d)``, the sweep is
undone, and the curve phi(u) is intersected with the contour by subdivision. Everything that the
paper finds by sampling is found by sampling here, so roots can be lost; that is the point.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from tests.oracles import contours
from tests.oracles.formula_text import function
from tests.oracles.naive_new import Solid, radius

PARALLEL = 1e-9
"""A section plane is parallel to a ray where ``|a'.d| / |a'|`` is below this; u is deleted."""


@dataclass(frozen=True)
class Settings:
    samples: int = 400
    """Samples along u and along v in which tangents, inflections and signs are looked for."""
    linear: float = 1e-7
    """The paper's epsilon: a piece within this of its chord is a line."""
    deleted: float = 1e-9
    """How much of u is left out on either side of a section that the ray is parallel to."""
    levels: int = 60


class Curve:
    """A plane curve over ranges of its parameter, cut so that end points bound every piece."""

    def __init__(self, place, ranges, settings):
        self.place, self.settings = place, settings
        self.step = 1e-7 * max((b - a for a, b in ranges), default=1.0)
        cuts = [self._cuts(a, b) for a, b in ranges]
        pairs = [pair for c in cuts for pair in itertools.pairwise(c)]
        self.pieces = np.array(pairs).reshape(-1, 2)

    def tangent(self, t, low=-np.inf, high=np.inf):
        """By differences that do not leave [low, high]."""
        before, after = np.maximum(t - self.step, low), np.minimum(t + self.step, high)
        return (self.place(after) - self.place(before)) / (after - before)[:, None]

    def _cuts(self, low, high):
        """Where x', y' or the bending changes its sign between two samples, halved to an end."""

        def signs(t):
            first = self.tangent(t, low, high)
            h = 300 * self.step
            after = self.tangent(np.minimum(t + h, high), low, high)
            before = self.tangent(np.maximum(t - h, low), low, high)
            turn = after - before
            bending = first[:, 0] * turn[:, 1] - first[:, 1] * turn[:, 0]
            bending[np.abs(bending) < 1e-8 * (first**2).sum(axis=1)] = 0.0
            return np.sign(np.column_stack([first, bending]))

        t = np.linspace(low, high, self.settings.samples + 1)
        # Off any symmetry, where a derivative would vanish in a sample itself.
        t[1:-1] += 0.37 * (t[1] - t[0])
        found, cuts = signs(t), [np.array([low, high])]
        for k in range(3):
            change = np.flatnonzero(found[1:, k] * found[:-1, k] < 0)
            a, b, left = t[change], t[change + 1], found[change, k]
            for _ in range(45 if len(change) else 0):
                middle = 0.5 * (a + b)
                same = signs(middle)[:, k] == left
                a, b = np.where(same, middle, a), np.where(same, b, middle)
            cuts.append(0.5 * (a + b))
        return np.unique(np.concatenate(cuts))

    def ends(self, t):
        """(K, 2 ends, 2) of pieces (K, 2)."""
        return self.place(t.ravel()).reshape(-1, 2, 2)

    def linear(self, t, ends):
        """The paper's test: where the end tangents of (t, x) meet, and how far from the chord."""
        inner = 1e-3 * np.diff(t, axis=1)[:, 0]
        step = np.minimum(self.step, inner)
        slopes = (
            (self.place(t[:, 0] + step) - ends[:, 0]) / step[:, None],
            (ends[:, 1] - self.place(t[:, 1] - step)) / step[:, None],
        )
        t0, t1 = t[:, :1], t[:, 1:]
        (s0, s1), x0, x1 = slopes, ends[:, 0], ends[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = (x0 - x1 + s1 * t1 - s0 * t0) / (s1 - s0)
            x = x0 + s0 * (at - t0)
            line = (t1 - t0) * x + (x0 - x1) * at + (x1 - x0) * t0 - x0 * (t1 - t0)
            distance = np.abs(line / np.hypot(t1 - t0, x0 - x1))
        # Parallel tangents never meet: a piece without inflections is then straight.
        distance = np.where(np.isfinite(distance), distance, 0.0)
        return np.all(distance < self.settings.linear, axis=1) | (t[:, 1] - t[:, 0] < 1e-12)


def intersect(one, two, settings):
    """Curve-intersect (II.E), level by level instead of by recursion: parameters (K, 2)."""
    i, j = np.indices((len(one.pieces), len(two.pieces))).reshape(2, -1)
    t, v = one.pieces[i], two.pieces[j]
    found = [np.zeros((0, 2))]
    for _ in range(settings.levels):
        p, q = one.ends(t), two.ends(v)
        low, high = (
            np.maximum(p.min(axis=1), q.min(axis=1)),
            np.minimum(p.max(axis=1), q.max(axis=1)),
        )
        overlap = np.all(low <= high, axis=1)
        t, v, p, q = t[overlap], v[overlap], p[overlap], q[overlap]
        if not len(t):
            break
        straight_t, straight_v = one.linear(t, p), two.linear(v, q)
        both = straight_t & straight_v
        found.append(line_intersection(t[both], v[both], p[both], q[both]))
        parts = []
        for first, second in itertools.product((0, 1), (0, 1)):
            # What is straight stays whole, and is taken once.
            keep = ~both & ~(straight_t & (first == 1)) & ~(straight_v & (second == 1))
            parts.append(
                (
                    _half(t[keep], first, straight_t[keep]),
                    _half(v[keep], second, straight_v[keep]),
                )
            )
        t, v = (np.concatenate(part) for part in zip(*parts, strict=True))
    return np.concatenate(found)


def _half(t, which, whole):
    middle = 0.5 * (t[:, 0] + t[:, 1])
    half = np.column_stack([t[:, 0], middle] if which == 0 else [middle, t[:, 1]])
    return np.where(whole[:, None], t, half)


def line_intersection(t, v, p, q):
    """Crossings of two chords, half-open at their ends, as parameters."""
    a, b, between = p[:, 1] - p[:, 0], q[:, 1] - q[:, 0], q[:, 0] - p[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        s = (between[:, 0] * b[:, 1] - between[:, 1] * b[:, 0]) / scale
        r = (between[:, 0] * a[:, 1] - between[:, 1] * a[:, 0]) / scale
    hit = (s >= 0) & (s < 1) & (r >= 0) & (r < 1)
    return np.column_stack(
        [
            t[hit, 0] + s[hit] * (t[hit, 1] - t[hit, 0]),
            v[hit, 0] + r[hit] * (v[hit, 1] - v[hit, 0]),
        ]
    )


def outline(contour):
    """A contour as a curve, and the range of its parameter."""
    if contour["type"] == "spline":
        curve = contours.spline(contour["points"])
        return curve, (0.0, curve.x[-1])
    if contour["type"] == "formula":
        x, y = (function(contour[k], "v") for k in "xy")
        return (lambda v: np.column_stack([x(v), y(v)])), tuple(contour["range"])
    r = radius(contour)
    return (
        lambda v: r(v)[:, None] * np.column_stack([np.cos(v), np.sin(v)]),
        (0.0, 2 * np.pi),
    )


class Paper:
    """One generalized cylinder with a linear sweep, as the paper traces it."""

    def __init__(self, leaf, settings=None):
        self.settings = settings or Settings()
        self.solid = Solid(leaf)
        place, span = outline(leaf["contour"])
        self.contour = Curve(place, [span], self.settings)

    def roots(self, p, d):
        """Distances w at which the ray p + w d meets the solid's surface, in order."""
        d = d / np.linalg.norm(d)
        axis, s = self.solid.axis, np.linspace(0, 1, self.settings.samples + 1)
        parallel = np.abs(axis.tangent(s) @ d) < PARALLEL
        if parallel.all():
            return np.sort(self._along_sections(p, d, s))
        poles, special = self._poles(p, d, s, parallel)
        edges = [0.0, *poles, 1.0]
        gap = self.settings.deleted
        ranges = [(a + gap * (a > 0), b - gap * (b < 1)) for a, b in itertools.pairwise(edges)]
        ranges = [(a, b) for a, b in ranges if b > a]
        phi = Curve(lambda u: self._phi(p, d, u), ranges, self.settings)
        w = self._w(p, d, intersect(phi, self.contour, self.settings)[:, 0])
        return np.sort(np.concatenate([w, special, self._end_planes(p, d)]))

    def _w(self, p, d, u):
        first = self.solid.axis(u, 1)
        return -((p - self.solid.axis(u)) * first).sum(axis=1) / (first @ d)

    def _phi(self, p, d, u):
        return self._unswept(p + self._w(p, d, u)[:, None] * d, u)

    def _unswept(self, x, u):
        n = self.solid.normal(u)
        b = np.cross(self.solid.axis.tangent(u), n)
        y = x - self.solid.axis(u)
        plane = np.column_stack([(y * n).sum(axis=1), (y * b).sum(axis=1)])
        matrix, offset = self.solid.section.matrix(self.solid._u(u))
        return np.linalg.solve(matrix, (plane - offset)[:, :, None])[:, :, 0]

    def _poles(self, p, d, s, parallel):
        """The u at which the ray runs along the section, and the roots in those sections."""
        axis = self.solid.axis
        value = axis.tangent(s) @ d
        change = np.flatnonzero(value[1:] * value[:-1] < 0)
        low, high, left = s[change], s[change + 1], value[change]
        for _ in range(60 if len(change) else 0):
            middle = 0.5 * (low + high)
            same = (axis.tangent(middle) @ d) * left > 0
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        poles = np.unique(np.concatenate([0.5 * (low + high), s[parallel]]))
        return poles, self._in_sections(p, d, poles)

    def _in_sections(self, p, d, u):
        """III.C: where the ray lies in the plane of a section it is met with the contour itself."""
        found = [np.zeros(0)]
        for one in u:
            at = np.array([one])
            if abs((p - self.solid.axis(at)[0]) @ self.solid.axis.tangent(at)[0]) > 1e-9:
                continue
            middle = (self.solid.axis(at)[0] - p) @ d
            reach = 1.5 * self.solid.far

            def line(w, at=at):
                return self._unswept(p + w[:, None] * d, np.broadcast_to(at, w.shape))

            span = [(middle - reach, middle + reach)]
            found.append(
                intersect(Curve(line, span, self.settings), self.contour, self.settings)[:, 0]
            )
        return np.concatenate(found)

    def _along_sections(self, p, d, s):
        """A straight axis across the ray: there is one section, if any, that holds the ray."""
        height = ((p - self.solid.axis(s)) * self.solid.axis.tangent(s)).sum(axis=1)
        change = np.flatnonzero((height[1:] < 0) != (height[:-1] < 0))
        if not len(change):
            return np.zeros(0)
        k = change[0]
        u = s[k] + (s[k + 1] - s[k]) * height[k] / (height[k] - height[k + 1])
        return self._in_sections(p, d, [u])

    def _end_planes(self, p, d):
        """II.F: phi at an end lies within the contour."""
        ends = np.array([0.0, 1.0])
        ends = ends[np.abs(self.solid.axis.tangent(ends) @ d) > PARALLEL]
        if self.solid.axis.closed or not len(ends):
            return np.zeros(0)
        return self._w(p, d, ends)[self.solid.section.inside(*self._phi(p, d, ends).T)]
