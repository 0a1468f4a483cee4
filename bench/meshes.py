"""The knee-like scene as triangles, as programs that trace meshes want it.

Standard density: 96 triangles' edges round a section, 192 along a tube, 96 by 48 on an ellipsoid:
edges of about 1 mm, as in meshes that are segmented from CT.
"""

import numpy as np
from scipy.interpolate import BSpline, CubicSpline

ROUND, ALONG, ACROSS = 96, 192, 48


def mesh(leaf):
    """Return (V, 3) vertices and (T, 3) triangles whose normals point outward."""
    if leaf["type"] == "ellipsoid":
        vertices, triangles = ellipsoid(np.array(leaf["center"]), np.array(leaf["semi_axes"]))
    elif leaf["type"] == "cylinder":
        vertices, triangles = straight(leaf)
    else:
        vertices, triangles = tube(leaf)
    return outward(vertices, triangles)


def ellipsoid(center, semi_axes):
    theta = np.linspace(0, np.pi, ACROSS + 1)
    phi = 2 * np.pi * np.arange(ROUND) / ROUND
    rings = np.stack(
        [
            np.sin(theta)[:, None] * np.cos(phi),
            np.sin(theta)[:, None] * np.sin(phi),
            np.broadcast_to(np.cos(theta)[:, None], (ACROSS + 1, ROUND)),
        ],
        axis=-1,
    )
    vertices, triangles = lofted(rings[1:-1])
    return center + semi_axes * vertices, triangles


def straight(leaf):
    start, end = np.array(leaf["start"]), np.array(leaf["end"])
    along = (end - start) / np.linalg.norm(end - start)
    first = np.array(leaf["up"], dtype=float)
    first -= (first @ along) * along
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    a, b = leaf["semi_axes"]
    phi = 2 * np.pi * np.arange(ROUND) / ROUND
    ring = a * np.cos(phi)[:, None] * first + b * np.sin(phi)[:, None] * second
    return lofted(np.stack([start + ring, end + ring]))


def tube(leaf):
    """A round tube about a clamped B-spline, its radius a cubic through knots."""
    axis = leaf["axis"]
    points, degree = np.array(axis["control_points"]), axis["degree"]
    inner = np.linspace(0, 1, len(points) - degree + 1)
    curve = BSpline(np.concatenate([np.zeros(degree), inner, np.ones(degree)]), points, degree)
    u = np.linspace(0, 1, ALONG + 1)
    a, t = curve(u), curve.derivative()(u)
    t /= np.linalg.norm(t, axis=1)[:, None]
    scale = np.array(leaf["sweep"]["scale"]["knots"])
    radius = leaf["contour"]["radius"] * CubicSpline(scale[:, 0], scale[:, 1])(u)
    # Any frame will do for a circle; one square to x = 1 does for tubes along y.
    first = np.array([1.0, 0, 0]) - t[:, :1] * t
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(t, first)
    phi = 2 * np.pi * np.arange(ROUND) / ROUND
    ring = np.cos(phi)[:, None] * first[:, None] + np.sin(phi)[:, None] * second[:, None]
    return lofted(a[:, None] + radius[:, None, None] * ring)


def lofted(rings):
    """Join (R, C, 3) rings by two triangles a cell, and close both ends by fans."""
    count, around = rings.shape[:2]
    i, j = np.indices((count - 1, around)).reshape(2, -1)
    here, right = i * around + j, i * around + (j + 1) % around
    above, beyond = here + around, right + around
    sides = np.concatenate(
        [np.stack([here, right, beyond], axis=1), np.stack([here, beyond, above], axis=1)]
    )
    low, high = count * around, count * around + 1
    k = np.arange(around)
    following = (k + 1) % around
    last = (count - 1) * around
    ends = np.concatenate(
        [
            np.stack([following, k, np.full(around, low)], axis=1),
            np.stack([last + k, last + following, np.full(around, high)], axis=1),
        ]
    )
    middles = np.stack([rings[0].mean(axis=0), rings[-1].mean(axis=0)])
    vertices = np.concatenate([rings.reshape(-1, 3), middles])
    return vertices, np.concatenate([sides, ends])


def outward(vertices, triangles):
    """Turn all triangles about where the volume they bound is negative."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    return vertices, triangles if volume > 0 else triangles[:, ::-1]
