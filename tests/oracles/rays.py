"""Random rays with a seed."""

import numpy as np


def unit(vectors):
    """Scale to length 1."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def through_ball(rng, count, radius, center=(0.0, 0.0, 0.0)):
    """Isotropic random lines that meet a ball, uniform over the lines; origins lie outside it."""
    directions = unit(rng.standard_normal((count, 3)))
    a = unit(np.cross(directions, unit(rng.standard_normal((count, 3)))))
    b = np.cross(directions, a)
    rho = radius * np.sqrt(rng.random(count))
    angle = rng.uniform(0, 2 * np.pi, count)
    offset = rho[:, None] * (np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * b)
    return np.asarray(center) + offset - 3 * radius * directions, directions
