"""Lanes with one root of G each: guessed by a cubic, then found by Newton's steps in a bracket."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, lane_loop, whole
from phantom.kernels.lanes import (
    AT_I,
    AT_J,
    AT_T,
    AT_W,
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
    G,
    at,
    evaluate_lanes,
)
from phantom.kernels.scratch import Scratch

Floats = NDArray[np.float64]

ERROR_MM = 1e-11
"""What a root may be wrong by, as the last step of Newton's and the bend of G there have it."""

_HALVINGS = 200


@lane_loop
def first_guess(S: Floats, n: int) -> None:
    """Guess each root from the cubic with the values and slopes of both ends, and tau there.

    ``RE`` is tau at the far end. A tau from too far away leaves G wrong by more than G is so near
    to its root, and with the wrong sign it would be looked for on the wrong side.
    """
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
        S[RT + m] += t * (S[RE + m] - S[RT + m])
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


@inner
def polish_lanes(
    n: int,
    scene: Scene,
    k: int,
    enough: float,
    held: Scratch,
    filled: int,
    columns: int,
) -> int:
    """Find the one root in each of n intervals and record it; return how many records there are."""
    S, pixels, where, signs = held.lanes, held.pixels, held.where, held.signs
    table = scene.segment_table[k]
    first_guess(S, n)
    for step in range(_HALVINGS):
        if n == 0:
            break
        aim(S, n)
        evaluate_lanes(S, n, held.fans, table, scene.tables)
        if step == 0:
            first_step(S, n)
            continue
        newton(S, n)
        left = whole(0)
        for m in range(n):
            if S[RE + m] < enough or S[RB + m] - S[RA + m] < 1e-15 or step == _HALVINGS - 1:
                pixels[at(0, filled)] = int(S[RI + m]) * columns + int(S[RJ + m])
                where[at(0, filled)] = S[RW + m]
                signs[at(0, filled)] = 1.0 if S[RGA + m] > 0.0 else -1.0
                filled += 1
            else:
                S[at(RI, left)], S[at(RJ, left)], S[at(RT, left)] = S[RI + m], S[RJ + m], S[RT + m]
                S[at(RA, left)], S[at(RB, left)], S[at(RW, left)] = S[RA + m], S[RB + m], S[RW + m]
                S[at(RGA, left)], S[at(RS, left)], S[at(RP, left)] = (
                    S[RGA + m],
                    S[RS + m],
                    S[RP + m],
                )
                left += 1
        n = left
    return filled
