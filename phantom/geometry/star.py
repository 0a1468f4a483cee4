"""A star-shaped outline as a function of the pseudo-angle.

Four charts, one per half-axis, each with t = minor/major in [-1, 1]; ``T = 2 chart + t + 1`` runs
over [0, 8) once round, anticlockwise. No arc tangent is needed to look a point up.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.outlines import Outline

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_FREELY = 5  # steps of Newton's that may leave the bracket a little
_TURNS = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])


def pseudo_angle(points: Floats) -> Floats:
    """Return T in [0, 8) of points ``(n, 2)``; the origin gives 1."""
    x, y = points[:, 0], points[:, 1]
    chart = np.where(np.abs(x) >= np.abs(y), np.where(x >= 0, 0, 2), np.where(y >= 0, 1, 3))
    cos, sin = _TURNS[chart].T
    major, minor = cos * x + sin * y, cos * y - sin * x
    t = np.divide(minor, major, out=np.zeros_like(minor), where=major != 0)
    return np.asarray(2.0 * chart + t + 1.0)


def chart_rays(T: Floats) -> Floats:
    """Return a vector ``(n, 2)`` of each pseudo-angle, with major coordinate 1."""
    chart = np.minimum(T // 2, 3).astype(np.intp)
    t = T - 2.0 * chart - 1.0
    turn = _TURNS[chart]
    return np.asarray(turn + t[:, None] * np.stack([-turn[:, 1], turn[:, 0]], axis=-1))


def monotone_cells(outline: Outline) -> tuple[Floats, Floats, Ints]:
    """Cut [0, 8] at the outline's breaks and at the ends of the charts."""
    breaks = outline.breaks
    pieces = np.arange(len(breaks) - 1)
    at = pseudo_angle(outline.derivatives(breaks[:-1], pieces)[0])
    following = np.roll(at, -1)
    starts, ends, owner = [], [], []
    for piece, (a, b) in enumerate(zip(at, following, strict=True)):
        if b <= a:
            b += 8.0
        # A piece so short that its ends meet to rounding has no cell of its own.
        if b - a > 7.999 and len(at) > 1:
            continue
        inner = np.arange(2.0 * np.floor(a / 2) + 2.0, b, 2.0)
        marks = np.concatenate([[a], inner[(inner > a) & (inner < b)], [b]])
        if a < 8.0 < b and 8.0 not in marks:
            marks = np.sort(np.append(marks, 8.0))
        for low, high in itertools.pairwise(marks):
            if high - low < 1e-13:
                continue
            wrap = 8.0 if low >= 8.0 else 0.0
            starts.append(low - wrap)
            ends.append(high - wrap)
            owner.append(piece)
    return np.array(starts), np.array(ends), np.array(owner, dtype=np.intp)


def _solve(outline: Outline, T: Floats, piece: Ints) -> Floats:
    """Find v on the named pieces where the outline has pseudo-angle T, by bisection and Newton."""
    chart = np.minimum(T // 2, 3).astype(np.intp)
    t = T - 2.0 * chart - 1.0
    turn = _TURNS[chart]
    across = np.stack([-turn[:, 1], turn[:, 0]], axis=-1)
    # The point lies on the ray of direction major + t minor: its component across it is zero.
    ray = turn + t[:, None] * across
    normal = np.stack([-ray[:, 1], ray[:, 0]], axis=-1)
    first, last = outline.breaks[piece], outline.breaks[piece + 1]
    low, high, width = first, last, last - first
    v = 0.5 * (low + high)
    found, left = v.copy(), np.arange(len(v))
    for tried in range(80):
        value = outline.derivatives(v, piece)
        f = np.einsum("ni,ni->n", value[0], normal)
        slope = np.einsum("ni,ni->n", value[1], normal)
        low, high = np.where(f < 0, v, low), np.where(f < 0, high, v)
        newton = v - f / np.where(slope != 0, slope, 1.0)
        # A root at the bracket's end is met from outside, too: it is tried before halves are.
        beyond = 0.1 * (high - low) if tried < _FREELY else 0.0
        usable = (slope > 0) & (newton >= low - beyond) & (newton <= high + beyond)
        newton = np.where(usable, np.clip(newton, low, high), newton)
        # Near the root Newton is right to rounding, even where the bracket's end is the root.
        settled = (slope > 0) & (np.abs(newton - v) <= 1e-6 * width)
        step = np.where(usable, newton, 0.5 * (low + high))
        step = np.where(settled, np.clip(newton, first, last), step)
        found[left] = step
        # A Newton step this small leaves its square: nothing.
        on = np.abs(step - v) > 1e-9 * width
        if not on.any():
            break
        v = step
        if not on.all():
            left, v, piece, normal = left[on], v[on], piece[on], normal[on]
            first, last, low, high, width = (x[on] for x in (first, last, low, high, width))
    return found


def gauge(outline: Outline, T: Floats, piece: Ints) -> Floats:
    """Return g, dg/dT and d2g/dT2 as ``(3, n)``, where g = 1 / X^2 and X is the major coordinate.

    The contour is ``X^2 g(t) = 1`` on each chart: g is a square of a linear function on a straight
    edge, and a quadratic on an ellipse.
    """
    v = _solve(outline, T, piece)
    p, p1, p2 = outline.derivatives(v, piece)
    cos, sin = _TURNS[np.minimum(T // 2, 3).astype(np.intp)].T
    a, a1, a2 = (cos * w[:, 0] + sin * w[:, 1] for w in (p, p1, p2))
    b, b1, b2 = (cos * w[:, 1] - sin * w[:, 0] for w in (p, p1, p2))
    t1 = (b1 * a - b * a1) / a**2
    t2 = (b2 * a - b * a2) / a**2 - 2 * a1 * t1 / a
    g = a**-2
    g1 = -2 * a1 / a**3
    g2 = 6 * a1**2 / a**4 - 2 * a2 / a**3
    return np.stack([g, g1 / t1, (g2 - g1 * t2 / t1) / t1**2])


def kinks(outline: Outline) -> Floats:
    """Return the corners of an outline, ``(k, 2)``: T and the jump of h's gradient there.

    Going anticlockwise over the corner's ray, the component of grad h across the ray jumps by this
    much times |phi|; positive at a convex corner. On the contour ``grad h = 2 n / (phi . n)``.
    """
    breaks = outline.breaks
    count = len(breaks) - 1
    before = np.roll(np.arange(count), 1)
    points, after1, _ = outline.derivatives(breaks[:-1], np.arange(count))
    _, before1, _ = outline.derivatives(breaks[1:][before], before)
    across = np.stack([-points[:, 1], points[:, 0]], axis=-1)
    radius2 = np.einsum("ni,ni->n", points, points)

    def slope(tangent: Floats) -> Floats:
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=-1)
        gradient = 2 * normal / np.einsum("ni,ni->n", points, normal)[:, None]
        # Per unit of |phi|, along the unit vector across the ray.
        return np.asarray(np.einsum("ni,ni->n", gradient, across) / radius2)

    jump = slope(after1) - slope(before1)
    real = np.abs(jump) > 1e-7
    return np.stack([pseudo_angle(points[real]), jump[real]], axis=-1)


def radii(outline: Outline, points: Floats) -> Floats:
    """Return the outline's radius in the direction of each point ``(n, 2)``."""
    at = pseudo_angle(points)
    starts, ends, owner = monotone_cells(outline)
    order = np.argsort(starts)
    starts, ends, owner = starts[order], ends[order], owner[order]
    cell = np.clip(np.searchsorted(starts, at, side="right") - 1, 0, len(starts) - 1)
    # r^2 = X^2 (1 + t^2) with X^2 = 1 / g.
    t = at - 2.0 * np.minimum(at // 2, 3) - 1.0
    return np.asarray(np.sqrt((1 + t**2) / gauge(outline, at, owner[cell])[0]))
