"""Lanes against one segment: every root of G found, none lost.

The tests are those of :mod:`phantom.kernels.cylinder`. Bounds over the whole segment are tried on
all lanes at once; only where these leave a doubt are the cells that a ray runs through looked at.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import CELLS, Scene
from phantom.kernels.compiling import kernel, lane, lane_loop
from phantom.kernels.cylinder import crosses_once, curvature, stays_positive
from phantom.kernels.lanes import (
    AT_I,
    AT_J,
    AT_T,
    AT_W,
    GA,
    GB,
    HELD,
    LOW,
    RA,
    RB,
    RC,
    RE,
    RGA,
    RI,
    RJ,
    RP,
    RS,
    RT,
    RW,
    SA,
    SB,
    SLOPE,
    TA,
    TAU,
    TB,
    YA,
    YB,
    YGA,
    YGB,
    YI,
    YJ,
    YSA,
    YSB,
    YTA,
    YTB,
    A,
    B,
    G,
    I,
    J,
    evaluate_lanes,
)
from phantom.kernels.scratch import Scratch

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

DONE, ROOT, DOUBT, SPLIT = 0.0, 1.0, 2.0, 3.0
"""What is known of an interval: no root, one root, perhaps, or that a split will tell."""

ERROR_MM = 1e-11
"""What a root may be wrong by, as the last step of Newton's and the bend of G there have it."""

_HALVINGS = 200

_EDGE = 1e-9
"""Cells are taken this much wider, in cells: a point on an edge counts for both sides."""


@lane
def way_up(g: float, slope: float, low: float) -> float:
    """Return what :func:`phantom.kernels.cylinder.reach` does, without a branch."""
    square = slope * slope - 2.0 * low * g
    root = math.sqrt(max(square, 0.0))
    rising = slope >= 0.0
    way = ((slope + root) if rising else 2.0 * g) / (-low if rising else (root - slope))
    endless = (rising & (low >= 0.0)) | (square < 0.0)
    return math.inf if endless else way


@lane
def verdict(
    g0: float, s0: float, g1: float, s1: float, span: float, low: float, high: float
) -> float:
    """Judge an interval of a contour without corners."""
    negative = g0 < 0.0
    opposite = negative != (g1 < 0.0)
    sign = -1.0 if negative else 1.0
    lo, hi = (-high if negative else low), (-low if negative else high)
    left, right = way_up(sign * g0, sign * s0, lo), way_up(sign * g1, -sign * s1, lo)
    clear = (left + right > span) if lo <= 0.0 else ((left > span) | (right > span))
    bow = 0.5 * hi * span * span
    t = 0.5 * (1.0 - sign * (g1 - g0) / bow)
    chord = sign * ((1.0 - t) * g0 + t * g1) - bow * t * (1.0 - t)
    clear = clear | (bow <= 0.0) | (t <= 0.0) | (t >= 1.0) | (chord > 0.0)
    # The slope lies between two lines from each end; where they meet is its extreme.
    spread = 1.0 / (high - low)
    b = s1 - high * span
    s = min(max((s0 - b) * spread, 0.0), span)
    rising = max(s0 + low * s, b + high * s)
    b = s1 - low * span
    s = min(max((b - s0) * spread, 0.0), span)
    falling = min(s0 + high * s, b + low * s)
    once = (low >= 0.0) | (high <= 0.0) | (rising > 0.0) | (falling < 0.0)
    # Where a parabola says that it is met twice, no closer look will say that it is not.
    dips = (sign * s0 < 0.0) & (sign * s1 > 0.0)
    dips = dips & (2.0 * sign * g0 * (s1 - s0) * sign < s0 * s0 * span)
    same = DONE if clear else (SPLIT if dips else DOUBT)
    other = ROOT if once else DOUBT
    return other if opposite else same


@lane_loop
def judge(S: Floats, n: int, slabs: Floats, hulls: Floats, k: int) -> None:
    """Write the verdict on n intervals, by bounds over the whole segment, into ``LOW``."""
    l0, l1, l2 = hulls[k, 0, 0], hulls[k, 1, 0], hulls[k, 2, 0]
    l3, l4, l5 = hulls[k, 3, 0], hulls[k, 4, 0], hulls[k, 5, 0]
    h0, h1, h2 = hulls[k, 0, 1], hulls[k, 1, 1], hulls[k, 2, 1]
    h3, h4, h5 = hulls[k, 3, 1], hulls[k, 4, 1], hulls[k, 5, 1]
    e0, e0i, e0j = slabs[0, 3], slabs[0, 4], slabs[0, 5]
    e1, e1i, e1j = slabs[1, 3], slabs[1, 4], slabs[1, 5]
    e2, e2i, e2j = slabs[2, 3], slabs[2, 4], slabs[2, 5]
    for m in range(n):
        i, j = S[I + m], S[J + m]
        a, b, c = e0 + i * e0i + j * e0j, e1 + i * e1i + j * e1j, e2 + i * e2i + j * e2j
        ab, ac, bc = 2.0 * a * b, 2.0 * a * c, 2.0 * b * c
        a, b, c = a * a, b * b, c * c
        low = a * l0 + b * l1 + c * l2
        low += min(ab * l3, ab * h3) + min(ac * l4, ac * h4) + min(bc * l5, bc * h5)
        high = a * h0 + b * h1 + c * h2
        high += max(ab * l3, ab * h3) + max(ac * l4, ac * h4) + max(bc * l5, bc * h5)
        S[LOW + m] = verdict(
            S[GA + m], S[SA + m], S[GB + m], S[SB + m], S[B + m] - S[A + m], low, high
        )


@kernel
def bound_cells(
    hessians: Floats, k: int, slabs: Floats, i0: int, i1: int, j0: int, j1: int, cells: Floats
) -> None:
    """Bound G'' along every ray of a rectangle of pixels, cell by cell, into (CELLS, CELLS, 2).

    The direction is linear in row and column, so each of its components lies between those of the
    corners, and each product of two between the products of their ends.
    """
    least, most = np.empty(3), np.empty(3)
    for axis in range(3):
        d = slabs[axis, 3]
        i, j = slabs[axis, 4], slabs[axis, 5]
        least[axis] = d + min(i * i0, i * i1) + min(j * j0, j * j1)
        most[axis] = d + max(i * i0, i * i1) + max(j * j0, j * j1)
    for row in range(CELLS):
        for column in range(CELLS):
            cells[row, column, 0] = cells[row, column, 1] = 0.0
    for pair in range(6):
        a = pair if pair < 3 else (0 if pair < 5 else 1)
        b = pair if pair < 3 else (1 if pair == 3 else 2)
        p, q = least[a] * least[b], least[a] * most[b]
        r, s = most[a] * least[b], most[a] * most[b]
        low, high = min(min(p, q), min(r, s)), max(max(p, q), max(r, s))
        if a == b:
            low = max(low, 0.0)
        else:
            low, high = 2.0 * low, 2.0 * high
        for row in range(CELLS):
            for column in range(CELLS):
                x, y = hessians[k, row, column, pair, 0], hessians[k, row, column, pair, 1]
                cells[row, column, 0] += min(min(low * x, high * x), min(low * y, high * y))
                cells[row, column, 1] += max(max(low * x, high * x), max(low * y, high * y))


@kernel
def over_cells(
    cells: Floats, p1: float, d1: float, p2: float, d2: float, start: float, end: float
) -> tuple[float, float]:
    """Return the bounds of G'' over the cells that [start, end] of a ray, given in cells, meets."""
    low, high = math.inf, -math.inf
    a1, b1 = p1 + start * d1, p1 + end * d1
    first = min(max(int(min(a1, b1) - _EDGE), 0), CELLS - 1)
    last = min(max(int(max(a1, b1) + _EDGE), 0), CELLS - 1)
    for i in range(first, last + 1):
        a, b = start, end
        if first < last:
            u, v = (i - _EDGE - p1) / d1, (i + 1 + _EDGE - p1) / d1
            if u > v:
                u, v = v, u
            if i > 0 and i < CELLS - 1:
                a, b = max(a, u), min(b, v)
            elif (i == 0) == (d1 > 0):
                b = min(b, v)
            else:
                a = max(a, u)
        a2, b2 = p2 + a * d2, p2 + b * d2
        left = min(max(int(min(a2, b2) - _EDGE), 0), CELLS - 1)
        right = min(max(int(max(a2, b2) + _EDGE), 0), CELLS - 1)
        for j in range(left, right + 1):
            low, high = min(low, cells[i, j, 0]), max(high, cells[i, j, 1])
    return low, high


@kernel
def look_closer(
    g0: float,
    s0: float,
    g1: float,
    s1: float,
    span: float,
    low: float,
    high: float,
    up: float,
    down: float,
) -> float:
    """Return the verdict on one interval by the bounds of the cells that its ray runs through."""
    if (g0 < 0.0) != (g1 < 0.0):
        return ROOT if crosses_once(g0, s0, s1, span, low, high, up, down) else SPLIT
    if g0 < 0.0:
        clear = stays_positive(-g0, -s0, -g1, -s1, span, -high, -low, down, up)
    else:
        clear = stays_positive(g0, s0, g1, s1, span, low, high, up, down)
    return DONE if clear else SPLIT


@kernel
def look_at_all(
    S: Floats,
    n: int,
    slabs: Floats,
    cornered: bool,
    hessians: Floats,
    kinks: Floats,
    k: int,
    beam: Floats,
    cells: Floats,
    shortest: float,
) -> None:
    """Settle the doubts among n verdicts in ``LOW``; those on a contour with corners are none yet.

    One loop and few arrays: handing a scene to a function costs more than looking at an interval.
    """
    for m in range(n):
        if not cornered and S[LOW + m] != DOUBT:
            continue
        g0, s0, g1, s1 = S[GA + m], S[SA + m], S[GB + m], S[SB + m]
        a, b = S[A + m], S[B + m]
        if b - a < shortest:
            S[LOW + m] = ROOT if (g0 < 0.0) != (g1 < 0.0) else DONE
            continue
        i, j = S[I + m], S[J + m]
        e0 = slabs[0, 3] + i * slabs[0, 4] + j * slabs[0, 5]
        e1 = slabs[1, 3] + i * slabs[1, 4] + j * slabs[1, 5]
        c0, c1 = 0.5 * CELLS / slabs[0, 6], 0.5 * CELLS / slabs[1, 6]
        p0 = (slabs[0, 0] + i * slabs[0, 1] + j * slabs[0, 2] + slabs[0, 6]) * c0
        p1 = (slabs[1, 0] + i * slabs[1, 1] + j * slabs[1, 2] + slabs[1, 6]) * c1
        if not cornered:
            low, high = over_cells(cells, p0, e0 * c0, p1, e1 * c1, a, b)
            S[LOW + m] = look_closer(g0, s0, g1, s1, b - a, low, high, 0.0, 0.0)
            continue
        # Jumps of the slope are bounded by mm along the ray: all is brought to them.
        e2 = slabs[2, 3] + i * slabs[2, 4] + j * slabs[2, 5]
        length = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        e0, e1, e2 = e0 / length, e1 / length, e2 / length
        a, b, s0, s1 = a * length, b * length, s0 / length, s1 / length
        beam[0], beam[1], beam[2], beam[3] = p0, e0 * c0, p1, e1 * c1
        beam[4], beam[5], beam[6] = e0 * e0, e1 * e1, e2 * e2
        beam[7], beam[8], beam[9] = 2.0 * e0 * e1, 2.0 * e0 * e2, 2.0 * e1 * e2
        low, high, up, down = curvature(hessians, kinks, k, beam, a, b)
        S[LOW + m] = look_closer(g0, s0, g1, s1, b - a, low, high, up, down)


@lane_loop
def first_guess(S: Floats, n: int) -> None:
    """Guess each root from the cubic with the values and slopes of both ends."""
    for m in range(n):
        a, b, ga, gb = S[RA + m], S[RB + m], S[RGA + m], S[RW + m]
        span = b - a
        sa, sb = S[RS + m] * span, S[RP + m] * span
        # First the parabola that leaves out the slope at b, then the cubic, by Newton's steps.
        bend = gb - ga - sa
        root = math.sqrt(max(sa * sa - 4.0 * bend * ga, 0.0))
        t = 2.0 * ga / ((root if ga > 0.0 else -root) - sa)
        t = t if (t > 0.0) & (t < 1.0) else 0.5
        c2, c3 = 3.0 * (gb - ga) - 2.0 * sa - sb, 2.0 * (ga - gb) + sa + sb
        for _ in range(3):
            g = ((c3 * t + c2) * t + sa) * t + ga
            t -= g / ((3.0 * c3 * t + 2.0 * c2) * t + sa)
            t = min(max(t, 1e-3), 1.0 - 1e-3) if t == t else 0.5
        S[RW + m] = a + t * span
        S[RC + m] = (c2 + 3.0 * c3 * t) / (span * span)


@lane_loop
def aim(S: Floats, n: int) -> None:
    """Ask for G at the present roots."""
    for m in range(n):
        S[AT_I + m], S[AT_J + m], S[AT_W + m], S[AT_T + m] = (
            S[RI + m],
            S[RJ + m],
            S[RW + m],
            S[RT + m],
        )


@lane_loop
def first_step(S: Floats, n: int) -> None:
    """Step from the guess to the root by the value and slope there and the bend of the cubic."""
    for m in range(n):
        a, b, w, g, slope = S[RA + m], S[RB + m], S[RW + m], S[G + m], S[SLOPE + m]
        falling = S[RGA + m] > 0.0
        before = (g > 0.0) == falling
        straight = -g / slope
        following = w + straight * (1.0 - straight * S[RC + m] / slope)
        a, b = (w if before else a), (b if before else w)
        within = (following >= a) & (following <= b) & ((slope < 0.0) == falling)
        S[RA + m], S[RB + m] = a, b
        following = following if within else 0.5 * (a + b)
        S[RW + m], S[RS + m], S[RP + m] = following, abs(following - w), slope
        S[RT + m] = S[TAU + m]


@lane_loop
def newton(S: Floats, n: int) -> None:
    """Take a step of Newton's within the bracket.

    ``RS`` becomes how long it was and ``RP`` the slope it was taken with; ``RE`` what the step and
    the bend of G, as the last two slopes have it, leave of an error.
    """
    for m in range(n):
        w, g = S[RW + m], S[G + m]
        falling = S[RGA + m] > 0.0
        before = (g > 0.0) == falling
        a, b = (w if before else S[RA + m]), (S[RB + m] if before else w)
        following = w - g / S[SLOPE + m]
        within = (following >= a) & (following <= b)
        following = following if within else 0.5 * (a + b)
        following = w if g == 0.0 else following
        S[RA + m], S[RB + m], S[RW + m] = a, b, following
        step = abs(following - w)
        bend = abs((S[SLOPE + m] - S[RP + m]) / (S[SLOPE + m] * S[RS + m]))
        leaves = (0.5 * bend * step * step) if within else 1.0
        S[RE + m] = 0.0 if step == 0.0 else leaves
        S[RS + m], S[RP + m] = step, S[SLOPE + m]
        S[RT + m] = S[TAU + m]


@kernel
def polish_lanes(
    n: int,
    ox: float,
    oy: float,
    oz: float,
    scene: Scene,
    k: int,
    enough: float,
    held: Scratch,
    filled: int,
    columns: int,
) -> int:
    """Find the one root in each of n intervals and record it; return how many records there are."""
    S, rays, pixels, where, signs = held.lanes, held.rays, held.pixels, held.where, held.signs
    table = scene.segment_table[k]
    first_guess(S, n)
    for step in range(_HALVINGS):
        if n == 0:
            break
        aim(S, n)
        evaluate_lanes(S, n, rays, ox, oy, oz, scene.polynomials, k, table, scene.tables)
        if step == 0:
            first_step(S, n)
            continue
        newton(S, n)
        left = 0
        for m in range(n):
            if S[RE + m] < enough or S[RB + m] - S[RA + m] < 1e-15 or step == _HALVINGS - 1:
                pixels[filled] = int(S[RI + m]) * columns + int(S[RJ + m])
                where[filled] = S[RW + m]
                signs[filled] = 1.0 if S[RGA + m] > 0.0 else -1.0
                filled += 1
            else:
                S[RI + left], S[RJ + left], S[RT + left] = S[RI + m], S[RJ + m], S[RT + m]
                S[RA + left], S[RB + left], S[RW + left] = S[RA + m], S[RB + m], S[RW + m]
                S[RGA + left], S[RS + left], S[RP + left] = S[RGA + m], S[RS + m], S[RP + m]
                left += 1
        n = left
    return filled


@lane_loop
def ask(S: Floats, n: int, at: int, known: bool) -> None:
    """Ask for G at one end of every interval; tau is about known at the other end or not."""
    for m in range(n):
        S[AT_I + m], S[AT_J + m], S[AT_W + m] = S[I + m], S[J + m], S[at + m]
        S[AT_T + m] = S[TA + m] if known else 0.0


@lane_loop
def answer(S: Floats, n: int, g: int, slope: int, tau: int) -> None:
    """Keep what G was."""
    for m in range(n):
        S[g + m], S[slope + m], S[tau + m] = S[G + m], S[SLOPE + m], S[TAU + m]


@lane_loop
def ask_between(S: Floats, n: int) -> None:
    """Ask for G where the slope's secant vanishes: near the extreme that is in doubt."""
    for m in range(n):
        a, b, s0, s1 = S[YA + m], S[YB + m], S[YSA + m], S[YSB + m]
        opposite = (S[YGA + m] < 0.0) != (S[YGB + m] < 0.0)
        part = min(max(s0 / (s0 - s1), 0.1), 0.9)
        part = 0.5 if opposite | (s0 == s1) else part
        S[AT_I + m], S[AT_J + m] = S[YI + m], S[YJ + m]
        S[AT_W + m] = a + part * (b - a)
        S[AT_T + m] = S[YTA + m] + part * (S[YTB + m] - S[YTA + m])


@lane_loop
def halve(S: Floats, n: int) -> None:
    """Make two intervals of each that was split."""
    for m in range(n):
        S[I + m], S[J + m] = S[YI + m], S[YJ + m]
        S[A + m], S[GA + m], S[SA + m], S[TA + m] = S[YA + m], S[YGA + m], S[YSA + m], S[YTA + m]
        S[B + m], S[GB + m], S[SB + m], S[TB + m] = S[AT_W + m], S[G + m], S[SLOPE + m], S[TAU + m]
    for m in range(n):
        S[I + n + m], S[J + n + m] = S[YI + m], S[YJ + m]
        S[A + n + m], S[GA + n + m] = S[AT_W + m], S[G + m]
        S[SA + n + m], S[TA + n + m] = S[SLOPE + m], S[TAU + m]
        S[B + n + m], S[GB + n + m] = S[YB + m], S[YGB + m]
        S[SB + n + m], S[TB + n + m] = S[YSB + m], S[YTB + m]


@kernel
def isolate(
    n: int,
    i0: int,
    i1: int,
    j0: int,
    j1: int,
    ox: float,
    oy: float,
    oz: float,
    scene: Scene,
    k: int,
    shortest: float,
    enough: float,
    held: Scratch,
    filled: int,
    columns: int,
) -> int:
    """Record where n lanes enter and leave a segment within their intervals.

    Returns how many records there are now; negative where there was no room for them.
    """
    S, rays, slabs, pixels, where, signs = (
        held.lanes,
        held.rays,
        held.slabs,
        held.pixels,
        held.where,
        held.signs,
    )
    table = scene.segment_table[k]
    ask(S, n, A, False)
    evaluate_lanes(S, n, rays, ox, oy, oz, scene.polynomials, k, table, scene.tables)
    answer(S, n, GA, SA, TA)
    ask(S, n, B, True)
    evaluate_lanes(S, n, rays, ox, oy, oz, scene.polynomials, k, table, scene.tables)
    answer(S, n, GB, SB, TB)
    if filled + 2 * n > len(pixels):
        return -1
    for m in range(n):
        if S[GA + m] < 0.0:
            pixels[filled] = int(S[I + m]) * columns + int(S[J + m])
            where[filled], signs[filled] = S[A + m], 1.0
            filled += 1
        if S[GB + m] < 0.0:
            pixels[filled] = int(S[I + m]) * columns + int(S[J + m])
            where[filled], signs[filled] = S[B + m], -1.0
            filled += 1
    cornered = scene.cornered[k] != 0
    cells = held.cells
    if not cornered:
        bound_cells(scene.hessians, k, slabs, i0, i1, j0, j1, cells)
    roots = 0
    while n > 0:
        if roots + n > HELD:
            if filled + roots > len(pixels):
                return -1
            filled = polish_lanes(roots, ox, oy, oz, scene, k, enough, held, filled, columns)
            roots = 0
        if not cornered:
            judge(S, n, slabs, scene.hulls, k)
        look_at_all(
            S,
            n,
            slabs,
            cornered,
            scene.hessians,
            scene.kinks,
            k,
            held.beam,
            cells,
            shortest,
        )
        halves = 0
        for m in range(n):
            code = S[LOW + m]
            if code == ROOT:
                S[RI + roots], S[RJ + roots], S[RT + roots] = S[I + m], S[J + m], S[TA + m]
                S[RA + roots], S[RGA + roots], S[RS + roots] = S[A + m], S[GA + m], S[SA + m]
                S[RB + roots], S[RW + roots], S[RP + roots] = S[B + m], S[GB + m], S[SB + m]
                roots += 1
            elif code == SPLIT:
                S[YI + halves], S[YJ + halves] = S[I + m], S[J + m]
                S[YA + halves], S[YGA + halves] = S[A + m], S[GA + m]
                S[YSA + halves], S[YTA + halves] = S[SA + m], S[TA + m]
                S[YB + halves], S[YGB + halves] = S[B + m], S[GB + m]
                S[YSB + halves], S[YTB + halves] = S[SB + m], S[TB + m]
                halves += 1
        if 2 * halves > HELD:
            return -1
        ask_between(S, halves)
        evaluate_lanes(S, halves, rays, ox, oy, oz, scene.polynomials, k, table, scene.tables)
        halve(S, halves)
        n = 2 * halves
    if filled + roots > len(pixels):
        return -1
    return polish_lanes(roots, ox, oy, oz, scene, k, enough, held, filled, columns)
