"""The outward unit normal of a leaf at a point of its surface.

A flat face has its plane's, a quadric its form's gradient. A swept surface has that of
``G(x) = h(phi(x, tau(x)), tau(x))``, where ``F(x, tau) = N.x - c = 0`` gives tau (paper II.G; the
engine notes say why it is the direction of dGamma/dv x dGamma/du):

    grad G = Mᵀ grad h - (grad h . dphi/dtau + dh/dtau) / (dF/dtau) N.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import kernel
from phantom.kernels.cylinder import contract, solve_tau
from phantom.kernels.section import changing_star, circle, star

Floats = NDArray[np.float64]

NO_FACE, FLAT, QUADRIC, SIDE, START, END = range(6)
"""Faces: none, a cut or a box's side, a quadric's, a swept surface, and its two flat ends."""


@kernel
def power_sum(polynomials: Floats, k: int, row: int, tau: float) -> float:
    """Return one of a segment's polynomials at tau."""
    value = polynomials[k, row, 6]
    for i in range(5, -1, -1):
        value = value * tau + polynomials[k, row, i]
    return float(value)


@kernel
def slope_of(work: Floats, row: int, tau: float) -> tuple[float, float]:
    """Return a contracted polynomial and its derivative at tau."""
    value, slope = work[row, 6], 0.0
    for i in range(5, -1, -1):
        slope = slope * tau + value
        value = value * tau + work[row, i]
    return value, slope


@kernel
def swept_gradient(
    scene: Scene, k: int, x: float, y: float, z: float, work: Floats, out: Floats
) -> tuple[float, float]:
    """Write grad G of segment k at a point about the leaf's centre; return G and tau."""
    x, y, z = x - scene.origins[k, 0], y - scene.origins[k, 1], z - scene.origins[k, 2]
    contract(scene.polynomials, k, x, y, z, 0.0, 0.0, 0.0, work)
    tau = solve_tau(work, 0.0, 0.0)
    _, f1 = slope_of(work, 0, tau)
    a, a1 = slope_of(work, 2, tau)
    b, b1 = slope_of(work, 4, tau)
    table = scene.segment_table[k]
    rate = 0.0
    if table < 0:
        h, hx, hy = circle(a, b)
    elif scene.tables.first_cell[table] < len(scene.tables.cells):
        h, hx, hy = star(a, b, table, scene.tables)
    else:
        h, hx, hy, rate = changing_star(a, b, tau, table, scene.tables)
    turn = (hx * a1 + hy * b1 + rate) / f1
    for axis in range(3):
        out[axis] = (
            hx * power_sum(scene.polynomials, k, 4 + axis, tau)
            + hy * power_sum(scene.polynomials, k, 8 + axis, tau)
            - turn * power_sum(scene.polynomials, k, axis, tau)
        )
    return h, tau


@kernel
def swept_normal(
    scene: Scene,
    leaf: int,
    x: float,
    y: float,
    z: float,
    slack: float,
    nearest: float,
    work: Floats,
    gradient: Floats,
    out: Floats,
) -> tuple[float, int, int, float]:
    """Write the normal of a generalized cylinder where one of its faces is nearer than ``nearest``.

    Returns how near that face is, which it is, and its segment and tau.
    """
    face, where, at = NO_FACE, -1, 0.0
    for part in range(scene.first_part[leaf], scene.first_part[leaf + 1]):
        for k in range(scene.first_segment[part], scene.first_segment[part + 1]):
            knot, n = k + part, scene.knots
            start = n[knot, 0] * x + n[knot, 1] * y + n[knot, 2] * z - n[knot, 3]
            if start < -slack:
                continue
            knot += 1
            end = n[knot, 0] * x + n[knot, 1] * y + n[knot, 2] * z - n[knot, 3]
            if end > slack:
                continue
            outside = False
            for axis in range(3):
                e = scene.axes
                p = (
                    e[k, axis, 0] * (x - scene.origins[k, 0])
                    + e[k, axis, 1] * (y - scene.origins[k, 1])
                    + e[k, axis, 2] * (z - scene.origins[k, 2])
                )
                low, high = scene.boxes[k, axis, 0], scene.boxes[k, axis, 1]
                outside |= p < low - slack or p > high + slack
            if outside:
                continue
            h, tau = swept_gradient(scene, k, x, y, z, work, gradient)
            size = math.sqrt(gradient[0] ** 2 + gradient[1] ** 2 + gradient[2] ** 2)
            distance = abs(h) / size if size > 0.0 else math.inf
            if distance < nearest:
                nearest, face, where, at = distance, SIDE, k, tau
                out[0], out[1], out[2] = gradient[0] / size, gradient[1] / size, gradient[2] / size
            # Well within the section, the face can only be an end (or a step, where frames jump).
            if h < 0.0 and distance > slack:
                if abs(start) < nearest:
                    nearest, face, where, at = abs(start), START, k, -1.0
                    out[0], out[1], out[2] = -n[knot - 1, 0], -n[knot - 1, 1], -n[knot - 1, 2]
                if abs(end) < nearest:
                    nearest, face, where, at = abs(end), END, k, 1.0
                    out[0], out[1], out[2] = n[knot, 0], n[knot, 1], n[knot, 2]
    return nearest, face, where, at


@kernel
def leaf_normal(
    scene: Scene,
    leaf: int,
    x: float,
    y: float,
    z: float,
    slack: float,
    work: Floats,
    gradient: Floats,
    out: Floats,
) -> tuple[int, int, float]:
    """Write the outward unit normal of a leaf at a world point of its surface.

    The face is the one that the point is nearest to. Returns it, and the segment and tau of a
    generalized cylinder's (-1 and 0 elsewhere).
    """
    x -= scene.leaf_center[leaf, 0]
    y -= scene.leaf_center[leaf, 1]
    z -= scene.leaf_center[leaf, 2]
    nearest, face = math.inf, NO_FACE
    for k in range(scene.first_plane[leaf], scene.first_plane[leaf + 1]):
        n = scene.planes
        distance = abs(n[k, 0] * x + n[k, 1] * y + n[k, 2] * z - n[k, 3])
        if distance < nearest:
            nearest, face = distance, FLAT
            out[0], out[1], out[2] = n[k, 0], n[k, 1], n[k, 2]
    if scene.first_part[leaf] < scene.first_part[leaf + 1]:
        _, side, segment, tau = swept_normal(
            scene, leaf, x, y, z, slack, nearest, work, gradient, out
        )
        if side != NO_FACE:
            return side, segment, tau
    elif scene.leaf_form[leaf] >= 0:
        q, row = scene.forms, scene.leaf_form[leaf]
        gx = 2.0 * (q[row, 0] * x + q[row, 3] * y + q[row, 4] * z + q[row, 6])
        gy = 2.0 * (q[row, 3] * x + q[row, 1] * y + q[row, 5] * z + q[row, 7])
        gz = 2.0 * (q[row, 4] * x + q[row, 5] * y + q[row, 2] * z + q[row, 8])
        level = 0.5 * (
            x * (gx + 2.0 * q[row, 6]) + y * (gy + 2.0 * q[row, 7]) + z * (gz + 2.0 * q[row, 8])
        )
        level += q[row, 9]
        size = math.sqrt(gx * gx + gy * gy + gz * gz)
        if size > 0.0 and abs(level) / size < nearest:
            face = QUADRIC
            out[0], out[1], out[2] = gx / size, gy / size, gz / size
    return face, -1, 0.0


@kernel
def normals(
    scene: Scene,
    points: Floats,
    leaves: NDArray[np.int64],
    slack: float,
    out: Floats,
    faces: NDArray[np.int64],
    taus: Floats,
) -> None:
    """Fill ``out`` (N, 3), ``faces`` (N, 2) with face and segment, and ``taus`` (N,)."""
    work, gradient = np.empty((6, 7)), np.empty(3)
    for i in range(len(points)):
        face, segment, tau = leaf_normal(
            scene,
            leaves[i],
            points[i, 0],
            points[i, 1],
            points[i, 2],
            slack,
            work,
            gradient,
            out[i],
        )
        faces[i, 0], faces[i, 1], taus[i] = face, segment, tau
