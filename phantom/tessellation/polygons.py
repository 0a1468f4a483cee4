"""Flat polygons with holes as triangles between their own corners.

Ears are cut off one by one, the best shaped first; holes are first joined to the outline around
them by a bridge (D. Eberly, *Triangulation by Ear Clipping*, Geometric Tools, 2002). No corner is
added, so that what the polygon closes stays watertight.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.vectors import plane_cross

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def triangulated(points: Floats, loops: Sequence[Ints]) -> tuple[Ints, bool]:
    """Fill loops of points with triangles.

    Parameters
    ----------
    points
        ``(P, 2)``.
    loops
        Rows of points: outlines run anticlockwise, holes clockwise; no two loops cross.

    Returns
    -------
    Triangles ``(T, 3)``, anticlockwise, and whether the loops were simple. Where they cross, as a
    coarse outline may cross itself, triangles still fill every loop to its edges, and overlap.
    """
    areas = [_area(points[loop]) for loop in loops]
    outlines = [loop for loop, area in zip(loops, areas, strict=True) if area >= 0]
    holes = [loop for loop, area in zip(loops, areas, strict=True) if area < 0]
    inside: list[list[Ints]] = [[] for _ in outlines]
    simple = True
    for hole in holes:
        home = _home(points, hole, outlines)
        if home is None:
            outlines.append(hole)
            inside.append([])
            simple = False
        else:
            inside[home].append(hole)
    found = []
    for outline, within in zip(outlines, inside, strict=True):
        triangles, sound = _ears(points, _bridged(points, outline, within))
        found.append(triangles)
        simple &= sound
    return np.concatenate(found or [np.zeros((0, 3), dtype=np.int64)]), simple


def _area(polygon: Floats) -> float:
    """Twice the area, positive anticlockwise."""
    shifted = polygon - polygon[0]
    return float(plane_cross(shifted, np.roll(shifted, -1, axis=0)).sum())


def _home(points: Floats, hole: Ints, outlines: Sequence[Ints]) -> int | None:
    """Return the smallest outline that holds a hole."""
    best, least = None, np.inf
    for index, outline in enumerate(outlines):
        area = _area(points[outline])
        if 0 < area < least and _holds(points[outline], points[hole]):
            best, least = index, area
    return best


def _holds(polygon: Floats, inner: Floats) -> bool:
    """Tell whether a polygon holds most corners of another (one may touch it)."""
    after = np.roll(polygon, -1, axis=0)
    some = inner[:: max(1, len(inner) // 9)]
    above = (polygon[:, 1] > some[:, None, 1]) != (after[:, 1] > some[:, None, 1])
    rise = after[:, 1] - polygon[:, 1]
    share = (some[:, None, 1] - polygon[:, 1]) / np.where(rise != 0, rise, 1.0)
    right = polygon[:, 0] + share * (after[:, 0] - polygon[:, 0]) > some[:, None, 0]
    return bool(np.mean(np.count_nonzero(above & right, axis=1) % 2) > 0.5)


def _bridged(points: Floats, outline: Ints, holes: Sequence[Ints]) -> Ints:
    """Return an outline with its holes joined to it, each by an edge there and back."""
    ring = outline
    for hole in sorted(holes, key=lambda hole: -float(points[hole, 0].max())):
        start = int(np.argmax(points[hole, 0]))
        at = _visible(points, ring, points[hole[start]])
        turned = np.roll(hole, -start)
        ring = np.concatenate([ring[: at + 1], turned, turned[:1], ring[at:]])
    return ring


def _visible(points: Floats, ring: Ints, eye: Floats) -> int:
    """Return the place in a ring of a corner that a point sees, looking along +x first."""
    a, b = points[ring], points[np.roll(ring, -1)]
    crosses = (a[:, 1] <= eye[1]) & (b[:, 1] > eye[1])
    rise = np.where(crosses, b[:, 1] - a[:, 1], 1.0)
    x = a[:, 0] + (eye[1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    x = np.where(crosses & (x >= eye[0]), x, np.inf)
    edge = int(np.argmin(x))
    if not np.isfinite(x[edge]):
        # Nothing lies to the right: the nearest corner is the best there is.
        return int(np.argmin(np.linalg.norm(a - eye, axis=1)))
    hit = np.array([x[edge], eye[1]])
    ends = (edge, (edge + 1) % len(ring))
    chosen = max(ends, key=lambda k: points[ring[k], 0])
    corner = points[ring[chosen]]
    triangle = (eye, hit, corner) if corner[1] >= eye[1] else (eye, corner, hit)
    inside = np.ones(len(ring), dtype=np.bool_)
    for one, two in zip(triangle, (*triangle[1:], triangle[0]), strict=True):
        inside &= plane_cross(two - one, a - one) >= 0
    inside &= (a[:, 0] >= eye[0]) & (a[:, 0] <= corner[0])
    inside &= np.any(a != corner, axis=1) & np.any(a != eye, axis=1)
    before, after = points[np.roll(ring, 1)], b
    inside &= plane_cross(a - before, after - a) <= 0  # only reflex corners can be in the way
    if inside.any():
        rows = np.flatnonzero(inside)
        way = a[rows] - eye
        slope = np.abs(way[:, 1]) / np.maximum(np.linalg.norm(way, axis=1), 1e-300)
        chosen = int(rows[np.lexsort((np.linalg.norm(way, axis=1), slope))[0]])
        corner = points[ring[chosen]]
    # Of corners in one place, as bridges leave them, the one whose inside looks this way.
    same = np.flatnonzero(np.all(a == corner, axis=1))
    for k in same:
        if _looks(before[k], a[k], after[k], eye):
            return int(k)
    return chosen


def _looks(before: Floats, at: Floats, after: Floats, eye: Floats) -> bool:
    """Tell whether a direction lies within a corner's inside."""
    way, into, out = eye - at, at - before, after - at
    left, right = plane_cross(out, way) > 0, plane_cross(into, way) > 0
    return bool(left and right) if plane_cross(into, out) >= 0 else bool(left or right)


def _ears(points: Floats, ring: Ints) -> tuple[Ints, bool]:
    """Cut the ears off a ring; say whether each was a proper one."""
    count = len(ring)
    at = points[ring]
    before, after = np.roll(np.arange(count), 1), np.roll(np.arange(count), -1)
    turn, shape = _corner(at, before, np.arange(count), after)
    alive, blocked = np.ones(count, dtype=np.bool_), np.zeros(count, dtype=np.bool_)
    triangles = np.empty((max(count - 2, 0), 3), dtype=np.int64)
    _, which, uses = np.unique(ring, return_inverse=True, return_counts=True)
    repeated = np.flatnonzero(uses[which] > 1)
    sound = True
    for done in range(count - 2):
        twins = repeated[alive[repeated]]
        while True:
            worth = np.where(alive & ~blocked & (turn > 0), shape, -np.inf)
            ear = int(np.argmax(worth))
            if worth[ear] == -np.inf:
                if blocked.any():
                    # What was in the way may be gone; if nothing is, the ring crosses itself.
                    again = blocked & alive & (turn > 0)
                    blocked[:] = False
                    free = [
                        k
                        for k in np.flatnonzero(again).tolist()
                        if _free(at, before, k, after, turn, twins)
                    ]
                    if free:
                        ear = max(free, key=lambda k: float(shape[k]))
                        break
                ear = int(np.argmax(np.where(alive, shape, -np.inf)))
                # All that is left may lie on one line, which rounding brings about.
                sound &= bool(np.abs(shape[alive]).max() < 1e-9)
                break
            if _free(at, before, ear, after, turn, twins):
                break
            blocked[ear] = True
        one, two = before[ear], after[ear]
        triangles[done] = ring[one], ring[ear], ring[two]
        alive[ear] = False
        turn[ear] = 1.0  # no longer in the way of others
        after[one], before[two] = two, one
        pair = np.array([one, two])
        turn[pair], shape[pair] = _corner(at, before[pair], pair, after[pair])
        blocked[pair] = False
    return triangles, sound


def _corner(at: Floats, before: Ints, here: Ints, after: Ints) -> tuple[Floats, Floats]:
    """Return twice the area at corners, and how far their ears are from slivers."""
    a, b, c = at[before], at[here], at[after]
    turn = plane_cross(b - a, c - b)
    longest = np.maximum(((b - a) ** 2).sum(axis=-1), ((c - b) ** 2).sum(axis=-1))
    longest = np.maximum(longest, ((a - c) ** 2).sum(axis=-1))
    shape = turn / np.where(longest > 0, longest, 1.0)
    return np.where(shape > 1e-12, turn, np.minimum(turn, 0.0)), shape


def _free(at: Floats, before: Ints, ear: int, after: Ints, turn: Floats, twins: Ints) -> bool:
    """Tell whether no other corner lies within an ear.

    Of corners in the same place as one of the ear's, as bridges leave them, no edge may lead in.
    """
    triangle = at[[before[ear], ear, after[ear]]]
    a, b, c = triangle
    others = at[np.flatnonzero(turn <= 0)]
    inside = plane_cross(b - a, others - a) >= 0
    inside &= plane_cross(c - b, others - b) >= 0
    inside &= plane_cross(a - c, others - c) >= 0
    found = others[inside]
    same = np.all(found[:, None] == triangle, axis=2).any(axis=1)
    if not same.all():
        return False
    for k in range(3):
        here, left, right = triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]
        rows = twins[np.all(at[twins] == here, axis=1)]
        for ends in (before[rows], after[rows]):
            way = at[ends] - here
            leads = (plane_cross(left - here, way) > 0) & (plane_cross(way, right - here) > 0)
            if leads.any():
                return False
    return True
