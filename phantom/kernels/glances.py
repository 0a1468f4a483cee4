"""One look at each lane of a round segment, near the lowest point of G, and what it decides alone.

Most lanes miss a segment or lie wholly inside it: then the parabolas that G cannot leave, from that
one point, say so. Where G is convex and negative there, it has one root at most on either side,
which :mod:`phantom.kernels.round_tubes` finds. All others are left to
:mod:`phantom.kernels.isolation`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, lane_loop, whole
from phantom.kernels.lanes import (
    AT_W,
    CHUNK,
    FT,
    FV,
    FW,
    HT,
    HX,
    HY,
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
    SLOPE,
    TAU,
    XV,
    YT,
    YV,
    YW,
    A,
    B,
    G,
    I,
    J,
    at,
)
from phantom.kernels.round_tubes import chords, probe
from phantom.kernels.scratch import Scratch
from phantom.kernels.verdicts import way_up

Floats = NDArray[np.float64]

MISS, INSIDE, HIT, OPEN = 0.0, 1.0, 2.0, 3.0
"""Nothing of the interval is inside, or all of it, or one piece; or more must be known."""


@lane_loop
def aim_low(S: Floats, n: int, slabs: Floats) -> None:
    """Aim ``AT_W`` about where G is lowest: where the ray is nearest to the axis of the box.

    Nearness is measured by the ellipse within the box, which is about the section.
    """
    p0, p0i, p0j = slabs[0, 0], slabs[0, 1], slabs[0, 2]
    p1, p1i, p1j = slabs[1, 0], slabs[1, 1], slabs[1, 2]
    e0, e0i, e0j = slabs[0, 3], slabs[0, 4], slabs[0, 5]
    e1, e1i, e1j = slabs[1, 3], slabs[1, 4], slabs[1, 5]
    u0, u1 = 1.0 / (slabs[0, 6] * slabs[0, 6]), 1.0 / (slabs[1, 6] * slabs[1, 6])
    for m in range(n):
        i, j = S[I + m], S[J + m]
        a, b = e0 + i * e0i + j * e0j, e1 + i * e1i + j * e1j
        p, q = p0 + i * p0i + j * p0j, p1 + i * p1i + j * p1j
        w = -(p * a * u0 + q * b * u1) / (a * a * u0 + b * b * u1 + 1e-280)
        S[AT_W + m] = min(max(w, S[A + m]), S[B + m])


@lane_loop
def judge_glance(S: Floats, n: int, slabs: Floats, hulls: Floats, k: int) -> None:
    """Write into ``LOW`` what G and its slope at ``AT_W`` say of n intervals."""
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
        w, g, slope = S[AT_W + m], S[G + m], S[SLOPE + m]
        negative = g < 0.0
        sign = -1.0 if negative else 1.0
        least = -high if negative else low
        on, back = way_up(sign * g, sign * slope, least), way_up(sign * g, -sign * slope, least)
        clear = (on > S[B + m] - w) & (back > w - S[A + m])
        decided = INSIDE if negative else MISS
        open_ = HIT if negative & (low > 0.0) else OPEN
        S[LOW + m] = decided if clear else open_


@inner
def glance(
    n: int,
    scene: Scene,
    k: int,
    enough: float,
    held: Scratch,
    filled: int,
    columns: int,
) -> tuple[int, int]:
    """Record the chords of n lanes that one look tells of.

    Returns how many lanes are left, brought to the front, and how many records there are.
    """
    S, slabs = held.lanes, held.slabs
    pixels, where, signs = held.pixels, held.where, held.signs
    left = whole(0)
    for base in range(0, n, CHUNK):
        T = S[base:]
        count = min(n - base, CHUNK)
        aim_low(T, count, slabs)
        probe(T, count, held.fans)
        judge_glance(T, count, slabs, scene.hulls, k)
        hits = whole(0)
        for m in range(count):
            code = T[LOW + m]
            if code == INSIDE:
                pixel = int(T[I + m]) * columns + int(T[J + m])
                pixels[at(0, filled)], where[at(0, filled)], signs[at(0, filled)] = (
                    pixel,
                    T[A + m],
                    1.0,
                )
                pixels[at(1, filled)], where[at(1, filled)], signs[at(1, filled)] = (
                    pixel,
                    T[B + m],
                    -1.0,
                )
                filled += 2
            elif code == HIT:
                T[at(RI, hits)], T[at(RJ, hits)] = T[I + m], T[J + m]
                T[at(RA, hits)], T[at(RB, hits)], T[at(RW, hits)] = T[A + m], T[B + m], T[AT_W + m]
                T[at(RT, hits)], T[at(RP, hits)], T[at(RGA, hits)] = T[TAU + m], T[HT + m], T[G + m]
                T[at(RS, hits)], T[at(RC, hits)], T[at(RE, hits)] = (
                    T[SLOPE + m],
                    T[HX + m],
                    T[HY + m],
                )
                T[at(YT, hits)], T[at(YW, hits)] = T[XV + m], T[YV + m]
                hits += 1
            elif code != MISS:
                S[at(I, left)], S[at(J, left)] = T[I + m], T[J + m]
                S[at(A, left)], S[at(B, left)] = T[A + m], T[B + m]
                left += 1
        if hits == 0:
            continue
        chords(T, hits, held.fans, enough)
        for m in range(hits):
            if T[FW + m] == 0.0:
                S[at(I, left)], S[at(J, left)] = T[RI + m], T[RJ + m]
                S[at(A, left)], S[at(B, left)] = T[RA + m], T[RB + m]
                left += 1
                continue
            pixel = int(T[RI + m]) * columns + int(T[RJ + m])
            pixels[at(0, filled)], where[at(0, filled)], signs[at(0, filled)] = (
                pixel,
                T[FV + m],
                1.0,
            )
            pixels[at(1, filled)], where[at(1, filled)], signs[at(1, filled)] = (
                pixel,
                T[FT + m],
                -1.0,
            )
            filled += 2
    return left, filled
