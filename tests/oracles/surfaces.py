"""Normals from points alone: where a solid begins along rays beside a ray, by bisection."""

import numpy as np

STEP_MM = 0.02
HALVINGS = 44


def normals(present, points, directions, reach=0.3):
    """(N, 3) unit normals against the rays, and which points lie well within a smooth face.

    ``present`` tells of points whether they are in the solid; it changes at each of ``points``
    along its direction. Along rays moved by one and two steps to either side, the place of the
    change is found within ``reach``; its derivatives are central differences of fourth order.
    """
    one = np.cross(directions, np.where(np.abs(directions[:, :1]) < 0.7, [1, 0, 0], [0, 1, 0]))
    one /= np.linalg.norm(one, axis=1)[:, None]
    two = np.cross(directions, one)
    smooth = np.ones(len(points), dtype=bool)
    slopes = []
    for axis in (one, two):
        found = {}
        for k in (-2, -1, 0, 1, 2):
            found[k], sound = _change(present, points + k * STEP_MM * axis, directions, reach)
            smooth &= sound
        slopes.append((8 * (found[1] - found[-1]) - (found[2] - found[-2])) / (12 * STEP_MM))
        # Where an edge is near, the two steps tell of two faces.
        wide = (found[2] - found[-2]) / (4 * STEP_MM)
        bend = np.abs(found[1] + found[-1] - 2 * found[0]) / STEP_MM
        smooth &= (np.abs(wide - slopes[-1]) < 2e-3) & (bend < 0.03)
    tangents = [axis + s[:, None] * directions for axis, s in zip((one, two), slopes, strict=True)]
    normal = np.cross(*tangents)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return normal * -np.sign((normal * directions).sum(axis=1))[:, None], smooth


def _change(present, points, directions, reach):
    low, high = np.full(len(points), -reach), np.full(len(points), reach)
    first, last = (present(points + w[:, None] * directions) for w in (low, high))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = present(points + middle[:, None] * directions) == first
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high), first != last
