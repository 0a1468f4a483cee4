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
Fan = tuple[Row, Row, Row, Row]
"""Of ``a.x - b``: what all rays of a view share, what the first has of its own, and its steps."""


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
def from_one_point(rays: Floats) -> float:
    """Return 1 where all rays share their origin, 0 where they share their direction instead."""
    own = abs(rays[1, 0]) + abs(rays[1, 1]) + abs(rays[1, 2])
    own += abs(rays[2, 0]) + abs(rays[2, 1]) + abs(rays[2, 2])
    return 1.0 if own == 0.0 else 0.0


@lane
def along(p: Plane, x: float, y: float, z: float, about: float) -> Row:
    """Return ``a(tau).x - b(tau)`` as a polynomial of tau; of a way, ``about`` = 0, without b."""
    a, b, c, d = p
    return (
        a[0] * x + b[0] * y + c[0] * z - about * d[0],
        a[1] * x + b[1] * y + c[1] * z - about * d[1],
        a[2] * x + b[2] * y + c[2] * z - about * d[2],
        a[3] * x + b[3] * y + c[3] * z - about * d[3],
        a[4] * x + b[4] * y + c[4] * z - about * d[4],
        a[5] * x + b[5] * y + c[5] * z - about * d[5],
        a[6] * x + b[6] * y + c[6] * z - about * d[6],
    )


@lane
def fan(p: Plane, rays: Floats, ox: float, oy: float, oz: float, point: float) -> Fan:
    """Write ``a.(o + w d) - b`` of every ray as C p(w) + (U + i V + j W) q(w).

    Rays from one point share what belongs to their origin, C, with p = 1 and q = w; parallel ones
    what belongs to their direction, with p = w and q = 1.
    """
    bundle = 1.0 - point
    dx, dy, dz = rays[3, 0], rays[3, 1], rays[3, 2]
    return (
        along(
            p,
            point * ox + bundle * dx,
            point * oy + bundle * dy,
            point * oz + bundle * dz,
            point,
        ),
        along(
            p,
            point * dx + bundle * ox,
            point * dy + bundle * oy,
            point * dz + bundle * oz,
            bundle,
        ),
        along(p, rays[1, 0] + rays[4, 0], rays[1, 1] + rays[4, 1], rays[1, 2] + rays[4, 2], 0.0),
        along(p, rays[2, 0] + rays[5, 0], rays[2, 1] + rays[5, 1], rays[2, 2] + rays[5, 2], 0.0),
    )


@lane
def own(f: Fan, i: float, j: float) -> Row:
    """Return what the ray of row i and column j has of its own."""
    _, u, v, w = f
    return (
        u[0] + i * v[0] + j * w[0],
        u[1] + i * v[1] + j * w[1],
        u[2] + i * v[2] + j * w[2],
        u[3] + i * v[3] + j * w[3],
        u[4] + i * v[4] + j * w[4],
        u[5] + i * v[5] + j * w[5],
        u[6] + i * v[6] + j * w[6],
    )


@lane
def mixed(c: Row, d: Row, p: float, q: float) -> Row:
    """Return p c + q d."""
    return (
        p * c[0] + q * d[0],
        p * c[1] + q * d[1],
        p * c[2] + q * d[2],
        p * c[3] + q * d[3],
        p * c[4] + q * d[4],
        p * c[5] + q * d[5],
        p * c[6] + q * d[6],
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
