"""The surface on which the ribs lie, and the ribs' lines on it.

At every height the middle of the chest's wall is one outline, stretched to the chest's half-width
and depth there; the ribs' axes are curves on that surface, and the lungs fill it to within a wall's
thickness, so that no rib ever runs through a lung. Of each rib the heights of its head and of its
front end are drawn; between them it sinks partly with the way forward, as if it lay in a plane,
and partly with the way around. All is drawn on the left; the right is its mirror image, each rib
turned a little about its head.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from phantom.document import Point, Rotation
from phantoms.chest.frame import Frame
from phantoms.chest.sides import Sides
from phantoms.chest.spine import spine_y

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline, PchipInterpolator

FloatArray = NDArray[np.float64]

# The left half of the outline from the spine round to the breastbone; it fills [-1, 1]².
OUTLINE: Final = (
    (0.0, 0.42),
    (0.12, 0.48),
    (0.24, 0.70),
    (0.36, 0.91),
    (0.50, 1.0),
    (0.68, 0.935),
    (0.85, 0.70),
    (0.96, 0.36),
    (1.0, 0.0),
    (0.97, -0.33),
    (0.87, -0.62),
    (0.70, -0.83),
    (0.48, -0.955),
    (0.25, -0.995),
    (0.0, -1.0),
)
# z, half-width, front and back of the surface of the ribs' middles, in the drawn man.
_WALL: Final = (
    (-230.0, 116.0, -90.0, 54.0),
    (-200.0, 124.0, -92.0, 62.0),
    (-170.0, 131.0, -94.0, 68.0),
    (-140.0, 137.0, -96.0, 76.0),
    (-100.0, 140.0, -97.0, 84.0),
    (-60.0, 140.6, -96.0, 88.5),
    (-20.0, 137.5, -88.0, 90.5),
    (20.0, 131.5, -74.5, 90.0),
    (50.0, 122.5, -62.0, 87.0),
    (75.0, 109.5, -45.0, 79.5),
    (95.0, 92.0, -24.0, 70.0),
    (108.0, 74.0, -5.0, 60.5),
    (118.0, 54.0, 12.0, 52.0),
    (126.0, 28.0, 24.0, 44.0),
)
# Where the front end of a rib is: its distance from the middle and its height, drawn.
_FRONT_ENDS: Final = {
    2: (56.0, 46.0),
    3: (66.0, 18.0),
    4: (75.0, -9.0),
    5: (87.0, -36.0),
    6: (97.0, -64.0),
    7: (103.0, -94.0),
    8: (112.0, -119.0),
    9: (120.0, -140.0),
    10: (127.0, -157.0),
}
_HEADS: Final = {
    1: 124.0, 2: 113.5, 3: 95.5, 4: 75.5, 5: 55.0, 6: 34.0, 7: 11.5, 8: -12.0, 9: -37.0,
    10: -66.0, 11: -97.0, 12: -127.0,
}  # fmt: skip
# The first rib is drawn by points: it lies flat over the apex.
_FIRST: Final = (
    (19.0, 38.0, 125.0),
    (31.0, 45.0, 126.0),
    (45.0, 46.0, 124.0),
    (58.0, 35.0, 118.5),
    (66.0, 17.0, 110.5),
    (66.0, -3.0, 99.5),
    (58.0, -24.0, 90.5),
    (45.0, -40.0, 83.5),
    (34.0, -47.0, 80.0),
)
# Of the ribs that end free: the part of the outline they reach, and how far they sink.
_FREE: Final = {11: (0.52, 62.0), 12: (0.30, 38.0)}
_HEAD: Final = (19.5, 8.5, 0.0)
_NECK: Final = (33.5, 18.5, 0.5)
"""From the middle of the spine at a rib's height: its head, and where it passes a transverse
process."""
ON_WALL_X_MM: Final = 51.0
"""From the middle to where a rib comes on to the surface of the wall."""


class RibLine(NamedTuple):
    """The axis of a rib: points ``(N, 3)`` from its head on, and the wall's normals there."""

    points: FloatArray
    normals: FloatArray


@dataclass(frozen=True)
class Cage:
    """The ribs' surface of one person, in mm of the body."""

    frame: Frame
    sides: Sides

    def turn(self, number: int) -> Rotation:
        """Return what turns the mirror image of a left rib into the right one."""
        return self.sides.rib(number, self._rib_head(number))

    @cached_property
    def outline(self) -> CubicSpline:
        """The closed outline over its own parameter: 0 at the spine, 0.5 at the breastbone."""
        from scipy.interpolate import CubicSpline

        right = [(-x, y) for x, y in OUTLINE[-2:0:-1]]
        points = np.array([*OUTLINE, *right, OUTLINE[0]])
        at = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        return CubicSpline(at / at[-1], points, bc_type="periodic")

    @cached_property
    def _wall(self) -> PchipInterpolator:
        from scipy.interpolate import PchipInterpolator

        table = np.array(sorted(_WALL))
        return PchipInterpolator(table[:, 0], table[:, 1:], extrapolate=True)

    def section(self, z_mm: float) -> tuple[float, float, float]:
        """Return half-width, front and back (y) of the ribs' surface at a height of the body."""
        half, front, back = self._wall(z_mm / self.frame.z)
        lean = self.frame.lean(z_mm)
        return (
            float(half) * self.frame.x,
            float(front) * self.frame.y + lean,
            float(back) * self.frame.y + lean,
        )

    def point(self, turn: float, z_mm: float) -> FloatArray:
        """Return the point of the surface at a place of the outline and a height."""
        half, front, back = self.section(z_mm)
        x, y = self.outline(turn)
        return np.array([half * x, (back + front) / 2 + (back - front) / 2 * y, z_mm])

    def normal(self, turn: float, z_mm: float) -> FloatArray:
        """Return the surface's outward unit normal there."""
        step, rise = 1e-4, 0.5
        around = self.point(turn + step, z_mm) - self.point(turn - step, z_mm)
        up = self.point(turn, z_mm + rise) - self.point(turn, z_mm - rise)
        across = np.cross(up, around)
        unit: FloatArray = across / np.linalg.norm(across)
        return unit

    def turn_at(self, x_mm: float, z_mm: float, *, front: bool) -> float:
        """Return where the outline is so far from the middle, behind its widest or before it."""
        half = self.section(z_mm)[0]
        turns = np.linspace(0.0, 0.5, 2001)
        reach = self.outline(turns)[:, 0] * half
        widest = int(np.argmax(reach))
        side = slice(widest, None) if front else slice(0, widest + 1)
        return float(turns[side][np.argmin(np.abs(reach[side] - x_mm))])

    def rib(self, number: int) -> RibLine:
        """Return the line of a left rib, 1 to 12."""
        if number == 1:
            return self._first()
        height = _HEADS[number] * self.frame.z
        start = self.turn_at(ON_WALL_X_MM * self.frame.x, height, front=False)
        if number in _FREE:
            share, drop = _FREE[number]
            end, drop = start + share * (0.5 - start), drop * self.frame.z
        else:
            end_x, end_z = _FRONT_ENDS[number]
            end_z *= self.frame.z
            end, drop = self.turn_at(end_x * self.frame.x, end_z, front=True), height - end_z
        turns = np.linspace(start, end, 9)
        way = (turns - start) / (end - start)
        if number in _FREE:
            sunk = 0.25 * way + 0.75 * way**1.6
        else:
            y = self.outline(turns)[:, 1]
            forward = (y[0] - y) / (y[0] - y[-1])
            sunk = 0.5 * forward + 0.5 * way**1.15
        heights = height - drop * sunk
        points = [self.point(t, h) for t, h in zip(turns, heights, strict=True)]
        normals = [self.normal(t, h) for t, h in zip(turns, heights, strict=True)]
        ends = [np.array(self._by_spine(number, place)) for place in (_HEAD, _NECK)]
        return RibLine(np.array([*ends, *points]), np.array([normals[0], normals[0], *normals]))

    def _by_spine(self, number: int, place: Point) -> Point:
        """Return a point given from the middle of the spine at the height of a rib's head."""
        z = _HEADS[number]
        x, y, up = (
            m + self.frame.bone * by
            for m, by in zip(self.frame.at(0.0, spine_y(z), z), place, strict=True)
        )
        return (x, y, up)

    def _rib_head(self, number: int) -> Point:
        return self.frame.at(*_FIRST[0]) if number == 1 else self._by_spine(number, _HEAD)

    def _first(self) -> RibLine:
        points = np.array(self.frame.path(_FIRST))
        middle = np.array([0.0, points[:, 1].mean(), 0.0])
        outward = (points - middle) * [1.0, 1.0, 0.0]
        outward /= np.linalg.norm(outward, axis=1)[:, None]
        normals = 0.35 * outward + [0.0, 0.0, 0.94]
        return RibLine(points, normals / np.linalg.norm(normals, axis=1)[:, None])
