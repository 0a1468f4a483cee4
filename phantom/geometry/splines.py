"""Cubic splines through points: not-a-knot or periodic, C2 everywhere.

The slopes s at the knots solve a tridiagonal system (de Boor, *A Practical Guide to Splines*,
ch. IV): with steps h and chord slopes m,

    h_i s_(i-1) + 2 (h_(i-1) + h_i) s_i + h_(i-1) s_(i+1) = 3 (h_i m_(i-1) + h_(i-1) m_i).

Every pivot is positive, so nothing needs to be exchanged. Half of a command's start would go into
loading a library for these few lines.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Cubics:
    """Cubic pieces; beyond the ends the outermost go on."""

    x: Floats  # (n,) knots, increasing
    c: Floats  # (4, n - 1, ...) falling powers of u - x[piece]

    def __call__(self, u: Floats) -> Floats:
        """Return the values at u, ``(*u.shape, ...)``."""
        u = np.asarray(u, dtype=np.float64)
        piece = np.clip(np.searchsorted(self.x, u, side="right") - 1, 0, len(self.x) - 2)
        c = self.c[:, piece]
        s = (u - self.x[piece]).reshape(u.shape + (1,) * (self.c.ndim - 2))
        return np.asarray(((c[0] * s + c[1]) * s + c[2]) * s + c[3])


def not_a_knot(x: Floats, y: Floats) -> Cubics:
    """Return the spline whose third derivative is continuous at the second and last but one knot.

    Through two points it is a line, through three a parabola. ``x`` is ``(n,)``, increasing;
    ``y`` is ``(n, ...)``.
    """
    flat = y.reshape(len(y), -1)
    h = np.diff(x)
    m = np.diff(flat, axis=0) / h[:, None]
    if len(x) == 2:
        return _pieces(x, y, np.concatenate([m, m]))
    lower, middle, upper = np.ones(len(x)), np.ones(len(x)), np.ones(len(x))
    right = np.empty_like(flat)
    lower[1:-1], middle[1:-1], upper[1:-1] = h[1:], 2 * (h[:-1] + h[1:]), h[:-1]
    right[1:-1] = 3 * (h[1:, None] * m[:-1] + h[:-1, None] * m[1:])
    if len(x) == 3:
        right[0], right[-1] = 2 * m[0], 2 * m[1]
    else:
        first, last = x[2] - x[0], x[-1] - x[-3]
        middle[0], upper[0] = h[1], first
        right[0] = ((h[0] + 2 * first) * h[1] * m[0] + h[0] ** 2 * m[1]) / first
        lower[-1], middle[-1] = last, h[-2]
        right[-1] = (h[-1] ** 2 * m[-2] + (2 * last + h[-1]) * h[-2] * m[-1]) / last
    return _pieces(x, y, _tridiagonal(lower, middle, upper, right))


def periodic(x: Floats, y: Floats) -> Cubics:
    """Return the closed spline; the last point repeats the first. Shapes as in `not_a_knot`."""
    flat = y.reshape(len(y), -1)
    h = np.diff(x)
    m = np.diff(flat, axis=0) / h[:, None]
    before, m_before = np.roll(h, 1), np.roll(m, 1, axis=0)
    lower, middle, upper = h.copy(), 2 * (before + h), before.copy()
    right = 3 * (h[:, None] * m_before + before[:, None] * m)
    # All slopes but the first, by what is given and by what one unit of the first slope asks.
    unit = np.zeros(len(h))
    unit[1] -= lower[1]
    unit[-1] -= upper[-1]
    both = _tridiagonal(lower[1:], middle[1:], upper[1:], np.column_stack([right[1:], unit[1:]]))
    given, share = both[:, :-1], both[:, -1]
    rest = right[0] - lower[0] * given[-1] - upper[0] * given[0]
    start = rest / (middle[0] + lower[0] * share[-1] + upper[0] * share[0])
    slopes = np.concatenate([start[None], given + share[:, None] * start, start[None]])
    return _pieces(x, y, slopes)


def _tridiagonal(lower: Floats, middle: Floats, upper: Floats, right: Floats) -> Floats:
    """Solve by elimination; row i reads ``lower[i], middle[i], upper[i]`` about its own place."""
    result = np.array(right)
    pivots, shares = middle.tolist(), [0.0] * len(middle)
    for i in range(len(middle)):
        if i:
            pivots[i] -= float(lower[i]) * shares[i - 1]
            result[i] -= lower[i] * result[i - 1]
        shares[i] = float(upper[i]) / pivots[i]
        result[i] /= pivots[i]
    for i in range(len(middle) - 2, -1, -1):
        result[i] -= shares[i] * result[i + 1]
    return result


def _pieces(x: Floats, y: Floats, slopes: Floats) -> Cubics:
    """Return the cubics through the points with these slopes (Hermite)."""
    flat = y.reshape(len(y), -1)
    h = np.diff(x)[:, None]
    m = np.diff(flat, axis=0) / h
    t = (slopes[:-1] + slopes[1:] - 2 * m) / h
    c = np.stack([t / h, (m - slopes[:-1]) / h - t, slopes[:-1], flat[:-1]])
    return Cubics(np.array(x, dtype=np.float64), c.reshape(4, len(x) - 1, *y.shape[1:]))
