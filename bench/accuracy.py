"""How far an image is from the exact answer, and what the exact answer is.

The engine is held against the tests' slow twin, which reads the document pointwise and closes in by
bisection, on pixels drawn at random. Other programs are held against the engine on every pixel,
since what they lose are isolated rays.
"""

import numpy as np

from bench.scenes import rays
from tests.oracles.naive import Twin

SURFACE_MM = 1e-8
REACH_MM = 120.0
SAMPLES = 700


def implied_displacement_mm(tree, view, path_lengths, count, rng):
    """Return the greatest err * c / 4R over ``count`` random pixels that meet something.

    R is the reach of the scene, c the shortest step of the ray from one surface to the next: a
    surface that is displaced by e moves the ends of a chord, or gap, of length c by about 4Re/c.
    """
    hit = np.flatnonzero(path_lengths.reshape(-1, path_lengths.shape[-1]).any(axis=1))
    chosen = np.sort(rng.choice(hit, count, replace=False))
    origins, directions = (a[chosen] for a in rays(view))
    far = np.linalg.norm(np.asarray(view.source))
    span = (far - 1.5 * REACH_MM, far + 1.5 * REACH_MM)
    twin = Twin(tree)
    found = path_lengths.reshape(-1, path_lengths.shape[-1])[chosen]
    worst = 0.0
    for mine, steps in zip(found, twin.chords(origins, directions, span, SAMPLES), strict=True):
        truth = sum((exit_ - entry) * (left @ twin.channel) for entry, exit_, left in steps)
        ends = np.unique([w for entry, exit_, _ in steps for w in (entry, exit_)])
        shortest = np.diff(ends)[np.diff(ends) > 1e-9].min(initial=4 * REACH_MM)
        chord = max(shortest, np.sqrt(8 * REACH_MM * SURFACE_MM))
        worst = max(worst, np.abs(mine - truth).max() * min(chord / (4 * REACH_MM), 1.0))
    return float(worst)


def chord_errors_mm(image, exact):
    """Return the median where something is met, the 99.9th percentile and the greatest error."""
    error = np.abs(image - exact)
    return float(np.median(error[exact > 0])), float(np.quantile(error, 0.999)), float(error.max())
