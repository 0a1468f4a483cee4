"""Stomach, duodenal bulb and liver: one generalized cylinder each for wall, lumen and organ.

The stomach's outline and place are estimates for a person standing, the J that a barium meal shows;
its wall is 2.0 mm in the body and 5.1 mm in the antrum (Pickhardt and Asher, AJR 181 (2003) 973).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.document import Cut, Point, Solid
from phantoms.parts import Outline, Station, layered, round_station, swept, within

FloatArray = NDArray[np.float64]

WALL, AIR, BARIUM, LIVER = "stomach wall", "air", "barium", "liver"
BODY_WALL: Final = 2.0 / 5.1
"""Thickness of the body's wall over that of the antrum."""

# A point of the axis, half the depth, and the reach toward the lesser and the greater curvature.
_STOMACH: Final = (
    ((64.0, 28.0, 151.5), 9.0, 10.0, 9.0),
    ((65.0, 28.0, 148.0), 24.0, 26.0, 24.0),
    ((66.5, 27.5, 141.0), 34.0, 35.0, 33.5),
    ((68.5, 26.0, 129.0), 41.0, 41.0, 40.5),
    ((70.0, 22.5, 112.0), 44.0, 43.5, 44.0),
    ((69.0, 15.0, 90.0), 42.5, 41.0, 43.0),
    ((65.5, 5.5, 66.0), 38.0, 35.0, 39.5),
    ((60.5, -5.5, 40.0), 33.0, 29.0, 35.0),
    ((55.0, -16.0, 15.0), 29.5, 24.0, 32.0),
    ((46.5, -24.5, -8.0), 28.0, 17.5, 31.0),
    ((32.5, -30.0, -25.0), 26.5, 13.5, 29.5),
    ((14.0, -32.5, -31.0), 25.0, 13.0, 28.0),
    ((-4.0, -31.0, -24.5), 22.5, 13.0, 25.5),
    ((-17.5, -27.0, -9.5), 18.5, 12.0, 19.5),
    ((-25.5, -22.5, 3.5), 16.5, 13.5, 16.5),
    ((-31.0, -18.5, 14.5), 13.0, 12.0, 12.5),
    ((-34.5, -15.5, 22.0), 8.0, 7.5, 7.5),
    ((-37.0, -13.5, 27.5), 4.8, 4.8, 4.8),
)
_ANTRUM: Final = 11
"""Station at which the antrum begins."""
_BEND_SHARE: Final = 0.82
"""How near to the centre of its bend the wall may come."""
_BEND: Final = 8
"""Station at which the bend begins."""
_WIDEST_MM: Final = 88.0
BULB: Final = (
    ((0.0, 0.0, 0.0), 3.0),
    ((-0.9, 0.5, 1.8), 5.0),
    ((-2.2, 1.5, 4.2), 12.5),
    ((-4.6, 3.8, 7.8), 13.0),
    ((-8.2, 7.8, 12.6), 9.5),
    ((-11.6, 12.0, 16.6), 6.4),
    ((-14.0, 15.0, 19.0), 4.0),
)
"""Places beyond the pylorus, and half the width there: a cap, widest at its base."""
# x from right to left, then z of the lower and upper face, y of the front and of the back.
_LIVER: Final = (
    (-122.0, 52.0, 72.0, -8.0, 12.0),
    (-119.0, 32.0, 92.0, -32.0, 34.0),
    (-112.0, 12.0, 116.0, -52.0, 50.0),
    (-99.0, -4.0, 140.0, -67.0, 62.0),
    (-82.0, 2.0, 154.0, -77.0, 68.0),
    (-66.0, 30.0, 157.0, -81.0, 66.0),
    (-51.0, 57.0, 155.0, -83.0, 58.0),
    (-35.0, 67.0, 150.0, -84.0, 42.0),
    (-14.0, 73.0, 142.0, -84.0, 8.0),
    (6.0, 80.0, 134.0, -83.0, -24.0),
    (24.0, 86.0, 126.0, -81.0, -40.0),
    (40.0, 93.0, 118.0, -78.0, -50.0),
    (48.0, 99.0, 111.0, -73.0, -58.0),
)
_SQUARE: Final = 0.82
_LIVER_OUTLINE: Final[Outline] = tuple(
    (
        math.copysign(abs(math.cos(angle)) ** _SQUARE, math.cos(angle)),
        math.copysign(abs(math.sin(angle)) ** _SQUARE, math.sin(angle)),
    )
    for angle in (math.pi * (index + 0.5) / 8 for index in range(16))
)
_LIVER_ANCHOR: Final = (-45.0, 0.0, 54.0)
"""Where the stomach ends under the liver, which grows and shrinks about this place."""


class Stomach:
    """The stomach of one person: where its sections are, and what lies in it."""

    def __init__(self, scale: float, axis_mm: float, lumen_mm: float, wall_mm: float) -> None:
        from scipy.interpolate import CubicSpline

        points = np.array([row[0] for row in _STOMACH])
        grown = axis_mm / _length(points)
        top = scale * points[0]
        girth = lumen_mm / _WIDEST_MM
        # A wide stomach keeps clear of the spine.
        spare = 44.0 * max(girth - scale, 0.0)
        top = top + np.array([spare, -0.6 * spare, 0.0])
        body = BODY_WALL * wall_mm
        self.walls = [
            body + (wall_mm - body) * min(max((index - _ANTRUM + 3) / 4, 0.0), 1.0)
            for index in range(len(_STOMACH))
        ]
        placed = top + grown * (points - points[0])
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(placed, axis=0), axis=1))])
        self._axis = CubicSpline(along / along[-1], placed)
        # On the inner side of the bend there is only so much room.
        room = np.full(len(points), np.inf)
        room[_BEND:] = (_BEND_SHARE * self._bend_mm(along / along[-1]) - np.array(self.walls))[
            _BEND:
        ]
        self.lumen = [
            Station(
                _point(at),
                (-girth * deep, girth * deep),
                (-max(min(girth * lesser, least), 4.0), girth * greater),
            )
            for at, least, (_, deep, lesser, greater) in zip(placed, room, _STOMACH, strict=True)
        ]
        reaches = np.array([(s.x[1], -s.b[0], s.b[1]) for s in self.lumen])
        self._reach = CubicSpline(along / along[-1], reaches)

    def _bend_mm(self, shares: FloatArray) -> FloatArray:
        """Return the least radius of the axis' bend about each place."""
        dense = np.linspace(0.0, 1.0, 400)
        first, second = self._axis(dense, 1), self._axis(dense, 2)
        speed = np.linalg.norm(first, axis=1)
        turn = np.linalg.norm(np.cross(first, second), axis=1) / speed**3
        near = np.abs(shares[:, None] - dense[None, :]) < 0.05
        least: FloatArray = 1.0 / np.where(near, turn[None, :], 0.0).max(axis=1)
        return least

    @property
    def outer(self) -> list[Station]:
        """The sections of the wall."""
        rows = []
        for index, (station, wall) in enumerate(zip(self.lumen, self.walls, strict=True)):
            at = np.array(station.at)
            if index == 0:
                at = at + wall * _unit(at - self.lumen[1].at)
            grown = wall if index > 0 else 0.6 * wall
            rows.append(
                Station(
                    _point(at),
                    (station.x[0] - grown, station.x[1] + grown),
                    (station.b[0] - grown, station.b[1] + grown),
                )
            )
        return rows

    @property
    def reaches(self) -> list[tuple[float, float]]:
        """Places (x, y) that the wall reaches at the back, and between back and side."""
        made = []
        for row in self.outer:
            x, y, _ = row.at
            made.append((x, y + row.x[1]))
            made.append((x + 0.75 * row.b[1], y + 0.75 * row.x[1]))
            made.append((x + row.b[1], y))
        return made

    @property
    def heights_mm(self) -> tuple[float, float]:
        """The lowest and the highest place of the lumen."""
        shares = np.linspace(0.0, 1.0, 200)
        low = math.inf
        for share in shares:
            at, _, toward = self.frame(float(share))
            low = min(low, float(at[2] + self._reach(share)[2] * toward[2]))
        return low, self.lumen[0].at[2]

    def frame(self, share: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return a place of the axis, the direction to the back and that to the greater curvature.

        ``share`` is of the axis, from the fundus to the pylorus.
        """
        at = np.asarray(self._axis(share), dtype=np.float64)
        along = _unit(np.asarray(self._axis(share, 1), dtype=np.float64))
        back = _unit(np.array([0.0, 1.0, 0.0]) - along[1] * along)
        return at, back, np.cross(along, back)

    def edge(self, share: float, curvature: str) -> tuple[FloatArray, FloatArray, float]:
        """Return a place of the lumen's edge, the direction outward there, the lumen's width."""
        at, back, greater = self.frame(share)
        deep, lesser, wide = (float(value) for value in self._reach(share))
        toward, reach, width = {
            "greater": (greater, wide, lesser + wide),
            "lesser": (-greater, lesser, lesser + wide),
            "back": (back, deep, 2 * deep),
            "front": (-back, deep, 2 * deep),
        }[curvature]
        return at + reach * toward, toward, width

    def on_wall(self, share: float, angle: float, inset_mm: float) -> FloatArray:
        """Return a place so far inside the lumen's edge, at an angle from the greater curvature.

        The angle, in radians, runs toward the back.
        """
        at, back, greater = self.frame(share)
        deep, lesser, wide = (float(value) for value in self._reach(share))
        across, behind = math.cos(angle), math.sin(angle)
        side = wide if across > 0 else lesser
        toward: FloatArray = (
            at + (side - inset_mm) * across * greater + (deep - inset_mm) * behind * back
        )
        return toward

    def solids(self, level_mm: float, coating_mm: float) -> list[Solid]:
        """Return wall, coat, air and barium, each to replace the one before."""
        up = (0.0, 1.0, 0.0)
        cut = Cut(point=(0.0, 0.0, level_mm), normal=(0.0, 0.0, 1.0))
        gas = within(self.lumen, coating_mm, closed=(True, False))
        solids: list[Solid] = [
            swept("wall", self.outer, WALL, up=up),
            swept("coat", self.lumen, BARIUM, up=up),
        ]
        if level_mm < self.heights_mm[1] - 1.0:
            solids.append(swept("air", gas, AIR, up=up))
            solids.append(swept("barium", self.lumen, BARIUM, up=up, cuts=(cut,)))
        return solids

    def bulb(self, scale: float, wall_mm: float) -> Solid:
        """Return the duodenal bulb beyond the pylorus, full of barium."""
        end = np.array(self.lumen[-1].at)
        rows = [
            round_station(_point(end + scale * np.array(at)), scale * half) for at, half in BULB
        ]
        wall = 0.5 * wall_mm
        outer = [
            Station(row.at, (row.x[0] - wall, row.x[1] + wall), (row.b[0] - wall, row.b[1] + wall))
            for row in rows
        ]
        up = (0.0, 1.0, 0.0)
        return layered(
            swept("bulb wall", outer, WALL, up=up), swept("bulb barium", rows, BARIUM, up=up)
        )


def liver(scale: float, volume_cm3: float) -> tuple[Solid, list[Station]]:
    """Return the liver and its sections; its axis runs from right to left."""
    rows = _liver_rows(scale, 1.0)
    rows = _liver_rows(scale, (volume_cm3 / _volume_cm3(rows)) ** (1 / 3))
    return swept("liver", rows, LIVER, _LIVER_OUTLINE, up=(0.0, 0.0, 1.0)), rows


def _liver_rows(scale: float, grown: float) -> list[Station]:
    """Return the sections of the liver, grown about its place over the pylorus."""
    anchor = np.array(_LIVER_ANCHOR)
    middle_y, middle_z = -10.0, 100.0
    rows = []
    for x, low, high, front, back in _LIVER:
        at = scale * anchor + grown * (np.array([x, middle_y, middle_z]) - anchor)
        # n is up, and b, square to x and z, is to the front.
        up = (grown * (low - middle_z), grown * (high - middle_z))
        rows.append(
            Station(_point(at), up, (grown * (middle_y - back), grown * (middle_y - front)))
        )
    return rows


def reaches(rows: Sequence[Station]) -> list[tuple[float, float]]:
    """Return places (x, y) that the liver reaches at its front and at its back."""
    return [(row.at[0], row.at[1] - b) for row in rows for b in row.b]


def _volume_cm3(rows: Sequence[Station]) -> float:
    """Return the volume of a straight sweep of the liver's outline."""
    from scipy.interpolate import CubicSpline

    x = np.array([row.at[0] for row in rows])
    wide = CubicSpline(x, [(row.x[1] - row.x[0]) / 2 for row in rows])
    deep = CubicSpline(x, [(row.b[1] - row.b[0]) / 2 for row in rows])
    dense = np.linspace(x[0], x[-1], 4001)
    points = np.array([*_LIVER_OUTLINE, _LIVER_OUTLINE[0]])
    chord = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    curve = CubicSpline(chord / chord[-1], points, bc_type="periodic")(np.linspace(0.0, 1.0, 4001))
    area = 0.5 * abs(float(np.sum(curve[:-1, 0] * curve[1:, 1] - curve[1:, 0] * curve[:-1, 1])))
    return area * float(np.trapezoid(wide(dense) * deep(dense), dense)) / 1000.0


def _length(points: FloatArray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _unit(vector: FloatArray) -> FloatArray:
    made: FloatArray = vector / np.linalg.norm(vector)
    return made


def _point(values: FloatArray) -> Point:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
