"""Integrals of path lengths over a plane: the volume, seen from any direction."""

import numpy as np

import phantom
from tests.oracles.rays import unit


def volume(shape, direction, rng, count=400_000):
    """Sum of L dA over a square lattice of parallel rays, turned and shifted at random.

    Path lengths start like a square root at silhouettes, so a lattice is off by some spacing^1.5
    times the root of the outline's length.
    """
    d = unit(np.asarray(direction, dtype=float))
    a = unit(np.cross(d, rng.standard_normal(3)))
    b = np.cross(d, a)
    x, y, z = shape.bounds.T
    corners = np.array([(i, j, k) for i in x for j in y for k in z])
    p, q, depth = corners @ a, corners @ b, (corners @ d).min() - 10.0
    spacing = np.sqrt(np.ptp(p) * np.ptp(q) / count)
    p, q = (np.arange(m.min() - spacing * rng.random(), m.max() + spacing, spacing) for m in (p, q))
    p, q = (m.ravel() for m in np.meshgrid(p, q))
    origins = np.outer(p, a) + np.outer(q, b) + depth * d
    lengths = phantom.path_lengths(shape, origins, np.broadcast_to(d, origins.shape))
    return lengths.sum() * spacing**2
