"""The jet of a segment on many rays at once: values and slopes of F and G at (w, tau).

The same equations as :mod:`phantom.kernels.cylinder`, for lanes that lie side by side: no branch,
so that the compiler packs them into the processor's wide registers. tau is not solved for to the
end; what is left of F corrects G to the first order, which leaves an error of its square.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import lane, lane_loop

Floats = NDArray[np.float64]
Row = tuple[float, float, float, float, float, float, float]
Plane = tuple[Row, Row, Row, Row]
FANS = 3 * 28 + 1
"""Numbers that are written of a segment: three fans of four rows, and what kind they are."""

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
def write_row(row: Row, into: Floats, at: int) -> None:
    """Write seven coefficients side by side."""
    into[at], into[at + 1], into[at + 2], into[at + 3] = row[0], row[1], row[2], row[3]
    into[at + 4], into[at + 5], into[at + 6] = row[4], row[5], row[6]


@lane
def read_row(source: Floats, at: int) -> Row:
    """Read what :func:`write_row` wrote."""
    return (
        source[at],
        source[at + 1],
        source[at + 2],
        source[at + 3],
        source[at + 4],
        source[at + 5],
        source[at + 6],
    )


@lane_loop
def spread(
    polynomials: Floats, k: int, rays: Floats, ox: float, oy: float, oz: float, fans: Floats
) -> None:
    """Write ``a.(o + w d) - b`` of F, x and y and every ray as C + w (U + i V + j W).

    ``rays`` is (6, 3): origin, its steps to the next row and column, direction, its steps; the
    origin is taken from (ox, oy, oz), about the segment. Rays from one point share what belongs to
    their origin, C; parallel ones what belongs to their direction, and w stands before it instead.
    The last number is 1 for the former and 0 for the latter.
    """
    steps = abs(rays[1, 0]) + abs(rays[1, 1]) + abs(rays[1, 2])
    steps += abs(rays[2, 0]) + abs(rays[2, 1]) + abs(rays[2, 2])
    point = 1.0 if steps == 0.0 else 0.0
    bundle = 1.0 - point
    dx, dy, dz = rays[3, 0], rays[3, 1], rays[3, 2]
    cx, cy, cz = point * ox + bundle * dx, point * oy + bundle * dy, point * oz + bundle * dz
    ux, uy, uz = point * dx + bundle * ox, point * dy + bundle * oy, point * dz + bundle * oz
    vx, vy, vz = rays[1, 0] + rays[4, 0], rays[1, 1] + rays[4, 1], rays[1, 2] + rays[4, 2]
    wx, wy, wz = rays[2, 0] + rays[5, 0], rays[2, 1] + rays[5, 1], rays[2, 2] + rays[5, 2]
    for n in range(3):
        p, at = plane(polynomials, k, 4 * n), 28 * n
        write_row(along(p, cx, cy, cz, point), fans, at)
        write_row(along(p, ux, uy, uz, bundle), fans, at + 7)
        write_row(along(p, vx, vy, vz, 0.0), fans, at + 14)
        write_row(along(p, wx, wy, wz, 0.0), fans, at + 21)
    fans[3 * 28] = point


@lane
def fan(fans: Floats, n: int) -> Fan:
    """Read the fan of F, x or y, number n of what :func:`spread` wrote."""
    return (
        read_row(fans, 28 * n),
        read_row(fans, 28 * n + 7),
        read_row(fans, 28 * n + 14),
        read_row(fans, 28 * n + 21),
    )


@lane
def from_one_point(fans: Floats) -> bool:
    """Tell whether all rays share their origin, not their direction."""
    return bool(fans[3 * 28] != 0.0)


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
def mixed(point: bool, c: Row, u: Row, w: float) -> Row:
    """Return c + w u for rays from one point, u + w c for parallel ones."""
    a, b = (c, u) if point else (u, c)
    return (
        a[0] + w * b[0],
        a[1] + w * b[1],
        a[2] + w * b[2],
        a[3] + w * b[3],
        a[4] + w * b[4],
        a[5] + w * b[5],
        a[6] + w * b[6],
    )


@lane
def level(point: bool, c: Row, u: Row, w: float, t: float) -> float:
    """Return :func:`mixed` at t."""
    a, b = value(c, t), value(u, t)
    return a + w * b if point else b + w * a


@lane
def rate(point: bool, c: Row, u: Row, t: float) -> float:
    """Return the slope of :func:`mixed` along w, at t."""
    return value(u, t) if point else value(c, t)


@lane
def jet(point: bool, c: Row, u: Row, w: float, t: float) -> tuple[float, float, float, float]:
    """Return :func:`mixed` at t, its slopes along tau and w, and the mixed one."""
    (a, at), (b, bt) = value_and_slope(c, t), value_and_slope(u, t)
    if point:
        return a + w * b, at + w * bt, b, bt
    return b + w * a, bt + w * at, a, at


@lane
def nearer_tau(f: Row, t: float) -> float:
    """Take one step of Newton's toward F = 0, kept within the segment."""
    v, s = value_and_slope(f, t)
    return min(max(t - v / s, -1.0), 1.0)
