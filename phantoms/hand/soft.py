"""The hand's soft tissue: skin, the fat under it, and the rest, each within the one before.

Fingers are tapered tubes along their bones with round tips; the palm, the webs between the fingers,
and the web between thumb and palm join them. Thicknesses are estimates.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from phantom.document import Point, Solid, Vector
from phantoms.hand.forearm import END_Z_MM
from phantoms.hand.frames import FloatArray, Frame
from phantoms.hand.rows import Row, times, upright
from phantoms.hand.sizes import DIGITS
from phantoms.inside import inside
from phantoms.parts import ROUND, Outline, Station, ellipsoid, layered, swept, union, within

SKIN, FAT, SOFT = "skin", "fat", "soft tissue"
SKIN_MM: Final = 1.2
TIP_MM: Final = {"thumb": 5.7, "index": 3.8, "middle": 4.0, "ring": 4.0, "little": 3.7}
"""Soft tissue beyond the bone of each fingertip (Buryanov and Kotiuk 2010)."""

# Half-width and half-depth at: middle of the metacarpal, its head, middle of the proximal phalanx,
# PIP joint, middle of the middle phalanx, DIP joint, tuft; for the thumb at the wrist, the middle
# of the metacarpal, its head, middle of the proximal phalanx, IP joint, tuft.
_TUBES: Final[dict[str, tuple[tuple[float, float], ...]]] = {
    "thumb": ((9.5, 9.5), (14.8, 12.5), (12.2, 11.2), (11.0, 9.8), (10.9, 9.0), (9.6, 7.0)),
    "index": (
        (6.0, 6.5), (10.8, 11.4), (10.0, 9.8), (9.7, 8.9), (8.7, 7.9), (8.4, 7.1), (7.3, 5.7),
    ),
    "middle": (
        (6.0, 6.5), (11.0, 11.6), (10.2, 10.0), (9.9, 9.1), (8.9, 8.1), (8.6, 7.2), (7.5, 5.8),
    ),
    "ring": (
        (6.0, 6.5), (10.4, 11.2), (9.7, 9.6), (9.4, 8.7), (8.4, 7.7), (8.1, 6.9), (7.1, 5.6),
    ),
    "little": (
        (6.0, 6.0), (9.6, 10.4), (8.7, 8.6), (8.3, 7.7), (7.4, 6.8), (7.2, 6.1), (6.3, 5.0),
    ),
}  # fmt: skip
_PALM: Final[tuple[Row, ...]] = (
    (END_Z_MM, -33.0, 27.0, -25.0, 20.5),
    (-86.0, -30.4, 26.0, -20.9, 17.0),
    (-55.0, -30.6, 28.4, -19.0, 15.2),
    (-30.0, -33.6, 31.4, -19.8, 14.2),
    (-4.0, -39.4, 33.8, -19.8, 13.4),
    (24.0, -43.4, 32.6, -18.0, 12.2),
    (46.0, -42.6, 33.4, -15.4, 10.4),
    (60.0, -36.0, 33.0, -13.0, 8.6),
    (70.0, -22.0, 28.0, -10.0, 5.6),
)
_SQUARE: Final[Outline] = tuple(
    (
        math.copysign(abs(math.cos(angle)) ** 0.72, math.cos(angle)),
        math.copysign(abs(math.sin(angle)) ** 0.72, math.sin(angle)),
    )
    for angle in (math.pi * (index + 0.5) / 8 for index in range(16))
)
"""The palm's sections are squarer than ellipses."""

# The web between thumb and palm hangs between them like a hammock: the line of its sections'
# middles, half their thickness, and how far they reach to the wrist and to the free edge.
_THUMB_WEB: Final = (
    ((24.0, -5.0, 51.0), 6.5, 9.0, 3.5),
    ((30.0, -7.5, 36.0), 8.0, 16.0, 4.0),
    ((39.5, -12.0, 25.5), 8.6, 20.0, 4.0),
    ((52.0, -18.0, 22.0), 9.0, 16.0, 4.0),
)
# The webs between the fingers: place along both proximal phalanges, and semi-axes.
_WEBS: Final = {
    "index": (0.16, (8.5, 8.0, 11.5)),
    "middle": (0.16, (8.0, 8.0, 11.5)),
    "ring": (0.14, (8.5, 7.6, 11.0)),
}


_MIDDLE: Final = (0.0, 0.0, 0.0)
_LEAST_MM: Final = 0.3
"""Half-width of what is left where the layers outside it are thicker than the finger."""


class Ball(NamedTuple):
    """An ellipsoid about the origin of a frame: a fingertip, or the web beside a finger."""

    frame: Frame
    semi_axes: Point

    def within(self, depth_mm: float) -> Point:
        """Return the semi-axes of what lies that deep inside."""
        a, b, c = (max(axis - depth_mm, _LEAST_MM) for axis in self.semi_axes)
        return (a, b, c)

    def holds(self, point: FloatArray, margin_mm: float) -> bool:
        """Whether a point lies inside, that far from the surface."""
        away = np.array(self.frame.local(point))
        return bool(np.linalg.norm(away / self.within(margin_mm)) < 1.0)


class Skin(NamedTuple):
    """The surface of the hand: swept parts by their sections, and balls, each by name."""

    tubes: Mapping[str, Sequence[Station]]
    balls: Mapping[str, Ball]

    def holds(self, point: FloatArray) -> bool:
        """Whether a point is under the skin, as seen from the sections it lies between."""
        return any(
            inside(stations, point, SKIN_MM, _up(name)) for name, stations in self.tubes.items()
        ) or any(ball.holds(point, SKIN_MM) for ball in self.balls.values())


def skin(scale: float, frames: Mapping[str, Sequence[Frame]], ends_mm: Mapping[str, float]) -> Skin:
    """Return the surface of the hand.

    Parameters
    ----------
    scale
        Of the hand.
    frames
        Of the bones of each ray.
    ends_mm
        Length of each ray's distal phalanx.
    """
    tubes = {digit: _tube(digit, scale, frames[digit], ends_mm[digit]) for digit in frames}
    tubes["palm"] = upright(_PALM, scale)
    tubes["thumb web"] = [
        Station(
            times(at, scale), (-scale * thick, scale * thick), (-scale * inward, scale * outward)
        )
        for at, thick, inward, outward in _THUMB_WEB
    ]
    balls = {f"{digit} tip": _tip(digit, scale, frames[digit], ends_mm[digit]) for digit in frames}
    for one, two in pairwise(DIGITS[1:]):
        balls[f"{one} web"] = _web(one, scale, frames[one], frames[two])
    return Skin(tubes, balls)


def envelope(outer: Skin, fat_mm: float) -> Solid:
    """Return the soft tissue, outermost first, within the skin."""
    layers = []
    for material, depth in ((SKIN, 0.0), (FAT, SKIN_MM), (SOFT, SKIN_MM + fat_mm)):
        swept_parts: list[Solid] = [
            swept(
                f"{name} {material}",
                _inside(stations, depth, closed=name == "palm"),
                material,
                _SQUARE if name == "palm" else ROUND,
                up=_up(name),
            )
            for name, stations in outer.tubes.items()
        ]
        balls: list[Solid] = [
            ball.frame.placed(
                None,
                ellipsoid(f"{name} {material}", _MIDDLE, ball.within(depth), material),
            )
            for name, ball in outer.balls.items()
        ]
        layers.append(union(*swept_parts, *balls))
    return layered(*layers)


def _inside(stations: Sequence[Station], depth_mm: float, closed: bool) -> Sequence[Station]:
    if depth_mm == 0.0:
        return stations
    count = min(len(stations), max(6, len(stations) - 1))
    return within(stations, depth_mm, closed=(False, closed), least_mm=_LEAST_MM, count=count)


def _tube(digit: str, scale: float, frames: Sequence[Frame], end_mm: float) -> list[Station]:
    """Return the sections of a finger, from the middle of its metacarpal to its tuft."""
    last = len(frames) - 1
    points = [0.5 * (frames[0].origin + frames[1].origin)]
    if digit == "thumb":
        points.insert(0, frames[0].point(times((-4.5, -0.5, -20.0), scale)))
    for index in range(1, last):
        points += [frames[index].origin, 0.5 * (frames[index].origin + frames[index + 1].origin)]
    points += [frames[last].origin, frames[last].point((0.0, 0.0, _TUFT * end_mm))]
    down = _down(scale)
    return [
        _round(tuple(point + down), scale * wide, scale * deep)
        for point, (wide, deep) in zip(points, _TUBES[digit], strict=True)
    ]


_TUFT: Final = 0.72
"""Where the round tip of a finger begins, as a share of the distal phalanx."""


def _tip(digit: str, scale: float, frames: Sequence[Frame], end_mm: float) -> Ball:
    """Return the round end of a finger; its sections lie as those of the tube before it."""
    along = frames[-1].axes[:, 2]
    across = np.array(_up(digit)) - along[0] * along
    across /= np.linalg.norm(across)
    axes = np.column_stack([across, np.cross(along, across), along])
    wide, deep = _TUBES[digit][-1]
    center = frames[-1].point((0.0, 0.0, _TUFT * end_mm)) + _down(scale)
    reach = (1.0 - _TUFT) * end_mm + scale * TIP_MM[digit]
    return Ball(Frame(center, axes), (scale * wide, scale * deep, reach))


def _web(digit: str, scale: float, one: Sequence[Frame], two: Sequence[Frame]) -> Ball:
    """Return the web between a finger and the next, half-way between their bones."""
    share, size = _WEBS[digit]
    ends = [
        ray[1].origin + share * (ray[2].origin - ray[1].origin) + _down(scale) for ray in (one, two)
    ]
    axes = one[1].axes + two[1].axes
    # The nearest rotation to the mean of both fingers' axes.
    left, _, right = np.linalg.svd(axes)
    return Ball(Frame(0.5 * (ends[0] + ends[1]), left @ right), times(size, scale))


def _up(name: str) -> Vector:
    """Return the direction that n of a part's sections stays nearest to."""
    return (0.0, 1.0, 0.0) if name == "thumb web" else (1.0, 0.0, 0.0)


def _down(scale: float) -> FloatArray:
    """How far the flesh lies more on the palm's side than the bones."""
    return np.array([0.0, -1.2 * scale, 0.0])


def _round(at: tuple[float, ...], wide: float, deep: float) -> Station:
    x, y, z = (float(value) for value in at)
    return Station((x, y, z), (-wide, wide), (-deep, deep))
