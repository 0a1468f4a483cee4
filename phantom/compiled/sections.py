"""Bounds of the section function h(phi) and its derivatives over rectangles of phi.

``h = |phi|^2 - q`` is negative inside the contour. q is constant for a circle; for a star-shaped
contour it is the table's q, blended to its mean near the middle, where the angle means nothing:

    q = mean + B(|phi|^2) (q(T) - mean),  B the quintic smoothstep from blend/4 to blend.

Inside the blend q stays above the smallest squared radius, so h keeps its sign. Kernels evaluate
the same formula (:mod:`phantom.kernels.section`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.intervals import Interval, as_interval
from phantom.compiled.tables import StarTable, derivative_ranges

Floats = NDArray[np.float64]

_GRID = 40
_REACH = 2.0
_LEVELS = 6


@dataclass(frozen=True)
class SectionBounds:
    """Ranges of h's gradient (x, y) and Hessian (xx, xy, yy)."""

    gradient: tuple[Interval, Interval]
    hessian: tuple[Interval, Interval, Interval]


class CircleSection:
    """h of the unit circle."""

    def over(self, x: Interval, y: Interval) -> SectionBounds:
        """Exact: the gradient is 2 phi and the Hessian 2."""
        two, zero = as_interval(2.0), as_interval(0.0)
        return SectionBounds((x * 2.0, y * 2.0), (two, zero, two))


class StarSection:
    """h of a star-shaped contour, from bounds of q on a grid of squares."""

    def __init__(self, table: StarTable) -> None:
        edges = np.linspace(-_REACH, _REACH, _GRID + 1)
        x = Interval(*np.broadcast_arrays(edges[:-1, None], edges[1:, None]))
        y = Interval(*np.broadcast_arrays(edges[None, :-1], edges[None, 1:]))
        ranges = _q_derivatives(table, x, y)
        self._pyramid = _pyramid(
            np.stack([r.low for r in ranges]), np.stack([r.high for r in ranges])
        )
        # q depends on the angle alone: farther out its derivatives only shrink.
        rim = np.zeros((_GRID, _GRID), dtype=bool)
        rim[0], rim[-1], rim[:, 0], rim[:, -1] = True, True, True, True
        self._rim = [
            Interval(np.minimum(r.low[rim].min(), 0.0), np.maximum(r.high[rim].max(), 0.0))
            for r in ranges
        ]

    def over(self, x: Interval, y: Interval) -> SectionBounds:
        """Take the hull of the squares that each rectangle touches."""
        q = [self._lookup(k, x, y) for k in range(5)]
        return SectionBounds(
            (x * 2.0 - q[0], y * 2.0 - q[1]), (2.0 - q[2], as_interval(0.0) - q[3], 2.0 - q[4])
        )

    def _lookup(self, k: int, x: Interval, y: Interval) -> Interval:
        low_x, high_x, level_x = _span(x)
        low_y, high_y, level_y = _span(y)
        low, high = self._pyramid
        corners = [
            (level_x, level_y, i, j)
            for i in (low_x, high_x - 2**level_x + 1)
            for j in (low_y, high_y - 2**level_y + 1)
        ]
        result_low = np.min([low[c[0], c[1], k, c[2], c[3]] for c in corners], axis=0)
        result_high = np.max([high[c[0], c[1], k, c[2], c[3]] for c in corners], axis=0)
        outside = (x.low < -_REACH) | (x.high > _REACH) | (y.low < -_REACH) | (y.high > _REACH)
        rim = self._rim[k]
        return Interval(
            np.where(outside, np.minimum(result_low, rim.low), result_low),
            np.where(outside, np.maximum(result_high, rim.high), result_high),
        )


def _span(r: Interval) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Return the first and last grid index of a range, and the level of a query over them."""
    step = 2 * _REACH / _GRID
    first = np.clip(np.floor((r.low + _REACH) / step), 0, _GRID - 1).astype(np.intp)
    last = np.clip(np.floor((r.high + _REACH) / step), 0, _GRID - 1).astype(np.intp)
    level = np.floor(np.log2(last - first + 1)).astype(np.intp)
    return first, last, level


def _pyramid(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Minima and maxima over all 2^i x 2^j squares: (levels, levels, quantities, grid, grid)."""
    lows = np.empty((_LEVELS, _LEVELS, *low.shape))
    highs = np.empty_like(lows)
    for i in range(_LEVELS):
        if i == 0:
            lows[0, 0], highs[0, 0] = low, high
        else:
            step = 2 ** (i - 1)
            lows[i, 0] = np.minimum(lows[i - 1, 0], _shifted(lows[i - 1, 0], step, 1))
            highs[i, 0] = np.maximum(highs[i - 1, 0], _shifted(highs[i - 1, 0], step, 1))
        for j in range(1, _LEVELS):
            step = 2 ** (j - 1)
            lows[i, j] = np.minimum(lows[i, j - 1], _shifted(lows[i, j - 1], step, 2))
            highs[i, j] = np.maximum(highs[i, j - 1], _shifted(highs[i, j - 1], step, 2))
    return lows, highs


def _shifted(values: Floats, step: int, axis: int) -> Floats:
    index = np.minimum(np.arange(values.shape[axis]) + step, values.shape[axis] - 1)
    return np.asarray(np.take(values, index, axis=axis))


def _q_derivatives(table: StarTable, x: Interval, y: Interval) -> list[Interval]:
    """Ranges of q_x, q_y, q_xx, q_xy, q_yy of the blended q over the squares."""
    shape = np.broadcast_shapes(x.low.shape, y.low.shape)
    x = Interval(*(np.broadcast_to(v, shape) for v in (x.low, x.high)))
    y = Interval(*(np.broadcast_to(v, shape) for v in (y.low, y.high)))
    start = 0.25 * table.blend
    s = x.squared() + y.squared()
    b, b1, b2 = _smoothstep(s, start, table.blend)
    result = [as_interval(np.zeros(shape)) for _ in range(5)]
    for chart in range(4):
        major, minor = ((x, y), (y, -x), (-x, -y), (-y, x))[chart]
        # Where B is 0 nothing is left of q(T): the rest has major >= sqrt(start / 2).
        floor = np.sqrt(start / 2)
        touched = (major.high > floor) & (minor.low <= major.high) & (-minor.high <= major.high)
        touched &= s.high > start
        big = Interval(np.maximum(major.low, floor), np.maximum(major.high, floor * 1.0000001))
        t = (minor * big.reciprocal()).clipped(-1.0, 1.0)
        q, q1, q2 = _table_ranges(table, t, chart)
        r = big.reciprocal()
        g_major, g_minor = -(q1 * t * r), q1 * r
        r2 = r.squared()
        h_aa = (q2 * t.squared() + q1 * t * 2.0) * r2
        h_ab = -((q2 * t + q1) * r2)
        h_bb = q2 * r2
        excess = q - table.mean
        parts = [
            b1 * excess * major * 2.0 + b * g_major,
            b1 * excess * minor * 2.0 + b * g_minor,
            b2 * excess * major.squared() * 4.0
            + b1 * (excess * 2.0 + major * g_major * 4.0)
            + b * h_aa,
            b2 * excess * major * minor * 4.0
            + b1 * (major * g_minor + minor * g_major) * 2.0
            + b * h_ab,
            b2 * excess * minor.squared() * 4.0
            + b1 * (excess * 2.0 + minor * g_minor * 4.0)
            + b * h_bb,
        ]
        ga, gb, aa, ab, bb = parts
        # Turn the chart back by quarter turns.
        turned = (
            [ga, gb, aa, ab, bb],
            [-gb, ga, bb, -ab, aa],
            [-ga, -gb, aa, ab, bb],
            [gb, -ga, bb, -ab, aa],
        )[chart]
        result = [
            Interval(
                np.where(touched, np.minimum(old.low, new.low), old.low),
                np.where(touched, np.maximum(old.high, new.high), old.high),
            )
            for old, new in zip(result, turned, strict=True)
        ]
    return result


def _smoothstep(s: Interval, start: float, end: float) -> tuple[Interval, Interval, Interval]:
    """Ranges of B, dB/ds and d2B/ds2."""
    width = end - start
    low = np.clip((s.low - start) / width, 0, 1)
    high = np.clip((s.high - start) / width, 0, 1)

    def value(z: Floats) -> Floats:
        return np.asarray(z**3 * (10 - 15 * z + 6 * z**2))

    def slope(z: Floats) -> Floats:
        return np.asarray(30 * (z * (1 - z)) ** 2)

    def bend(z: Floats) -> Floats:
        return np.asarray(60 * z * (1 - z) * (1 - 2 * z))

    peak = np.where((low <= 0.5) & (high >= 0.5), 1.875, np.maximum(slope(low), slope(high)))
    crest, trough = (3 - np.sqrt(3)) / 6, (3 + np.sqrt(3)) / 6
    ends = bend(low), bend(high)
    top = np.where((low <= crest) & (high >= crest), bend(np.array(crest)), np.maximum(*ends))
    bottom = np.where((low <= trough) & (high >= trough), bend(np.array(trough)), np.minimum(*ends))
    return (
        Interval(value(low), value(high)),
        Interval(np.minimum(slope(low), slope(high)) / width, peak / width),
        Interval(bottom / width**2, top / width**2),
    )


def _table_ranges(table: StarTable, t: Interval, chart: int) -> list[Interval]:
    """Ranges of q, q' and q'' over ranges of t on one chart."""
    cells = len(table.cells)
    base = 2.0 * chart + 1.0
    first = np.clip(np.searchsorted(table.edges, base + t.low, side="right") - 1, 0, cells - 1)
    last = np.clip(np.searchsorted(table.edges, base + t.high, side="left") - 1, 0, cells - 1)
    # A point on an edge counts for both cells beside it.
    first = np.maximum(np.where(table.edges[first] == base + t.low, first - 1, first), 0)
    last = np.maximum(first, last)
    level = np.floor(np.log2(last - first + 1)).astype(np.intp)
    results = []
    for ranges in derivative_ranges(table):
        low, high = [ranges[:, 0]], [ranges[:, 1]]
        for k in range(1, int(level.max()) + 1):
            shifted = np.minimum(np.arange(cells) + 2 ** (k - 1), cells - 1)
            low.append(np.minimum(low[-1], low[-1][shifted]))
            high.append(np.maximum(high[-1], high[-1][shifted]))
        lows, highs = np.stack(low), np.stack(high)
        other = last - 2**level + 1
        results.append(
            Interval(
                np.minimum(lows[level, first], lows[level, other]),
                np.maximum(highs[level, first], highs[level, other]),
            )
        )
    return results
