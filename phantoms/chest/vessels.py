"""The branching vessels of the lungs: trees of cones from the hila almost to the pleura.

Each branch splits in two whose radii follow Murray's law (the cubes add up), turned apart by about
60°, and is drawn toward the part of the lung that it serves. Where a vessel would leave the lung it
ends. The numbers come from a generator of their own, so that a seed is always the same tree.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from phantom.document import Cone, Solid
from phantoms.chest.cage import OUTLINE, Cage, FloatArray
from phantoms.chest.lungs import dome_rows, lung_rows
from phantoms.chest.mediastinum import heart_rows
from phantoms.chest.shapes import cone
from phantoms.parts import union

# Drawn on the left: where a segment's artery or vein leaves the hilum, its radius, and where the
# middle of what it serves is.
_LEFT: Final = (
    ((46.0, 12.0, 38.0), 3.0, (50.0, 22.0, 100.0)),
    ((50.0, 2.0, 36.0), 2.7, (66.0, -22.0, 84.0)),
    ((54.0, 14.0, 30.0), 2.7, (92.0, 34.0, 74.0)),
    ((48.0, -8.0, 22.0), 2.9, (72.0, -52.0, 36.0)),
    ((54.0, -4.0, 14.0), 2.6, (104.0, -24.0, 28.0)),
    ((52.0, 26.0, 4.0), 2.8, (98.0, 58.0, 22.0)),
    ((50.0, -2.0, -2.0), 2.7, (88.0, -52.0, -30.0)),
    ((57.0, 24.0, -20.0), 2.9, (114.0, 18.0, -46.0)),
    ((58.0, 28.0, -30.0), 3.2, (96.0, 40.0, -104.0)),
    ((58.0, 30.0, -30.0), 3.0, (56.0, 62.0, -110.0)),
    ((56.0, 22.0, -32.0), 2.9, (112.0, -2.0, -100.0)),
    ((40.0, 14.0, -18.0), 3.0, (66.0, 46.0, -70.0)),
    ((42.0, 10.0, -8.0), 2.6, (100.0, 8.0, -12.0)),
)
_RIGHT: Final = (
    ((-44.0, 8.0, 32.0), 3.0, (-50.0, 20.0, 100.0)),
    ((-46.0, 0.0, 30.0), 2.8, (-66.0, -24.0, 82.0)),
    ((-48.0, 10.0, 28.0), 2.7, (-92.0, 32.0, 70.0)),
    ((-46.0, -6.0, 16.0), 2.8, (-74.0, -48.0, 34.0)),
    ((-50.0, 4.0, 8.0), 2.6, (-106.0, -18.0, 22.0)),
    ((-52.0, 10.0, -6.0), 2.8, (-98.0, 56.0, 16.0)),
    ((-52.0, 2.0, -20.0), 2.7, (-86.0, -54.0, -38.0)),
    ((-55.0, 8.0, -28.0), 2.9, (-114.0, 10.0, -48.0)),
    ((-56.0, 10.0, -38.0), 3.2, (-98.0, 34.0, -96.0)),
    ((-54.0, 12.0, -38.0), 3.0, (-50.0, 60.0, -106.0)),
    ((-56.0, 6.0, -38.0), 2.8, (-110.0, -14.0, -84.0)),
    ((-36.0, 12.0, -22.0), 3.0, (-62.0, 44.0, -66.0)),
    ((-40.0, 8.0, -12.0), 2.6, (-102.0, 2.0, -16.0)),
)
DEPTH: Final = 4
BENT: Final = 2
"""Branches with so many or more branchings to come are two cones, so that they bend."""


_Piece = tuple[FloatArray, FloatArray, float, float]


class _Room:
    """Where vessels may run: in a lung, over the diaphragm, outside the heart."""

    def __init__(self, cage: Cage, side: str) -> None:
        lung = np.array(sorted(lung_rows(cage, side)))
        dome = np.array(sorted(dome_rows(cage, side)))
        heart = np.array(sorted(heart_rows(cage.frame)))
        self._tables = lung, dome, heart
        half = np.array([(x, y) for x, y in OUTLINE])
        order = np.argsort(np.arctan2(half[:, 1], half[:, 0] - 0.3))
        self._angles = np.arctan2(half[order, 1], half[order, 0] - 0.3)
        self._reach = np.hypot(half[order, 0] - 0.3, half[order, 1])
        self._sign = 1.0 if side == "left" else -1.0

    def holds(self, point: FloatArray, margin_mm: float) -> bool:
        """Tell whether a point is in the lung, so far from what bounds it."""
        lung, dome, heart = self._tables
        z = point[2]
        if not lung[0, 0] < z < lung[-1, 0] - margin_mm:
            return False
        low, high, front, back = (np.interp(z, lung[:, 0], lung[:, i]) for i in (1, 2, 3, 4))
        outer = max(abs(low), abs(high)) - margin_mm
        middle, depth = (front + back) / 2, (back - front) / 2 - margin_mm
        if outer < 4.0 or depth < 4.0:
            return False
        x, y = self._sign * point[0] / outer - 0.3, (point[1] - middle) / depth
        reach = np.interp(np.arctan2(y, x), self._angles, self._reach)
        if self._sign * point[0] < 12.0 or np.hypot(x, y) > reach - 0.02:
            return False
        for table in (dome, heart):
            if table[0, 0] - margin_mm < z < table[-1, 0] + margin_mm:
                low, high, front, back = (
                    np.interp(z, table[:, 0], table[:, i]) for i in (1, 2, 3, 4)
                )
                across = (point[0] - (low + high) / 2) / ((high - low) / 2 + margin_mm)
                along = (point[1] - (front + back) / 2) / ((back - front) / 2 + margin_mm)
                if across**2 + along**2 < 1.0:
                    return False
        return True


def _unit(vector: FloatArray) -> FloatArray:
    length: FloatArray = vector / np.linalg.norm(vector)
    return length


def _grow(
    room: _Room,
    at: FloatArray,
    heading: FloatArray,
    goal: FloatArray,
    radius: float,
    length: float,
    depth: int,
    draws: FloatArray,
    found: list[_Piece],
) -> None:
    """Add a branch and all that it splits into; ``draws`` are its numbers in [0, 1)."""
    own, rest = draws[:6], draws[6:]
    end_radius = 0.84 * radius
    steps = 2 if depth >= BENT else 1
    step = length / steps
    for part in range(steps):
        wander = 0.16 * (own[part : part + 3] - 0.5)
        heading = _unit(heading + 0.22 * _unit(goal - at + 1e-9) + wander)
        tip = at + step * heading
        if not room.holds(tip, 3.0 + 1.2 * radius):
            return
        share = (part + 1) / steps
        start = radius + (end_radius - radius) * part / steps
        found.append((at, tip, start, radius + (end_radius - radius) * share))
        at = tip
    if depth == 0:
        return
    axis = _unit(np.cross(heading, own[3:6] - 0.5 + 1e-6))
    first = 0.42 + 0.3 * own[1]
    radii = ((first) ** (1 / 3) * end_radius, (1 - first) ** (1 / 3) * end_radius)
    cut = len(rest) // 2
    for sign, size, numbers in ((1.0, radii[0], rest[:cut]), (-1.0, radii[1], rest[cut:])):
        turn = np.radians(30.0 + 14.0 * own[2]) * (1.35 - size / end_radius) * 2.0
        side = np.cross(axis, heading)
        new = _unit(np.cos(turn) * heading + sign * np.sin(turn) * side)
        spread = at + 60.0 * new if depth < 3 else goal + sign * 22.0 * side
        _grow(
            room, at, new, spread, size, length * (0.72 + 0.2 * own[0]), depth - 1, numbers, found
        )


def tree(cage: Cage, side: str, seed: int) -> Solid:
    """Return the vessels of a lung beyond its hilum."""
    f = cage.frame
    room = _Room(cage, side)
    table = _LEFT if side == "left" else _RIGHT
    code = 1 if side == "left" else 2
    draws = np.random.default_rng((seed, code)).random((len(table), 6 * (2 ** (DEPTH + 1) - 1)))
    found: list[_Piece] = []
    for (start, radius, goal), numbers in zip(table, draws, strict=True):
        at, to = np.array(f.at(*start)), np.array(f.at(*goal))
        length = 0.42 * float(np.linalg.norm(to - at))
        _grow(room, at, _unit(to - at), to, 1.4 * radius * f.bone, length, DEPTH, numbers, found)
    cones: list[Cone] = [
        cone(f"{side} lung vessel {i + 1}", _point(a), _point(b), (ra, rb), "blood")
        for i, (a, b, ra, rb) in enumerate(found)
    ]
    return union(*cones)


def _point(given: FloatArray) -> tuple[float, float, float]:
    return (float(given[0]), float(given[1]), float(given[2]))
