"""A ray against one segment of a generalized cylinder: every chord, none lost.

Along the ray, G(w) = h(phi(w)) is negative inside. Its second derivative lies in [low, high] over
the cells it runs through (:mod:`phantom.compiled.hessians`), and a piece is discarded, accepted
or split by what that allows (engine notes in ``docs/methods/engine.md``).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import CELLS, Tables
from phantom.kernels.compiling import inner
from phantom.kernels.section import changing_star, circle, star

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STACK = 256
"""Pieces of a ray that may wait; halving to 1e-3 mm needs far fewer."""

ROW = 8
"""Numbers of a waiting piece: w, G, slope and tau at its two ends."""


EDGE = 1e-9
"""Cells are taken this much wider, in cells: a point on an edge counts for both sides."""


@inner
def contract(
    polynomials: Floats,
    k: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    work: Floats,
) -> None:
    """Write F = A + w B and phi_i = P_i + w D_i as six polynomials of tau into ``work``."""
    for j in range(3):
        row = 4 * j
        for i in range(7):
            a, b, c = polynomials[k, row, i], polynomials[k, row + 1, i], polynomials[k, row + 2, i]
            work[2 * j, i] = a * x + b * y + c * z - polynomials[k, row + 3, i]
            work[2 * j + 1, i] = a * dx + b * dy + c * dz


@inner
def solve_tau(work: Floats, w: float, tau: float) -> float:
    """Find the one tau in [-1, 1] with F = 0; F falls from one end to the other."""
    low, high = -1.0, 1.0
    for _ in range(60):
        f = work[0, 6] + w * work[1, 6]
        slope = 0.0
        for i in range(5, -1, -1):
            slope = slope * tau + f
            f = f * tau + work[0, i] + w * work[1, i]
        if f > 0:
            low = tau
        else:
            high = tau
        step = -f / slope
        following = tau + step
        if not (following >= low and following <= high):
            # Rounding at an end plane may put the root a hair outside: the end is the answer.
            following = 0.5 * (low + high) if abs(step) > 1e-9 else min(max(following, low), high)
        moved = abs(following - tau)
        tau = following
        if moved < 1e-9:
            break
    return tau


@inner
def evaluate(
    work: Floats,
    w: float,
    guess: float,
    table: int,
    tables: Tables,
) -> tuple[float, float, float]:
    """Return G, dG/dw and tau at w."""
    tau = solve_tau(work, w, guess)
    b = work[1, 6]
    f1 = 0.0
    f = work[0, 6] + w * b
    x, y = work[2, 6] + w * work[3, 6], work[4, 6] + w * work[5, 6]
    x1 = y1 = 0.0
    xd, yd = work[3, 6], work[5, 6]
    for i in range(5, -1, -1):
        f1 = f1 * tau + f
        f = f * tau + work[0, i] + w * work[1, i]
        b = b * tau + work[1, i]
        x1 = x1 * tau + x
        y1 = y1 * tau + y
        x = x * tau + work[2, i] + w * work[3, i]
        y = y * tau + work[4, i] + w * work[5, i]
        xd = xd * tau + work[3, i]
        yd = yd * tau + work[5, i]
    turn = -b / f1
    xd += x1 * turn
    yd += y1 * turn
    if table < 0:
        h, hx, hy = circle(x, y)
        return h, hx * xd + hy * yd, tau
    if tables.first_cell[table] < len(tables.cells):
        h, hx, hy = star(x, y, table, tables)
        return h, hx * xd + hy * yd, tau
    h, hx, hy, rate = changing_star(x, y, tau, table, tables)
    return h, hx * xd + hy * yd + rate * turn, tau


@inner
def stays_positive(
    g0: float,
    s0: float,
    g1: float,
    s1: float,
    span: float,
    low: float,
    high: float,
    up: float,
    down: float,
) -> bool:
    """Say whether G > 0 throughout, given its ends and bounds of its second derivative.

    Corners of the contour let the slope jump, by ``up`` and ``down`` at most in all. A parabola
    below G may have to spend the whole of ``down`` at once.
    """
    left = reach(g0, s0 - down, low)
    right = reach(g1, -s1 - down, low)
    if low <= 0.0:
        # Two concave parabolas lie below G, one from each end: together they must stay above 0.
        if left + right > span:
            return True
    elif left > span or right > span:
        # A convex one may come back up: it must stay above 0 alone.
        return True
    # G is above its chord by at least -high/2 s (span - s), and a jump costs as much again.
    bow = 0.5 * high * span * span + up * span
    if bow <= 0.0:
        return True
    # The smallest of (1-t) g0 + t g1 - bow t (1-t) over t in [0, 1].
    t = 0.5 * (1.0 - (g1 - g0) / bow)
    if t <= 0.0 or t >= 1.0:
        return True
    return (1.0 - t) * g0 + t * g1 - bow * t * (1.0 - t) > 0.0


@inner
def reach(g: float, slope: float, low: float) -> float:
    """How far ``g + slope s + low s^2 / 2`` stays positive, from g >= 0 at s = 0."""
    if slope >= 0.0:
        if low >= 0.0:
            return math.inf
        # The larger root, without cancellation.
        return -(slope + math.sqrt(slope * slope - 2.0 * low * g)) / low
    square = slope * slope - 2.0 * low * g
    if square < 0.0:
        return math.inf
    return 2.0 * g / (math.sqrt(square) - slope)


@inner
def crosses_once(
    g0: float, s0: float, s1: float, span: float, low: float, high: float, up: float, down: float
) -> bool:
    """Say whether G, of opposite signs at its ends, has exactly one root in between."""
    if (low >= 0.0 and down == 0.0) or (high <= 0.0 and up == 0.0):
        return True
    # The slope lies between two lines from each end; where they meet is its extreme.
    a, b = s0 - down, s1 - up - high * span
    s = min(max((a - b) / (high - low), 0.0), span)
    if max(a + low * s, b + high * s) > 0.0:
        return True
    a, b = s0 + up, s1 + down - low * span
    s = min(max((b - a) / (high - low), 0.0), span)
    return min(a + high * s, b + low * s) < 0.0


@inner
def polish(
    work: Floats,
    a: float,
    ga: float,
    sa: float,
    b: float,
    gb: float,
    tau: float,
    table: int,
    tables: Tables,
    counter: Ints,
) -> float:
    """Find the root of G between a and b, of opposite signs, by safeguarded Newton."""
    falling = ga > 0.0
    # A first guess from the parabola through both ends with the slope at the first.
    bend = (gb - ga - sa * (b - a)) / ((b - a) * (b - a))
    root = math.sqrt(max(sa * sa - 4.0 * bend * ga, 0.0))
    w = a + 2.0 * ga / ((root if falling else -root) - sa)
    if not (w > a and w < b):
        w = 0.5 * (a + b)
    for _ in range(100):
        g, slope, tau = evaluate(work, w, tau, table, tables)
        counter[0] += 1
        if g == 0.0:
            return w
        if (g > 0.0) == falling:
            a = w
        else:
            b = w
        step = g / slope
        following = w - step
        if not (following >= a and following <= b):
            # A root within rounding of an end is that end; halving there would end beside it.
            following = min(max(following, a), b) if abs(step) < 1e-9 else 0.5 * (a + b)
        moved = abs(following - w)
        w = following
        # A step this small leaves an error of its square: far below the rounding of w.
        if moved < 1e-9 or b - a < 1e-12:
            break
    return w


@inner
def cells_between(p: float, d: float, start: float, end: float) -> tuple[int, int]:
    """Return the first and the last cell that p + w d runs through for w in [start, end]."""
    a, b = p + start * d, p + end * d
    first = min(max(int(min(a, b) - EDGE), 0), CELLS - 1)
    last = min(max(int(max(a, b) + EDGE), 0), CELLS - 1)
    return first, last


@inner
def within_row(
    i: int, first: int, last: int, p: float, d: float, start: float, end: float
) -> tuple[float, float]:
    """Return the part of [start, end] for which p + w d is in cell i, a hair wider than it is."""
    a, b = start, end
    if first < last:
        u, v = (i - EDGE - p) / d, (i + 1 + EDGE - p) / d
        if u > v:
            u, v = v, u
        if i > 0 and i < CELLS - 1:
            a, b = max(a, u), min(b, v)
        elif (i == 0) == (d > 0):
            b = min(b, v)
        else:
            a = max(a, u)
    return a, b


@inner
def curvature(
    hessians: Floats, kinks: Floats, k: int, lane: Floats, start: float, end: float
) -> tuple[float, float, float, float]:
    """Return bounds of G'' and of the jumps of G' on [start, end] of the ray: low, high, up, down.

    They come from the cells of the box it runs through. ``lane`` holds the ray in cell units,
    ``p1 d1 p2 d2``, and the six products of its direction with itself that weight the Hessian.
    """
    low, high, up, down = math.inf, -math.inf, 0.0, 0.0
    p1, d1, p2, d2 = lane[0], lane[1], lane[2], lane[3]
    first, last = cells_between(p1, d1, start, end)
    for i in range(first, last + 1):
        a, b = within_row(i, first, last, p1, d1, start, end)
        left, right = cells_between(p2, d2, a, b)
        for j in range(left, right + 1):
            least = most = 0.0
            for pair in range(6):
                weight = lane[4 + pair]
                x = weight * hessians[k, i, j, pair, 0]
                y = weight * hessians[k, i, j, pair, 1]
                least += min(x, y)
                most += max(x, y)
            low, high = min(low, least), max(high, most)
            growth = max(1.0, kinks[k, i, j, 2] * (end - start))
            up += kinks[k, i, j, 0] * growth
            down += kinks[k, i, j, 1] * growth
    return low, high, up, down


@inner
def chords(
    work: Floats,
    stack: Floats,
    hessians: Floats,
    kinks: Floats,
    k: int,
    lane: Floats,
    start: float,
    end: float,
    shortest: float,
    table: int,
    tables: Tables,
    found: Floats,
    room: int,
    counter: Ints,
) -> int:
    """Write the chords of one segment within [start, end] into ``found``; return how many.

    A negative answer means there was no room for all of them.
    """
    g0, s0, t0 = evaluate(work, start, 0.0, table, tables)
    counter[0] += 1
    count = 0
    inside = g0 < 0.0
    entry = start
    # What one end and the bounds decide needs no look at the other.
    low, high, up, down = curvature(hessians, kinks, k, lane, start, end)
    if inside:
        if reach(-g0, -s0 - up, -high) > end - start:
            found[0, 0], found[0, 1] = start, end
            return 1
    elif reach(g0, s0 - down, low) > end - start:
        return 0
    g1, s1, t1 = evaluate(work, end, t0, table, tables)
    counter[0] += 1
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = start, g0, s0, t0
    stack[0, 4], stack[0, 5], stack[0, 6], stack[0, 7] = end, g1, s1, t1
    waiting = 1
    while waiting > 0:
        waiting -= 1
        a, g0, s0, t0 = stack[waiting, 0], stack[waiting, 1], stack[waiting, 2], stack[waiting, 3]
        b, g1, s1, t1 = stack[waiting, 4], stack[waiting, 5], stack[waiting, 6], stack[waiting, 7]
        span = b - a
        opposite = (g0 < 0.0) != (g1 < 0.0)
        short = span < shortest
        if not short and (a > start or b < end):
            low, high, up, down = curvature(hessians, kinks, k, lane, a, b)
        if opposite:
            if short or crosses_once(g0, s0, s1, span, low, high, up, down):
                w = polish(
                    work,
                    a,
                    g0,
                    s0,
                    b,
                    g1,
                    t0,
                    table,
                    tables,
                    counter,
                )
                if inside:
                    if count >= room:
                        return -1
                    found[count, 0], found[count, 1] = entry, w
                    count += 1
                else:
                    entry = w
                inside = not inside
                continue
        elif short:
            continue
        elif g0 >= 0.0:
            if stays_positive(g0, s0, g1, s1, span, low, high, up, down):
                continue
        elif stays_positive(-g0, -s0, -g1, -s1, span, -high, -low, down, up):
            continue
        # Split where the slope's secant vanishes: near the extreme that is in doubt.
        part = 0.5
        if not opposite and s0 != s1:
            part = min(max(s0 / (s0 - s1), 0.1), 0.9)
        m = a + part * span
        gm, sm, tm = evaluate(
            work,
            m,
            t0 + part * (t1 - t0),
            table,
            tables,
        )
        counter[0] += 1
        if waiting + 2 > STACK:
            return -1
        stack[waiting, 0], stack[waiting, 1], stack[waiting, 2], stack[waiting, 3] = m, gm, sm, tm
        stack[waiting, 4], stack[waiting, 5], stack[waiting, 6], stack[waiting, 7] = b, g1, s1, t1
        waiting += 1
        stack[waiting, 0], stack[waiting, 1], stack[waiting, 2], stack[waiting, 3] = a, g0, s0, t0
        stack[waiting, 4], stack[waiting, 5], stack[waiting, 6], stack[waiting, 7] = m, gm, sm, tm
        waiting += 1
    if inside:
        if count >= room:
            return -1
        found[count, 0], found[count, 1] = entry, end
        count += 1
    return count
