"""Lanes against one segment: every root of G found, none lost.

Intervals are judged (:mod:`phantom.kernels.verdicts`), those in doubt are split, all together, and
those with one root each are polished (:mod:`phantom.kernels.roots`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, lane_loop, whole
from phantom.kernels.glances import glance
from phantom.kernels.jets import spread
from phantom.kernels.lanes import (
    AT_I,
    AT_J,
    AT_T,
    AT_W,
    CHUNK,
    GA,
    GB,
    HELD,
    LANES,
    LOW,
    RA,
    RB,
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
    YB,
    YGB,
    YSB,
    YTB,
    A,
    B,
    G,
    I,
    J,
    at,
    evaluate_lanes,
)
from phantom.kernels.roots import polish_lanes
from phantom.kernels.scratch import Scratch
from phantom.kernels.verdicts import (
    ROOT,
    SPLIT,
    bound_blocks,
    bound_cells,
    in_doubt,
    judge,
    judge_closer,
    look_at_corners,
)

Floats = NDArray[np.float64]


@lane_loop
def ask(S: Floats, n: int, end: int, known: bool) -> None:
    """Ask for G at one end of every interval; tau is about known at the other end or not."""
    for m in range(n):
        S[AT_I + m], S[AT_J + m], S[AT_W + m] = S[I + m], S[J + m], S[end + m]
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
        a, b, s0, s1 = S[A + m], S[YB + m], S[SA + m], S[YSB + m]
        opposite = (S[GA + m] < 0.0) != (S[YGB + m] < 0.0)
        part = min(max(s0 / (s0 - s1), 0.1), 0.9)
        part = 0.5 if opposite | (s0 == s1) else part
        S[AT_I + m], S[AT_J + m] = S[I + m], S[J + m]
        S[AT_W + m] = a + part * (b - a)
        S[AT_T + m] = S[TA + m] + part * (S[YTB + m] - S[TA + m])


@lane_loop
def copy(S: Floats, source: int, to: int, n: int) -> None:
    """Copy n numbers; a loop for each row is packed, one for all of them is not."""
    for m in range(n):
        S[at(to, m)] = S[at(source, m)]


@lane_loop
def halve(S: Floats, n: int) -> None:
    """Give each of n intervals that was split the end between, and add the other half behind."""
    copy(S, I, I + n, n)
    copy(S, J, J + n, n)
    copy(S, AT_W, A + n, n)
    copy(S, G, GA + n, n)
    copy(S, SLOPE, SA + n, n)
    copy(S, TAU, TA + n, n)
    copy(S, YB, B + n, n)
    copy(S, YGB, GB + n, n)
    copy(S, YSB, SB + n, n)
    copy(S, YTB, TB + n, n)
    copy(S, AT_W, B, n)
    copy(S, G, GB, n)
    copy(S, SLOPE, SB, n)
    copy(S, TAU, TB, n)


@inner
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
    S, slabs, pixels, where, signs = (
        held.lanes,
        held.slabs,
        held.pixels,
        held.where,
        held.signs,
    )
    table = scene.segment_table[k]
    cornered = scene.cornered[k] != 0
    bounded = False
    roots = whole(0)
    spread(scene.polynomials, k, held.rays, ox, oy, oz, held.fans)
    if table < 0:
        if filled + 2 * n > len(pixels):
            return -1
        n, filled = glance(n, scene, k, enough, held, filled, columns)
    base = n
    while base > 0:
        # The ends of the last intervals that are left, then those, split until none is in doubt.
        n = min(base, CHUNK)
        base -= n
        T = S[base:]
        ask(T, n, A, False)
        evaluate_lanes(T, n, held.fans, table, scene.tables)
        answer(T, n, GA, SA, TA)
        ask(T, n, B, True)
        evaluate_lanes(T, n, held.fans, table, scene.tables)
        answer(T, n, GB, SB, TB)
        if filled + 2 * n > len(pixels):
            return -1
        for m in range(n):
            if T[GA + m] < 0.0:
                pixels[at(0, filled)] = int(T[I + m]) * columns + int(T[J + m])
                where[at(0, filled)], signs[at(0, filled)] = T[A + m], 1.0
                filled += 1
            if T[GB + m] < 0.0:
                pixels[at(0, filled)] = int(T[I + m]) * columns + int(T[J + m])
                where[at(0, filled)], signs[at(0, filled)] = T[B + m], -1.0
                filled += 1
        top = base + n
        while top > base:
            # The fuller the pile, the fewer are split at once: so it never runs over.
            n = min(min(top - base, CHUNK), max(1, (HELD - top) // 8))
            top -= n
            T = S[top:]
            if roots + n > LANES:
                if filled + roots > len(pixels):
                    return -1
                filled = polish_lanes(roots, scene, k, enough, held, filled, columns)
                roots = whole(0)
            if cornered:
                look_at_corners(T, n, slabs, scene.hessians, scene.kinks, k, held.beam, shortest)
            else:
                if not bounded:
                    judge(T, n, slabs, scene.hulls, k)
                    if in_doubt(T, n):
                        bound_cells(scene.hessians, k, slabs, i0, i1, j0, j1, held.cells)
                        bound_blocks(held.cells, held.blocks)
                        bounded = True
                if bounded:
                    judge_closer(T, n, slabs, held.blocks, shortest)
            halves = whole(0)
            for m in range(n):
                code = T[LOW + m]
                if code == ROOT:
                    S[at(RI, roots)], S[at(RJ, roots)], S[at(RT, roots)] = (
                        T[I + m],
                        T[J + m],
                        T[TA + m],
                    )
                    S[at(RA, roots)], S[at(RGA, roots)], S[at(RS, roots)] = (
                        T[A + m],
                        T[GA + m],
                        T[SA + m],
                    )
                    S[at(RB, roots)], S[at(RW, roots)], S[at(RP, roots)] = (
                        T[B + m],
                        T[GB + m],
                        T[SB + m],
                    )
                    S[at(RE, roots)] = T[TB + m]
                    roots += 1
                elif code == SPLIT:
                    T[at(I, halves)], T[at(J, halves)] = T[I + m], T[J + m]
                    T[at(A, halves)], T[at(GA, halves)] = T[A + m], T[GA + m]
                    T[at(SA, halves)], T[at(TA, halves)] = T[SA + m], T[TA + m]
                    T[at(YB, halves)], T[at(YGB, halves)] = T[B + m], T[GB + m]
                    T[at(YSB, halves)], T[at(YTB, halves)] = T[SB + m], T[TB + m]
                    halves += 1
            if top + 2 * halves > HELD:
                return -1
            ask_between(T, halves)
            evaluate_lanes(T, halves, held.fans, table, scene.tables)
            halve(T, halves)
            top += 2 * halves
    if filled + roots > len(pixels):
        return -1
    return polish_lanes(roots, scene, k, enough, held, filled, columns)
