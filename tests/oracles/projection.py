"""Integrals of path lengths over a plane: the volume, seen from any direction."""

import numpy as np

import phantom
from tests.oracles.rays import unit

FINER = 8


def volume(shape, direction, box, rng, count=400_000, sharp=0.0):
    """Sum of L dA over a square lattice of parallel rays, turned and shifted at random.

    Path lengths start like a square root at silhouettes, where a lattice loses most: the share
    ``sharp`` of its cells, where lengths bend most, is cut into many. ``box`` (2, 3) holds the
    solid.
    """
    d = unit(np.asarray(direction, dtype=float))
    a = unit(np.cross(d, rng.standard_normal(3)))
    b = np.cross(d, a)
    x, y, z = np.array(box, dtype=float).T
    corners = np.array([(i, j, k) for i in x for j in y for k in z])
    p, q, depth = corners @ a, corners @ b, (corners @ d).min() - 10.0
    spacing = np.sqrt(np.ptp(p) * np.ptp(q) / count)
    # Two cells of margin, so that every silhouette has cells on both sides.
    p, q = (
        np.arange(m.min() - spacing * (2 + rng.random()), m.max() + 2 * spacing, spacing)
        for m in (p, q)
    )
    p, q = np.meshgrid(p, q, indexing="ij")

    def trace(p, q):
        origins = np.outer(p, a) + np.outer(q, b) + depth * d
        lengths = phantom.path_lengths(shape, origins, np.broadcast_to(d, origins.shape))
        return lengths.sum(axis=1)

    lengths = trace(p.ravel(), q.ravel()).reshape(p.shape)
    if sharp == 0:
        return lengths.sum() * spacing**2
    along_p, along_q = np.zeros_like(lengths), np.zeros_like(lengths)
    along_p[1:-1] = np.diff(lengths, 2, axis=0)
    along_q[:, 1:-1] = np.diff(lengths, 2, axis=1)
    bend = np.abs(along_p) + np.abs(along_q)
    chosen = bend >= np.quantile(bend, 1 - sharp)
    # Elsewhere: the mean over a cell of what bends in it.
    smooth = lengths + (along_p + along_q) / 24
    inner = ((np.arange(FINER) + 0.5) / FINER - 0.5) * spacing
    shift_p, shift_q = (m.ravel() for m in np.meshgrid(inner, inner))
    finer = trace((p[chosen][:, None] + shift_p).ravel(), (q[chosen][:, None] + shift_q).ravel())
    return (smooth[~chosen].sum() + finer.sum() / FINER**2) * spacing**2
