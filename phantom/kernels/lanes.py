"""Lanes: many rays against one segment, side by side in one flat array.

A row holds one number of every lane; rows lie ``STRIDE`` apart, so that the compiler can see that
they never overlap. A lane is a pixel of the tile (``I``, ``J``) and an interval of its ray.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Tables
from phantom.kernels.compiling import lane, lane_loop
from phantom.kernels.jets import (
    Fan,
    fan,
    from_one_point,
    jet,
    mixed,
    nearer_tau,
    own,
    rate,
    value_and_slope,
)

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TILE_ROWS, TILE_COLUMNS = 16, 128
"""Pixels of a tile; wide, since neighbours along a row meet solids in the same order."""

LANES = TILE_ROWS * TILE_COLUMNS

HELD = 4 * LANES
"""Intervals that may wait."""

CHUNK = 512
"""Intervals looked at together: few enough for their numbers to stay in the nearest cache."""

STRIDE = HELD + 72
"""Not a power of two: rows at such a distance would share the same lines of the cache."""

# The intervals in question: pixel; w, G, slope and tau at either end.
I, J, A, GA, SA, TA, B, GB, SB, TB = (n * STRIDE for n in range(10))  # noqa: E741
# Those to be split, in the same order.
YI, YJ, YA, YGA, YSA, YTA, YB, YGB, YSB, YTB = (n * STRIDE for n in range(10, 20))
# Where G is wanted, and what it is there.
AT_I, AT_J, AT_W, AT_T, G, SLOPE, TAU = (n * STRIDE for n in range(20, 27))
# Intervals with one root each.
RI, RJ, RA, RGA, RB, RW, RT, RS = (n * STRIDE for n in range(27, 35))
# Between the steps of an evaluation, or of a decision.
XV, XT, XW, YV, YT, YW, FV, FT, FW, H, HX, HY, HT = (n * STRIDE for n in range(35, 48))
LOW, HIGH, RP, RE, RC = (n * STRIDE for n in range(48, 53))
ROWS = 53


@lane
def at(row: int, k: int) -> int:
    """Return the place of lane k in a row, as a number without a sign.

    A number with one may be negative, and each use of it as an index would be asked about that.
    """
    return np.uint64(row) + np.uint64(k)  # type: ignore[return-value]


@lane
def away_from_zero(d: float) -> float:
    """Return d, or something tiny: a slab that a ray runs along is left far away, or never.

    The product of three is no less than the smallest number there is.
    """
    return d if abs(d) > 1e-90 else 1e-90


@lane
def at_circle(S: Floats, m: int, F: Fan, X: Fan, Y: Fan, point: bool) -> None:
    """Do what :func:`evaluate_circle` does for one lane."""
    i, j, w, t = S[AT_I + m], S[AT_J + m], S[AT_W + m], S[AT_T + m]
    r = own(F, i, j)
    f = mixed(point, F[0], r, w)
    t = nearer_tau(f, nearer_tau(f, t))
    fv, ft = value_and_slope(f, t)
    over = 1.0 / ft
    rest, turn = fv * over, rate(point, F[0], r, t) * over
    xv, xt, xw, _ = jet(point, X[0], own(X, i, j), w, t)
    yv, yt, yw, _ = jet(point, Y[0], own(Y, i, j), w, t)
    gt = 2.0 * (xv * xt + yv * yt)
    S[G + m] = xv * xv + yv * yv - 1.0 - gt * rest
    S[SLOPE + m] = 2.0 * (xv * xw + yv * yw) - gt * turn
    S[TAU + m] = t - rest


@lane_loop
def evaluate_circle(S: Floats, n: int, fans: Floats) -> None:
    """Write G, its slope and tau at ``AT_W`` of n lanes, for a circle."""
    F, X, Y = fan(fans, 0), fan(fans, 1), fan(fans, 2)
    if from_one_point(fans):
        for m in range(n):
            at_circle(S, m, F, X, Y, True)
    else:
        for m in range(n):
            at_circle(S, m, F, X, Y, False)


@lane
def at_contour(S: Floats, m: int, F: Fan, X: Fan, Y: Fan, point: bool) -> None:
    """Do what :func:`evaluate_jets` does for one lane."""
    i, j, w, t = S[AT_I + m], S[AT_J + m], S[AT_W + m], S[AT_T + m]
    r = own(F, i, j)
    f = mixed(point, F[0], r, w)
    t = nearer_tau(f, nearer_tau(f, t))
    fv, ft = value_and_slope(f, t)
    S[TAU + m], S[FV + m], S[FT + m] = t, fv, ft
    S[FW + m] = rate(point, F[0], r, t)
    v, vt, vw, _ = jet(point, X[0], own(X, i, j), w, t)
    S[XV + m], S[XT + m], S[XW + m] = v, vt, vw
    v, vt, vw, _ = jet(point, Y[0], own(Y, i, j), w, t)
    S[YV + m], S[YT + m], S[YW + m] = v, vt, vw


@lane_loop
def evaluate_jets(S: Floats, n: int, fans: Floats) -> None:
    """Write F and phi with their slopes along tau and w; ``TAU`` is where they are taken."""
    F, X, Y = fan(fans, 0), fan(fans, 1), fan(fans, 2)
    if from_one_point(fans):
        for m in range(n):
            at_contour(S, m, F, X, Y, True)
    else:
        for m in range(n):
            at_contour(S, m, F, X, Y, False)


@lane
def turned_chart(x: float, y: float) -> tuple[bool, float, float, float]:
    """Return whether x is the major coordinate, its sign and size, and the minor one."""
    level = abs(x) >= abs(y)
    sign = (1.0 if x >= 0.0 else -1.0) if level else (1.0 if y >= 0.0 else -1.0)
    return level, sign, (abs(x) if level else abs(y)), (sign * y if level else -sign * x)


@lane_loop
def find_cells(
    S: Floats,
    n: int,
    buckets: Ints,
    first: int,
    count: int,
    edges: Floats,
    table: int,
    last: int,
    steps: int,
) -> None:
    """Write the cell of the contour's table that each phi lies in, into ``H``.

    ``HT`` is the pseudo-angle there and ``HX`` the coordinate of its chart. As many ``steps`` are
    taken from where a bucket begins as there are edges in one at the most.
    """
    scale, start, after = 0.125 * count, np.uint64(first), np.uint64(table + 1)
    for m in range(n):
        level, sign, major, minor = turned_chart(S[XV + m], S[YV + m])
        chart = (0.0 if level else 1.0) + (0.0 if sign > 0.0 else 2.0)
        t = minor / major if major > 0.0 else 0.0
        T = 2.0 * chart + t + 1.0
        bucket = min(max(int(T * scale), 0), count - 1)
        S[H + m], S[HT + m], S[HX + m] = buckets[np.uint64(bucket) + start], T, t
    for _ in range(steps):
        for m in range(n):
            cell = S[H + m]
            beyond = (edges[np.uint64(cell) + after] <= S[HT + m]) & (cell < last)
            S[H + m] = cell + 1.0 if beyond else cell


@lane_loop
def fixed_cells(S: Floats, n: int, edges: Floats, table: int, cells: Floats) -> None:
    """Write h and its gradient from the cells of a contour that stays as it is."""
    before, after = np.uint64(table), np.uint64(table + 1)
    for m in range(n):
        level, sign, major, _ = turned_chart(S[XV + m], S[YV + m])
        c, T, t = np.uint64(S[H + m]), S[HT + m], S[HX + m]
        low, high = edges[c + before], edges[c + after]
        over = 2.0 / (high - low)
        z = (T - 0.5 * (low + high)) * over
        g = cells[c, 5]
        slope = g
        g = g * z + cells[c, 4]
        slope = slope * z + g
        g = g * z + cells[c, 3]
        slope = slope * z + g
        g = g * z + cells[c, 2]
        slope = slope * z + g
        g = g * z + cells[c, 1]
        slope = (slope * z + g) * over
        g = g * z + cells[c, 0]
        a, b = major * (2.0 * g - t * slope), major * slope
        S[H + m] = major * major * g - 1.0
        S[HX + m] = sign * a if level else -sign * b
        S[HY + m] = sign * b if level else sign * a
        S[HT + m] = 0.0


@lane_loop
def changing_cells(
    S: Floats, n: int, edges: Floats, table: int, tensors: Floats, skip: int
) -> None:
    """Write h, its gradient and its slope along tau from the cells of a contour that changes."""
    before, after, fixed = np.uint64(table), np.uint64(table + 1), np.uint64(skip)
    for m in range(n):
        level, sign, major, _ = turned_chart(S[XV + m], S[YV + m])
        c, T, t, tau = np.uint64(S[H + m]), S[HT + m], S[HX + m], S[TAU + m]
        low, high = edges[c + before], edges[c + after]
        over = 2.0 / (high - low)
        z = (T - 0.5 * (low + high)) * over
        row = c - fixed
        g = slope = rate = 0.0
        for i in range(5, -1, -1):
            value, first = tensors[row, i, 6], 0.0
            for j in range(5, -1, -1):
                first = first * tau + value
                value = value * tau + tensors[row, i, j]
            slope = slope * z + g
            g = g * z + value
            rate = rate * z + first
        slope *= over
        a, b = major * (2.0 * g - t * slope), major * slope
        S[H + m] = major * major * g - 1.0
        S[HX + m] = sign * a if level else -sign * b
        S[HY + m] = sign * b if level else sign * a
        S[HT + m] = major * major * rate


@lane_loop
def look_up(S: Floats, n: int, table: int, tables: Tables) -> None:
    """Write h and its gradient from a contour's table."""
    first = tables.first_bucket[table]
    count = tables.first_bucket[table + 1] - first
    last = tables.first_cell[table + 1] - 1
    steps = tables.steps[table]
    find_cells(S, n, tables.buckets, first, count, tables.edges, table, last, steps)
    fixed = len(tables.cells)
    if tables.first_cell[table] < fixed:
        fixed_cells(S, n, tables.edges, table, tables.cells)
    else:
        changing_cells(S, n, tables.edges, table, tables.tensors, fixed)


@lane_loop
def join_jets(S: Floats, n: int) -> None:
    """Write G and its slope along the ray from what :func:`look_up` and the jets left."""
    for m in range(n):
        over = 1.0 / S[FT + m]
        rest, turn = S[FV + m] * over, S[FW + m] * over
        hx, hy = S[HX + m], S[HY + m]
        gt = hx * S[XT + m] + hy * S[YT + m] + S[HT + m]
        S[G + m] = S[H + m] - gt * rest
        S[SLOPE + m] = hx * S[XW + m] + hy * S[YW + m] - gt * turn
        S[TAU + m] = S[TAU + m] - rest


@lane_loop
def pad(S: Floats, n: int) -> int:
    """Repeat the last point to be evaluated up to a whole number of wide registers."""
    full = (n + 3) & -4
    for m in range(n, full):
        S[AT_I + m], S[AT_J + m] = S[AT_I + n - 1], S[AT_J + n - 1]
        S[AT_W + m], S[AT_T + m] = S[AT_W + n - 1], S[AT_T + n - 1]
    return full


@lane_loop
def evaluate_lanes(S: Floats, n: int, fans: Floats, table: int, tables: Tables) -> None:
    """Write G, its slope along w and tau at ``AT_W`` of n lanes; ``AT_T`` guesses tau.

    ``fans`` are the segment's polynomials along the rays (:func:`phantom.kernels.jets.spread`).
    """
    if n == 0:
        return
    full = pad(S, n)
    if table < 0:
        evaluate_circle(S, full, fans)
        return
    evaluate_jets(S, full, fans)
    look_up(S, full, table, tables)
    join_jets(S, full)


@lane_loop
def collect(
    S: Floats, knots: Floats, knot: int, slabs: Floats, i0: int, i1: int, j0: int, j1: int
) -> int:
    """Fill the lanes of a segment from the pixels of a rectangle; return how many there are.

    An interval is what of [0, 1] lies between the section planes ``knot`` and ``knot + 1``,
    F_k >= 0 > F_k+1, and within the box. ``knots`` (n, 6) and ``slabs`` (3, 7) hold a plane's value
    and its slope along the ray, each with its steps to the next row and column; a slab's half
    width follows.
    """
    count = 0
    left = float(j0)
    for row in range(i0, i1):
        i = float(row)
        fa, faj = knots[knot, 0] + i * knots[knot, 1], knots[knot, 2]
        da, daj = knots[knot, 3] + i * knots[knot, 4], knots[knot, 5]
        fb, fbj = knots[knot + 1, 0] + i * knots[knot + 1, 1], knots[knot + 1, 2]
        db, dbj = knots[knot + 1, 3] + i * knots[knot + 1, 4], knots[knot + 1, 5]
        p0, p0j, h0 = slabs[0, 0] + i * slabs[0, 1], slabs[0, 2], slabs[0, 6]
        d0, d0j = slabs[0, 3] + i * slabs[0, 4], slabs[0, 5]
        p1, p1j, h1 = slabs[1, 0] + i * slabs[1, 1], slabs[1, 2], slabs[1, 6]
        d1, d1j = slabs[1, 3] + i * slabs[1, 4], slabs[1, 5]
        p2, p2j, h2 = slabs[2, 0] + i * slabs[2, 1], slabs[2, 2], slabs[2, 6]
        d2, d2j = slabs[2, 3] + i * slabs[2, 4], slabs[2, 5]
        # Counted from 0: what may be negative would be wrapped around, one lane at a time.
        for m in range(j1 - j0):
            j = left + m
            a, b = 0.0, 1.0
            f, d = fa + j * faj, da + j * daj
            t = -f / d
            a = t if (d > 0.0) & (t > a) else a
            b = t if (d < 0.0) & (t < b) else b
            b = -1.0 if (d == 0.0) & (f < 0.0) else b
            f, d = fb + j * fbj, db + j * dbj
            t = -f / d
            b = t if (d > 0.0) & (t < b) else b
            a = t if (d < 0.0) & (t > a) else a
            b = -1.0 if (d == 0.0) & (f >= 0.0) else b
            # |p + w d| <= h: the middle and half the length of the part inside.
            s0, s1 = away_from_zero(d0 + j * d0j), away_from_zero(d1 + j * d1j)
            s2 = away_from_zero(d2 + j * d2j)
            s01 = s0 * s1
            over = 1.0 / (s01 * s2)
            o2, over = s01 * over, s2 * over
            o0, o1 = s1 * over, s0 * over
            middle, half = -(p0 + j * p0j) * o0, abs(h0 * o0)
            a, b = max(a, middle - half), min(b, middle + half)
            middle, half = -(p1 + j * p1j) * o1, abs(h1 * o1)
            a, b = max(a, middle - half), min(b, middle + half)
            middle, half = -(p2 + j * p2j) * o2, abs(h2 * o2)
            a, b = max(a, middle - half), min(b, middle + half)
            S[LOW + m], S[HIGH + m] = a, b
        for m in range(j1 - j0):
            a, b = S[LOW + m], S[HIGH + m]
            S[at(I, count)], S[at(J, count)] = i, left + m
            S[at(A, count)], S[at(B, count)] = a, b
            count += 1 if a < b else 0
    return count
