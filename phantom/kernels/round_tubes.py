"""Lanes inside a round section at a known point, where G is convex: both ends of each chord.

They are predicted from G's derivatives at that point, and found by Newton's steps in w and tau
together; the polynomials of a ray are reckoned once for both.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import lane, lane_loop
from phantom.kernels.jets import (
    Fan,
    Row,
    fan,
    from_one_point,
    jet,
    level,
    mixed,
    own,
    two_slopes,
    value_and_slope,
)
from phantom.kernels.lanes import (
    AT_W,
    FT,
    FV,
    FW,
    HT,
    HX,
    HY,
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
    G,
    I,
    J,
)

Floats = NDArray[np.float64]

_ON_PLANE = 1e-6
"""What may be left of F, in tau, where the sign of G at an interval's end is read."""


@lane
def look(S: Floats, m: int, F: Fan, X: Fan, Y: Fan, point: bool) -> None:
    """Do what :func:`probe` does for one lane."""
    i, j, w = S[I + m], S[J + m], S[AT_W + m]
    r, xr, yr = own(F, i, j), own(X, i, j), own(Y, i, j)
    f = mixed(point, F[0], r, w)
    # F falls from one end of the segment to the other, nearly straight.
    even, odd = f[0] + f[2] + f[4] + f[6], f[1] + f[3] + f[5]
    t = min(max(-even / odd, -1.0), 1.0)
    fv, ft = value_and_slope(f, t)
    over = 1.0 / ft
    t = min(max(t - fv * over, -1.0), 1.0)
    # The slope has hardly changed since: a product mends its inverse.
    fv, ft = value_and_slope(f, t)
    over *= 2.0 - ft * over
    t = min(max(t - fv * over, -1.0), 1.0)
    fv, ft, ftt = two_slopes(f, t)
    fw, fwt = value_and_slope(r if point else F[0], t)
    xv, xt, xtt = two_slopes(mixed(point, X[0], xr, w), t)
    xw, xwt = value_and_slope(xr if point else X[0], t)
    yv, yt, ytt = two_slopes(mixed(point, Y[0], yr, w), t)
    yw, ywt = value_and_slope(yr if point else Y[0], t)
    over = 1.0 / ft
    rest, turn = fv * over, -fw * over
    turning = -turn * (ftt * turn + 2.0 * fwt) * over
    x1, y1 = xw + xt * turn, yw + yt * turn
    x2 = turn * (xtt * turn + 2.0 * xwt) + xt * turning
    y2 = turn * (ytt * turn + 2.0 * ywt) + yt * turning
    xv, yv = xv - xt * rest, yv - yt * rest
    S[TAU + m], S[G + m] = t - rest, xv * xv + yv * yv - 1.0
    S[SLOPE + m] = 2.0 * (xv * x1 + yv * y1)
    S[HT + m], S[HY + m] = turn, turning
    S[HX + m] = 2.0 * (x1 * x1 + y1 * y1 + xv * x2 + yv * y2)
    S[XV + m] = 6.0 * (x1 * x2 + y1 * y2)
    S[YV + m] = 6.0 * (x2 * x2 + y2 * y2)


@lane_loop
def probe(S: Floats, n: int, fans: Floats) -> None:
    """Look at G once on each of n intervals, at ``AT_W``.

    ``TAU``, ``G`` and ``SLOPE`` are what was found.
    ``HT`` and ``HY`` are the first two derivatives of tau along the ray, ``HX``, ``XV`` and ``YV``
    the next three of G, the last one roughly.
    """
    F, X, Y = fan(fans, 0), fan(fans, 1), fan(fans, 2)
    if from_one_point(fans):
        for m in range(n):
            look(S, m, F, X, Y, True)
    else:
        for m in range(n):
            look(S, m, F, X, Y, False)


@lane
def both_ways(
    g: float, slope: float, second: float, third: float, fourth: float
) -> tuple[float, float]:
    """Return how far off G's roots before and behind are, as five terms of its series have it.

    The parabola's roots are mended by two steps of Newton's, with the slope at the first.
    """
    root = math.sqrt(max(slope * slope - 2.0 * g * second, 0.0))
    over = 1.0 / (root * second)
    flat, half = over * second, over * root
    a, b, c = 0.5 * second, third / 6.0, fourth / 24.0
    before, behind = -(root + slope) * half, (root - slope) * half
    x = -flat * (3.0 * b + 4.0 * c * before) * before * before
    step = -flat * (1.0 - x * (1.0 - x))
    before -= step * (b + c * before) * before * before * before
    before -= step * ((((c * before + b) * before + a) * before + slope) * before + g)
    x = flat * (3.0 * b + 4.0 * c * behind) * behind * behind
    step = flat * (1.0 - x * (1.0 - x))
    behind -= step * (b + c * behind) * behind * behind * behind
    behind -= step * ((((c * behind + b) * behind + a) * behind + slope) * behind + g)
    return before, behind


Jet = tuple[float, float, float, float, float, float, float, float, float]
"""Of a point: w, tau, G, 1 / G', dtau/dw, 1 / F_tau, the slopes of x and y along tau, and by how
much tau was mended."""


@lane
def first_look(
    F: Fan,
    X: Fan,
    Y: Fan,
    fr: Row,
    xr: Row,
    yr: Row,
    point: bool,
    w: float,
    tau: float,
) -> Jet:
    """Mend tau at w, and take G and its slope there.

    ``fr``, ``xr`` and ``yr`` are what the ray has of its own.
    """
    t = min(max(tau, -1.0), 1.0)
    fv, ft, fw, fwt = jet(point, F[0], fr, w, t)
    over = 1.0 / ft
    off = fv * over
    turn = (off * fwt - fw) * over
    t = min(max(t - off, -1.0), 1.0)
    xv, xt, xw, _ = jet(point, X[0], xr, w, t)
    yv, yt, yw, _ = jet(point, Y[0], yr, w, t)
    slope = 2.0 * (xv * xw + yv * yw) + 2.0 * (xv * xt + yv * yt) * turn
    return w, t, xv * xv + yv * yv - 1.0, 1.0 / slope, turn, over, xt, yt, off


@lane
def second_look(
    F: Fan,
    X: Fan,
    Y: Fan,
    fr: Row,
    xr: Row,
    yr: Row,
    point: bool,
    seen: Jet,
    low: float,
    high: float,
    rising: bool,
    bend: float,
    turning: float,
    enough: float,
) -> tuple[float, bool]:
    """Step to the root of G between two w, of which the one it rises toward is the interval's end.

    Returns it, or that end where G is still negative there, and whether it is good enough.
    ``bend`` is about G'' at the first look and ``turning`` about the second derivative of tau.
    """
    w, t, g, flat, turn, over, xt, yt, off = seen
    end = high if rising else low
    # The first step is Chebyshev's, of third order; where an interval ends long before its root
    # the bend would turn it around.
    straight = -g * flat
    following = w + straight * max(1.0 - 0.5 * straight * bend * flat, 0.5)
    following = min(max(following, low), high)
    moved = following - w
    turned = (turn + 0.5 * turning * moved) * moved
    at = min(max(t + turned, -1.0), 1.0)
    xv = level(point, X[0], xr, following, at)
    yv = level(point, Y[0], yr, following, at)
    rest = level(point, F[0], fr, following, at) * over
    g = xv * xv + yv * yv - 1.0 - 2.0 * (xv * xt + yv * yt) * rest
    # The second is Newton's, with the slope of the first and what the bend has made of it: that is
    # 1 / flat (1 + change), turned over by two steps that need no division.
    change = bend * moved * flat
    upright = (1.0 - change) * (1.0 + change * change)
    step = -g * flat * upright
    wide = high - low
    first = abs(moved) + wide * (abs(turned) + abs(off))
    second = abs(step) + wide * abs(rest - turn * step)
    # The slope is wrong by about the square of the part it has changed by, or as the second step
    # has it; what was left against roots found to the end was a quarter of this at the most.
    near = first * abs(bend * flat)
    left = 4.0 * second * (near * near * first + second)
    beyond = (following == end) & (g < 0.0)
    fine = ((left < enough * first) | (second < 1e-15)) & ((flat * (1.0 + change) > 0.0) == rising)
    fine = (abs(rest) < _ON_PLANE) if beyond else fine
    root = min(max(following + step, low), high)
    return (end if beyond else root), fine


@lane
def chord(S: Floats, m: int, F: Fan, X: Fan, Y: Fan, point: bool, enough: float) -> None:
    """Do what :func:`chords` does for one lane."""
    i, j, a, b = S[RI + m], S[RJ + m], S[RA + m], S[RB + m]
    w, t, turn, turning = S[RW + m], S[RT + m], S[RP + m], S[RE + m]
    g, slope, bend, third, fourth = S[RGA + m], S[RS + m], S[RC + m], S[YT + m], S[YW + m]
    fr, xr, yr = own(F, i, j), own(X, i, j), own(Y, i, j)
    before, behind = both_ways(g, slope, bend, third, fourth)
    before, behind = max(before, a - w), min(behind, b - w)
    # Both ends side by side: the processor does the one while the other waits.
    v, u = min(max(w + before, a), w), min(max(w + behind, w), b)
    at = t + (turn + 0.5 * turning * before) * before
    one = first_look(F, X, Y, fr, xr, yr, point, v, at)
    at = t + (turn + 0.5 * turning * behind) * behind
    other = first_look(F, X, Y, fr, xr, yr, point, u, at)
    curved = bend + (third + 0.5 * fourth * before) * before
    entry, sure = second_look(F, X, Y, fr, xr, yr, point, one, a, w, False, curved, turning, enough)
    curved = bend + (third + 0.5 * fourth * behind) * behind
    exit_, certain = second_look(
        F, X, Y, fr, xr, yr, point, other, w, b, True, curved, turning, enough
    )
    S[FV + m], S[FT + m] = entry, exit_
    S[FW + m] = 1.0 if sure & certain else 0.0


@lane_loop
def chords(S: Floats, n: int, fans: Floats, enough: float) -> None:
    """Write both ends of n chords into ``FV`` and ``FT``, and whether they are good into ``FW``."""
    F, X, Y = fan(fans, 0), fan(fans, 1), fan(fans, 2)
    if from_one_point(fans):
        for m in range(n):
            chord(S, m, F, X, Y, True, enough)
    else:
        for m in range(n):
            chord(S, m, F, X, Y, False, enough)
