"""A ray against one quadric form, in closed form."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import inner

Floats = NDArray[np.float64]


@inner
def half_line(f: float, slope: float, low: float, high: float) -> tuple[float, float]:
    """Return the part of [low, high] where ``f + w slope <= 0``; an empty one has low > high."""
    if slope > 0:
        return low, min(high, -f / slope)
    if slope < 0:
        return max(low, -f / slope), high
    if f > 0:
        return 1.0, 0.0
    return low, high


@inner
def roots(
    form: Floats, x: float, y: float, z: float, dx: float, dy: float, dz: float, reach: float
) -> tuple[int, float, float]:
    """Solve ``Q(p + w d) = 0`` for the ten numbers of a form about its centre.

    Returns ``(kind, w0, w1)``: 0 nowhere inside, 1 inside between w0 and w1, 2 inside outside of
    them, 3 inside everywhere, 4 inside below w0, 5 inside above w0.
    """
    a00, a11, a22, a01, a02, a12 = form[0], form[1], form[2], form[3], form[4], form[5]
    b0, b1, b2, c = form[6], form[7], form[8], form[9]
    adx = a00 * dx + a01 * dy + a02 * dz
    ady = a01 * dx + a11 * dy + a12 * dz
    adz = a02 * dx + a12 * dy + a22 * dz
    a = adx * dx + ady * dy + adz * dz
    b = adx * x + ady * y + adz * z + b0 * dx + b1 * dy + b2 * dz
    shift = 0.0
    if a != 0.0 and abs(b) <= 8.0 * reach * abs(a):
        # About the point of the ray where Q is stationary the two roots are equal and opposite:
        # what cancels in b^2 - ac is taken in coordinates instead, where it is small.
        shift = -b / a
        x, y, z = x + shift * dx, y + shift * dy, z + shift * dz
        b = adx * x + ady * y + adz * z + b0 * dx + b1 * dy + b2 * dz
    level = (
        x * (a00 * x + 2.0 * (a01 * y + a02 * z + b0))
        + y * (a11 * y + 2.0 * (a12 * z + b1))
        + z * (a22 * z + 2.0 * b2)
        + c
    )
    if a == 0.0:
        if b == 0.0:
            return (3 if level <= 0 else 0), 0.0, 0.0
        w = -level / (2.0 * b)
        return (4 if b > 0 else 5), w, w
    discriminant = b * b - a * level
    if discriminant <= 0.0:
        return (0 if a > 0 else 3), 0.0, 0.0
    q = -(b + math.copysign(math.sqrt(discriminant), b))
    w0, w1 = q / a, level / q
    if w0 > w1:
        w0, w1 = w1, w0
    return (1 if a > 0 else 2), w0 + shift, w1 + shift
