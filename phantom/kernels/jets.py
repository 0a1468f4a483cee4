"""The jet of a segment on many rays at once: values and slopes of F and G at (w, tau).

The same equations as :mod:`phantom.kernels.cylinder`, for lanes that lie side by side: no branch,
so that the compiler packs them into the processor's wide registers. tau is not solved for to the
end; what is left of F corrects G to the first order, which leaves an error of its square.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import lane

Floats = NDArray[np.float64]
Row = tuple[float, float, float, float, float, float, float]
Plane = tuple[Row, Row, Row, Row]


@lane
def row(polynomials: Floats, k: int, j: int) -> Row:
    """Return one polynomial's seven coefficients."""
    return (
        polynomials[k, j, 0],
        polynomials[k, j, 1],
        polynomials[k, j, 2],
        polynomials[k, j, 3],
        polynomials[k, j, 4],
        polynomials[k, j, 5],
        polynomials[k, j, 6],
    )


@lane
def plane(polynomials: Floats, k: int, j: int) -> Plane:
    """Return the four polynomials of ``a.x - b`` that begin at row j."""
    return (
        row(polynomials, k, j),
        row(polynomials, k, j + 1),
        row(polynomials, k, j + 2),
        row(polynomials, k, j + 3),
    )


@lane
def at_point(p: Plane, x: float, y: float, z: float) -> Row:
    """Return ``a(tau).x - b(tau)`` as a polynomial of tau."""
    a, b, c, d = p
    return (
        a[0] * x + b[0] * y + c[0] * z - d[0],
        a[1] * x + b[1] * y + c[1] * z - d[1],
        a[2] * x + b[2] * y + c[2] * z - d[2],
        a[3] * x + b[3] * y + c[3] * z - d[3],
        a[4] * x + b[4] * y + c[4] * z - d[4],
        a[5] * x + b[5] * y + c[5] * z - d[5],
        a[6] * x + b[6] * y + c[6] * z - d[6],
    )


@lane
def along(p: Plane, x: float, y: float, z: float) -> Row:
    """Return ``a(tau).d`` as a polynomial of tau."""
    a, b, c, _ = p
    return (
        a[0] * x + b[0] * y + c[0] * z,
        a[1] * x + b[1] * y + c[1] * z,
        a[2] * x + b[2] * y + c[2] * z,
        a[3] * x + b[3] * y + c[3] * z,
        a[4] * x + b[4] * y + c[4] * z,
        a[5] * x + b[5] * y + c[5] * z,
        a[6] * x + b[6] * y + c[6] * z,
    )


@lane
def mixed(c: Row, d: Row, w: float) -> Row:
    """Return c + w d."""
    return (
        c[0] + w * d[0],
        c[1] + w * d[1],
        c[2] + w * d[2],
        c[3] + w * d[3],
        c[4] + w * d[4],
        c[5] + w * d[5],
        c[6] + w * d[6],
    )


@lane
def value(c: Row, t: float) -> float:
    """Return the polynomial at t."""
    return (((((c[6] * t + c[5]) * t + c[4]) * t + c[3]) * t + c[2]) * t + c[1]) * t + c[0]


@lane
def value_and_slope(c: Row, t: float) -> tuple[float, float]:
    """Return the polynomial and its derivative at t, by one scheme of Horner's."""
    v = c[6]
    s = v
    v = v * t + c[5]
    s = s * t + v
    v = v * t + c[4]
    s = s * t + v
    v = v * t + c[3]
    s = s * t + v
    v = v * t + c[2]
    s = s * t + v
    v = v * t + c[1]
    s = s * t + v
    return v * t + c[0], s


@lane
def two_slopes(c: Row, t: float) -> tuple[float, float, float]:
    """Return the polynomial and its first two derivatives at t."""
    v = c[6]
    s = v
    v = v * t + c[5]
    h = s
    s = s * t + v
    v = v * t + c[4]
    h = h * t + s
    s = s * t + v
    v = v * t + c[3]
    h = h * t + s
    s = s * t + v
    v = v * t + c[2]
    h = h * t + s
    s = s * t + v
    v = v * t + c[1]
    h = h * t + s
    s = s * t + v
    return v * t + c[0], s, 2.0 * h


@lane
def nearer_tau(f: Row, t: float) -> float:
    """Take one step of Newton's toward F = 0, kept within the segment."""
    v, s = value_and_slope(f, t)
    return min(max(t - v / s, -1.0), 1.0)
