"""What is known of an interval of a lane: no root of G, one, or that it must be split.

The tests are those of :mod:`phantom.kernels.cylinder`. Bounds over the whole segment are tried
first, and where these leave a doubt those of the rectangle of cells that holds the interval; both
on many lanes at once. Only contours with corners are looked at ray by ray.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import CELLS
from phantom.kernels.compiling import inner, lane, lane_loop
from phantom.kernels.cylinder import EDGE, crosses_once, curvature, stays_positive
from phantom.kernels.lanes import (
    GA,
    GB,
    LOW,
    SA,
    SB,
    A,
    B,
    I,
    J,
)

Floats = NDArray[np.float64]

DONE, ROOT, DOUBT, SPLIT = 0.0, 1.0, 2.0, 3.0
"""No root, one root, perhaps, or that a split will tell."""

SIZES = 4
"""Blocks are 1, 2, 4 or 8 cells long."""

BLOCKS = 2 * CELLS * CELLS
"""Numbers that the blocks of one size have."""


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


@lane_loop
def in_doubt(S: Floats, n: int) -> bool:
    """Tell whether any of n verdicts is a doubt."""
    doubts = 0
    for m in range(n):
        doubts += 1 if S[LOW + m] == DOUBT else 0
    return doubts > 0


@lane
def spread(slabs: Floats, axis: int, i0: int, i1: int, j0: int, j1: int) -> tuple[float, float]:
    """Return the ends of what a component of the rays' direction is over a rectangle of pixels."""
    d, i, j = slabs[axis, 3], slabs[axis, 4], slabs[axis, 5]
    least = d + min(i * i0, i * i1) + min(j * j0, j * j1)
    return least, d + max(i * i0, i * i1) + max(j * j0, j * j1)


@inner
def bound_cells(
    hessians: Floats, k: int, slabs: Floats, i0: int, i1: int, j0: int, j1: int, cells: Floats
) -> None:
    """Bound G'' along every ray of a rectangle of pixels, cell by cell, into (CELLS, CELLS, 2).

    The direction is linear in row and column, so each of its components lies between those of the
    corners, and each product of two between the products of their ends.
    """
    for row in range(CELLS):
        for column in range(CELLS):
            cells[row, column, 0] = cells[row, column, 1] = 0.0
    for pair in range(6):
        a = pair if pair < 3 else (0 if pair < 5 else 1)
        b = pair if pair < 3 else (1 if pair == 3 else 2)
        least, most = spread(slabs, a, i0, i1, j0, j1)
        first, last = spread(slabs, b, i0, i1, j0, j1)
        p, q, r, s = least * first, least * last, most * first, most * last
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


@lane_loop
def bound_blocks(cells: Floats, blocks: Floats) -> None:
    """Bound G'' over blocks of 1, 2, 4 and 8 cells a side, from every cell on, into ``blocks``.

    Any rectangle of cells is the union of four blocks, which may overlap. ``blocks`` is flat: sides
    along e1 and e2 as powers of two, first row, first column, low and high.
    """
    for row in range(CELLS):
        for column in range(CELLS):
            at = 2 * (row * CELLS + column)
            blocks[at], blocks[at + 1] = cells[row, column, 0], cells[row, column, 1]
    for size in range(1, SIZES):
        half = 1 << (size - 1)
        to, source = size * SIZES * BLOCKS, (size - 1) * SIZES * BLOCKS
        for row in range(CELLS + 1 - 2 * half):
            for column in range(CELLS):
                at = 2 * (row * CELLS + column)
                far = at + 2 * half * CELLS
                low, high = blocks[source + at], blocks[source + at + 1]
                blocks[to + at] = min(low, blocks[source + far])
                blocks[to + at + 1] = max(high, blocks[source + far + 1])
    for tall in range(SIZES):
        for size in range(1, SIZES):
            half = 1 << (size - 1)
            to = (tall * SIZES + size) * BLOCKS
            for row in range(CELLS + 1 - (1 << tall)):
                for column in range(CELLS + 1 - 2 * half):
                    at = to + 2 * (row * CELLS + column)
                    near = at - BLOCKS
                    far = near + 2 * half
                    blocks[at] = min(blocks[near], blocks[far])
                    blocks[at + 1] = max(blocks[near + 1], blocks[far + 1])


@lane
def reaching(p: float, d: float, start: float, end: float) -> tuple[int, int, int]:
    """Return the first cell that p + w d meets, and of the blocks that cover all: size, second."""
    a, b = p + start * d, p + end * d
    first = min(max(min(a, b) - EDGE, 0.0), CELLS - 1.0)
    last = min(max(max(a, b) + EDGE, 0.0), CELLS - 1.0)
    f, e = int(first), int(last)
    count = e - f + 1
    size = (1 if count >= 2 else 0) + (1 if count >= 4 else 0) + (1 if count >= 8 else 0)
    side = 8 if count >= 8 else (4 if count >= 4 else (2 if count >= 2 else 1))
    return f, size, e + 1 - side


@lane_loop
def judge_closer(S: Floats, n: int, slabs: Floats, blocks: Floats, shortest: float) -> None:
    """Write the verdict on n intervals, by the cells that hold each, into ``LOW``; no doubts."""
    c0, c1 = 0.5 * CELLS / slabs[0, 6], 0.5 * CELLS / slabs[1, 6]
    p0, p0i, p0j = (slabs[0, 0] + slabs[0, 6]) * c0, slabs[0, 1] * c0, slabs[0, 2] * c0
    p1, p1i, p1j = (slabs[1, 0] + slabs[1, 6]) * c1, slabs[1, 1] * c1, slabs[1, 2] * c1
    d0, d0i, d0j = slabs[0, 3] * c0, slabs[0, 4] * c0, slabs[0, 5] * c0
    d1, d1i, d1j = slabs[1, 3] * c1, slabs[1, 4] * c1, slabs[1, 5] * c1
    for m in range(n):
        i, j, a, b = S[I + m], S[J + m], S[A + m], S[B + m]
        row, tall, below = reaching(p0 + i * p0i + j * p0j, d0 + i * d0i + j * d0j, a, b)
        column, wide, beside = reaching(p1 + i * p1i + j * p1j, d1 + i * d1i + j * d1j, a, b)
        block = (tall * SIZES + wide) * BLOCKS
        k0 = np.uint64(block + 2 * (row * CELLS + column))
        k1 = np.uint64(block + 2 * (row * CELLS + beside))
        k2 = np.uint64(block + 2 * (below * CELLS + column))
        k3 = np.uint64(block + 2 * (below * CELLS + beside))
        one = np.uint64(1)
        low = min(min(blocks[k0], blocks[k1]), min(blocks[k2], blocks[k3]))
        high = max(max(blocks[k0 + one], blocks[k1 + one]), max(blocks[k2 + one], blocks[k3 + one]))
        g0, g1, span = S[GA + m], S[GB + m], b - a
        found = verdict(g0, S[SA + m], g1, S[SB + m], span, low, high)
        ended = ROOT if (g0 < 0.0) != (g1 < 0.0) else DONE
        S[LOW + m] = ended if span < shortest else (SPLIT if found == DOUBT else found)


@inner
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


@inner
def look_at_corners(
    S: Floats,
    n: int,
    slabs: Floats,
    hessians: Floats,
    kinks: Floats,
    k: int,
    beam: Floats,
    shortest: float,
) -> None:
    """Write the verdict on n intervals of a contour with corners into ``LOW``, one by one.

    One loop and few arrays: handing a scene to a function costs more than looking at an interval.
    """
    for m in range(n):
        g0, s0, g1, s1 = S[GA + m], S[SA + m], S[GB + m], S[SB + m]
        a, b = S[A + m], S[B + m]
        if b - a < shortest:
            S[LOW + m] = ROOT if (g0 < 0.0) != (g1 < 0.0) else DONE
            continue
        i, j = S[I + m], S[J + m]
        e0 = slabs[0, 3] + i * slabs[0, 4] + j * slabs[0, 5]
        e1 = slabs[1, 3] + i * slabs[1, 4] + j * slabs[1, 5]
        e2 = slabs[2, 3] + i * slabs[2, 4] + j * slabs[2, 5]
        c0, c1 = 0.5 * CELLS / slabs[0, 6], 0.5 * CELLS / slabs[1, 6]
        p0 = (slabs[0, 0] + i * slabs[0, 1] + j * slabs[0, 2] + slabs[0, 6]) * c0
        p1 = (slabs[1, 0] + i * slabs[1, 1] + j * slabs[1, 2] + slabs[1, 6]) * c1
        # Jumps of the slope are bounded by mm along the ray: all is brought to them.
        length = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        e0, e1, e2 = e0 / length, e1 / length, e2 / length
        a, b, s0, s1 = a * length, b * length, s0 / length, s1 / length
        beam[0], beam[1], beam[2], beam[3] = p0, e0 * c0, p1, e1 * c1
        beam[4], beam[5], beam[6] = e0 * e0, e1 * e1, e2 * e2
        beam[7], beam[8], beam[9] = 2.0 * e0 * e1, 2.0 * e0 * e2, 2.0 * e1 * e2
        low, high, up, down = curvature(hessians, kinks, k, beam, a, b)
        S[LOW + m] = look_closer(g0, s0, g1, s1, b - a, low, high, up, down)
