"""Bounds of the section function h(phi) and its derivatives over rectangles of phi.

``h`` is the contour's gauge squared, less 1: negative inside, homogeneous of degree 2 but for the
constant. For the circle it is ``|phi|^2 - 1``; for a star-shaped contour, on the chart with major
and minor coordinates (X, Y) and t = Y / X, it is ``X^2 g(t) - 1`` with g tabulated. So its Hessian
depends on the angle alone,

    h_XX = 2 g - 2 t g' + t^2 g'',   h_XY = g' - t g'',   h_YY = g'',

is bounded at the middle too (h is C1 there, which is all the isolation of roots asks for), and the
gradient is Hessian times phi (Euler). The gauge of a convex contour is convex.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.intervals import Interval, as_interval
from phantom.compiled.tables import StarTable, derivative_ranges
from phantom.geometry.star import chart_rays
from phantom.geometry.vectors import unit

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_GRID = 48
_REACH = 1.5
_LEVELS = 6


@dataclass(frozen=True)
class SectionBounds:
    """Ranges of h's gradient (x, y) and Hessian (xx, xy, yy); of tau's where h changes along u.

    ``along`` holds h_tau, h_x_tau, h_y_tau and h_tau_tau; ``up`` and ``down`` bound the sums of the
    jumps of the slope at the corners a rectangle touches, per unit of |d phi|.
    """

    gradient: tuple[Interval, Interval]
    hessian: tuple[Interval, Interval, Interval]
    along: tuple[Interval, Interval, Interval, Interval] | None = None
    up: Floats | float = 0.0
    down: Floats | float = 0.0


class Section(Protocol):
    """What bounds h over rectangles of unit contour coordinates."""

    def over(self, x: Interval, y: Interval) -> SectionBounds:
        """Return ranges that hold for every point of the rectangles."""


class CircleSection:
    """h of the unit circle."""

    def over(self, x: Interval, y: Interval) -> SectionBounds:
        """Exact: the gradient is 2 phi and the Hessian 2."""
        two, zero = as_interval(2.0), as_interval(0.0)
        return SectionBounds((x * 2.0, y * 2.0), (two, zero, two))


class StarSection:
    """h of a star-shaped contour, from bounds of its Hessian on a grid of squares."""

    def __init__(self, table: StarTable) -> None:
        self._grid = HessianGrid(table.edges, derivative_ranges(table))
        self._kinks = table.kinks

    def over(self, x: Interval, y: Interval) -> SectionBounds:
        """Take the hull of the squares that each rectangle touches."""
        hessian, gradient, _ = self._grid.over(x, y)
        up, down = kink_bounds(self._kinks, x, y)
        return SectionBounds(gradient, hessian, None, up, down)


def kink_bounds(kinks: Floats, x: Interval, y: Interval) -> tuple[Floats | float, Floats | float]:
    """Sums of the jumps up and down at the corners whose rays the rectangles touch, times |phi|."""
    up: Floats | float = 0.0
    down: Floats | float = 0.0
    for T, rise, fall in kinks:
        ray = unit(chart_rays(np.array([T])))[0]
        along, across = x * ray[0] + y * ray[1], y * ray[0] - x * ray[1]
        touched = (across.low <= 1e-12) & (across.high >= -1e-12) & (along.high >= 0)
        size = np.where(touched, np.maximum(along.high, 0.0), 0.0)
        up = up + rise * size
        down = down + fall * size
    return up, down


class HessianGrid:
    """Bounds of the Hessian of ``X^2 g(t)`` over rectangles, for a tabulated g."""

    def __init__(self, table_edges: Floats, ranges: tuple[Floats, Floats, Floats]) -> None:
        edges = np.linspace(-_REACH, _REACH, _GRID + 1)
        x = Interval(*_pair(edges[:-1, None], edges[1:, None]))
        y = Interval(*_pair(edges[None, :-1], edges[None, 1:]))
        found = _hessian_ranges(table_edges, ranges, x, y)
        low, high = np.stack([r.low for r in found]), np.stack([r.high for r in found])
        self._low, self._high = {(0, 0): low}, {(0, 0): high}
        self._all = [Interval(a.min(), b.max()) for a, b in zip(low, high, strict=True)]

    def over(
        self, x: Interval, y: Interval
    ) -> tuple[tuple[Interval, Interval, Interval], tuple[Interval, Interval], Interval]:
        """Return ranges of the Hessian, of the gradient (Hessian phi) and of the value (Euler)."""
        h_xx, h_xy, h_yy = (self._lookup(k, x, y) for k in range(3))
        gradient = (h_xx * x + h_xy * y, h_xy * x + h_yy * y)
        value = (h_xx * x.squared() + h_xy * (x * y) * 2.0 + h_yy * y.squared()) * 0.5
        return (h_xx, h_xy, h_yy), gradient, value

    def _lookup(self, k: int, x: Interval, y: Interval) -> Interval:
        (low_x, high_x, level_x), (low_y, high_y, level_y) = _span(x), _span(y)
        low_x, high_x, level_x, low_y, high_y, level_y = np.broadcast_arrays(
            low_x, high_x, level_x, low_y, high_y, level_y
        )
        lowest, highest = np.empty(level_x.shape), np.empty(level_x.shape)
        levels = level_x * _LEVELS + level_y
        for level in np.unique(levels):
            here = levels == level
            a, b = divmod(int(level), _LEVELS)
            low, high = self._blocks(a, b)
            i = (low_x[here], high_x[here] - 2**a + 1)
            j = (low_y[here], high_y[here] - 2**b + 1)
            corners = [(p, q) for p in i for q in j]
            lowest[here] = np.min([low[k, p, q] for p, q in corners], axis=0)
            highest[here] = np.max([high[k, p, q] for p, q in corners], axis=0)
        # Beyond the grid any angle may be meant.
        outside = (x.low < -_REACH) | (x.high > _REACH) | (y.low < -_REACH) | (y.high > _REACH)
        whole = self._all[k]
        return Interval(
            np.where(outside, whole.low, lowest), np.where(outside, whole.high, highest)
        )

    def _blocks(self, a: int, b: int) -> tuple[Floats, Floats]:
        """Minima and maxima over all 2^a x 2^b squares, from blocks half as large."""
        if (a, b) not in self._low:
            low, high = self._blocks(a - 1, b) if a else self._blocks(a, b - 1)
            step, axis = (2 ** (a - 1), 1) if a else (2 ** (b - 1), 2)
            self._low[a, b] = np.minimum(low, _shifted(low, step, axis))
            self._high[a, b] = np.maximum(high, _shifted(high, step, axis))
        return self._low[a, b], self._high[a, b]


def _pair(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    shape = (_GRID, _GRID)
    return np.broadcast_to(a, shape), np.broadcast_to(b, shape)


def _span(r: Interval) -> tuple[Ints, Ints, Ints]:
    """Return the first and last grid index of a range, and the level of a query over them."""
    step = 2 * _REACH / _GRID
    first = np.clip(np.floor((r.low + _REACH) / step), 0, _GRID - 1).astype(np.intp)
    last = np.clip(np.floor((r.high + _REACH) / step), 0, _GRID - 1).astype(np.intp)
    level = np.floor(np.log2(last - first + 1)).astype(np.intp)
    return first, last, level


def _shifted(values: Floats, step: int, axis: int) -> Floats:
    index = np.minimum(np.arange(values.shape[axis]) + step, values.shape[axis] - 1)
    return np.asarray(np.take(values, index, axis=axis))


def _hessian_ranges(
    edges: Floats, ranges: tuple[Floats, Floats, Floats], x: Interval, y: Interval
) -> list[Interval]:
    """Ranges of h_xx, h_xy and h_yy over squares."""
    low = [np.full(x.low.shape, np.inf) for _ in range(3)]
    high = [np.full(x.low.shape, -np.inf) for _ in range(3)]
    for chart in range(4):
        major, minor = ((x, y), (y, -x), (-x, -y), (-y, x))[chart]
        touched = (major.high >= 0) & (minor.low <= major.high) & (-minor.high <= major.high)
        # t = minor / major; a square that reaches major = 0 holds every t its minor's sign allows.
        positive = major.low > 0
        safe = np.where(positive, major.low, 1.0)
        far = np.where(major.high > 0, major.high, 1.0)
        t_low = np.minimum(minor.low / safe, minor.low / far)
        t_high = np.maximum(minor.high / safe, minor.high / far)
        t_low = np.where(positive, t_low, np.where(minor.low < 0, -1.0, minor.low / far))
        t_high = np.where(positive, t_high, np.where(minor.high > 0, 1.0, minor.high / far))
        t = Interval(t_low, t_high).clipped(-1.0, 1.0)
        g, g1, g2 = _table_ranges(edges, ranges, t, chart)
        h_aa = g * 2.0 - t * g1 * 2.0 + t.squared() * g2
        h_ab = g1 - t * g2
        # Turn the chart back: odd charts exchange the axes.
        turned = (h_aa, h_ab, g2) if chart % 2 == 0 else (g2, -h_ab, h_aa)
        for k, new in enumerate(turned):
            low[k] = np.where(touched, np.minimum(low[k], new.low), low[k])
            high[k] = np.where(touched, np.maximum(high[k], new.high), high[k])
    return [Interval(a, b) for a, b in zip(low, high, strict=True)]


def _table_ranges(
    edges: Floats, tabulated: tuple[Floats, Floats, Floats], t: Interval, chart: int
) -> list[Interval]:
    """Ranges of g, g' and g'' over ranges of t on one chart."""
    count = len(edges) - 1
    base = 2.0 * chart + 1.0
    # A hair wider than asked: a point on an edge counts for the cells on both of its sides.
    first = np.searchsorted(edges, base + t.low - 1e-12, side="right") - 1
    last = np.searchsorted(edges, base + t.high + 1e-12, side="left") - 1
    start = int(np.searchsorted(edges, base - 1.0 + 1e-12, side="right")) - 1
    end = int(np.searchsorted(edges, base + 1.0 - 1e-12, side="left")) - 1
    first, last = np.clip(first, start, end), np.clip(last, start, end)
    level = np.floor(np.log2(last - first + 1)).astype(np.intp)
    results = []
    for ranges in tabulated:
        low, high = [ranges[:, 0]], [ranges[:, 1]]
        for k in range(1, int(level.max()) + 1):
            shifted = np.minimum(np.arange(count) + 2 ** (k - 1), count - 1)
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
