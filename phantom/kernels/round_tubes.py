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
    Row,
    along,
    at_point,
    mixed,
    nearer_tau,
    plane,
    two_slopes,
    value,
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


@lane_loop
def probe(
    S: Floats,
    n: int,
    rays: Floats,
    ox: float,
    oy: float,
    oz: float,
    polynomials: Floats,
    k: int,
) -> None:
    """Look at G once on each of n intervals, at ``AT_W``.

    ``TAU``, ``G`` and ``SLOPE`` are what was found, ``HT`` and ``HY`` the first two derivatives of
    tau along the ray, and ``HX``, ``XV`` and ``YV`` the next three of G, the last one roughly.
    """
    px, py = plane(polynomials, k, 4), plane(polynomials, k, 8)
    pf = plane(polynomials, k, 0)
    oxi, oyi, ozi = rays[1, 0], rays[1, 1], rays[1, 2]
    oxj, oyj, ozj = rays[2, 0], rays[2, 1], rays[2, 2]
    dx0, dy0, dz0 = rays[3, 0], rays[3, 1], rays[3, 2]
    dxi, dyi, dzi = rays[4, 0], rays[4, 1], rays[4, 2]
    dxj, dyj, dzj = rays[5, 0], rays[5, 1], rays[5, 2]
    for m in range(n):
        i, j, w = S[I + m], S[J + m], S[AT_W + m]
        dx = dx0 + i * dxi + j * dxj
        dy = dy0 + i * dyi + j * dyj
        dz = dz0 + i * dzi + j * dzj
        x = ox + i * oxi + j * oxj + w * dx
        y = oy + i * oyi + j * oyj + w * dy
        z = oz + i * ozi + j * ozj + w * dz
        f = at_point(pf, x, y, z)
        # F falls from one end of the segment to the other, nearly straight.
        even, odd = f[0] + f[2] + f[4] + f[6], f[1] + f[3] + f[5]
        t = min(max(-even / odd, -1.0), 1.0)
        t = nearer_tau(f, nearer_tau(f, t))
        fv, ft, ftt = two_slopes(f, t)
        fw, fwt = value_and_slope(along(pf, dx, dy, dz), t)
        xv, xt, xtt = two_slopes(at_point(px, x, y, z), t)
        xw, xwt = value_and_slope(along(px, dx, dy, dz), t)
        yv, yt, ytt = two_slopes(at_point(py, x, y, z), t)
        yw, ywt = value_and_slope(along(py, dx, dy, dz), t)
        over = 1.0 / ft
        rest, turn = fv * over, -fw * over
        turning = -turn * (ftt * turn + 2.0 * fwt) * over
        x1, y1 = xw + xt * turn, yw + yt * turn
        x2 = turn * (xtt * turn + 2.0 * xwt) + xt * turning
        y2 = turn * (ytt * turn + 2.0 * ywt) + yt * turning
        xv, yv = xv - xt * rest, yv - yt * rest
        g, slope = xv * xv + yv * yv - 1.0, 2.0 * (xv * x1 + yv * y1)
        S[TAU + m], S[G + m], S[SLOPE + m] = t - rest, g, slope
        S[HT + m], S[HY + m] = turn, turning
        S[HX + m] = 2.0 * (x1 * x1 + y1 * y1 + xv * x2 + yv * y2)
        S[XV + m] = 6.0 * (x1 * x2 + y1 * y2)
        S[YV + m] = 6.0 * (x2 * x2 + y2 * y2)


@lane
def predicted(
    g: float, slope: float, second: float, third: float, fourth: float, side: float
) -> float:
    """Return how far off the root of G is on one side, as five terms of its series have it."""
    root = math.sqrt(max(slope * slope - 2.0 * g * second, 0.0))
    way = (side * root - slope) / second
    a, b, c = 0.5 * second, third / 6.0, fourth / 24.0
    for _ in range(2):
        value = (((c * way + b) * way + a) * way + slope) * way + g
        way -= value / (((4.0 * c * way + 3.0 * b) * way + 2.0 * a) * way + slope)
    return way


@lane
def end_of_chord(
    f0: Row,
    f1: Row,
    x0: Row,
    x1: Row,
    y0: Row,
    y1: Row,
    guess: float,
    tau: float,
    low: float,
    high: float,
    rising: bool,
    bend: float,
    enough: float,
) -> tuple[float, bool]:
    """Find the root of G between two w, of which the one it rises toward is the interval's end.

    Returns it, or that end where G is still negative there, and whether it is good enough.
    ``f0 + w f1`` is F as a polynomial of tau, and so are x and y; ``bend`` is about G''.
    """
    end = high if rising else low
    w = min(max(guess, low), high)
    t = min(max(tau, -1.0), 1.0)
    fv, ft = value_and_slope(mixed(f0, f1, w), t)
    fw = value(f1, t)
    xv, xt = value_and_slope(mixed(x0, x1, w), t)
    yv, yt = value_and_slope(mixed(y0, y1, w), t)
    xw, yw = value(x1, t), value(y1, t)
    gt, gw = 2.0 * (xv * xt + yv * yt), 2.0 * (xv * xw + yv * yw)
    over = 1.0 / ft
    moved = w - (xv * xv + yv * yv - 1.0 - gt * (fv * over)) / (gw - gt * (fw * over))
    moved = min(max(moved, low), high)
    t = min(max(t - (fv + fw * (moved - w)) * over, -1.0), 1.0)
    w = moved
    fv, ft = value_and_slope(mixed(f0, f1, w), t)
    fw = value(f1, t)
    xv, xt = value_and_slope(mixed(x0, x1, w), t)
    yv, yt = value_and_slope(mixed(y0, y1, w), t)
    xw, yw = value(x1, t), value(y1, t)
    gt, gw = 2.0 * (xv * xt + yv * yt), 2.0 * (xv * xw + yv * yw)
    over = 1.0 / ft
    slope = gw - gt * (fw * over)
    flat = 1.0 / slope
    following = w - (xv * xv + yv * yv - 1.0 - gt * (fv * over)) * flat
    following = min(max(following, low), high)
    moved = following - w
    turned = -(fv + fw * moved) * over
    at = min(max(t + turned, -1.0), 1.0)
    # A second step with the slopes of the first.
    fv = value(mixed(f0, f1, following), at)
    xv, yv = value(mixed(x0, x1, following), at), value(mixed(y0, y1, following), at)
    rest = fv * over
    g = xv * xv + yv * yv - 1.0 - gt * rest
    step = -g * flat
    wide = high - low
    first = abs(moved) + wide * abs(turned)
    second = abs(step) + wide * abs(rest + fw * over * step)
    # The slope has changed by about bend * first, or as the second step has it.
    left = second * (2.0 * first * abs(bend * flat) + 4.0 * second / (first + 1e-300))
    beyond = (following == end) & (g < 0.0)
    fine = ((left < enough) | (second < 1e-15)) & ((slope > 0.0) == rising)
    fine = (abs(rest) < _ON_PLANE) if beyond else fine
    root = min(max(following + step, low), high)
    return (end if beyond else root), fine


@lane_loop
def chords(
    S: Floats,
    n: int,
    rays: Floats,
    ox: float,
    oy: float,
    oz: float,
    polynomials: Floats,
    k: int,
    enough: float,
) -> None:
    """Write both ends of n chords into ``FV`` and ``FT``, and whether they are good into ``FW``."""
    px, py = plane(polynomials, k, 4), plane(polynomials, k, 8)
    pf = plane(polynomials, k, 0)
    oxi, oyi, ozi = rays[1, 0], rays[1, 1], rays[1, 2]
    oxj, oyj, ozj = rays[2, 0], rays[2, 1], rays[2, 2]
    dx0, dy0, dz0 = rays[3, 0], rays[3, 1], rays[3, 2]
    dxi, dyi, dzi = rays[4, 0], rays[4, 1], rays[4, 2]
    dxj, dyj, dzj = rays[5, 0], rays[5, 1], rays[5, 2]
    for m in range(n):
        i, j, a, b = S[RI + m], S[RJ + m], S[RA + m], S[RB + m]
        w, t, turn, turning = S[RW + m], S[RT + m], S[RP + m], S[RE + m]
        g, slope, bend, third, fourth = S[RGA + m], S[RS + m], S[RC + m], S[YT + m], S[YW + m]
        dx = dx0 + i * dxi + j * dxj
        dy = dy0 + i * dyi + j * dyj
        dz = dz0 + i * dzi + j * dzj
        x, y, z = ox + i * oxi + j * oxj, oy + i * oyi + j * oyj, oz + i * ozi + j * ozj
        f0, x0, y0 = at_point(pf, x, y, z), at_point(px, x, y, z), at_point(py, x, y, z)
        f1, x1, y1 = along(pf, dx, dy, dz), along(px, dx, dy, dz), along(py, dx, dy, dz)
        to = predicted(g, slope, bend, third, fourth, -1.0)
        at = t + (turn + 0.5 * turning * to) * to
        entry, sure = end_of_chord(f0, f1, x0, x1, y0, y1, w + to, at, a, w, False, bend, enough)
        to = predicted(g, slope, bend, third, fourth, 1.0)
        at = t + (turn + 0.5 * turning * to) * to
        exit_, certain = end_of_chord(f0, f1, x0, x1, y0, y1, w + to, at, w, b, True, bend, enough)
        S[FV + m], S[FT + m] = entry, exit_
        S[FW + m] = 1.0 if sure & certain else 0.0
