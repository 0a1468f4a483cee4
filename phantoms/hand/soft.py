"""The hand's soft tissue: skin, the fat under it, and the rest, each within the one before.

Fingers are tapered tubes along their bones; the palm, the ball of the thumb and the web beside it
join them. Thicknesses are estimates.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from phantom.document import Point, Solid
from phantoms.hand.forearm import END_Z_MM
from phantoms.hand.frames import FloatArray, Frame
from phantoms.inside import inside
from phantoms.parts import ROUND, Outline, Station, layered, swept, union, within

SKIN, FAT, SOFT = "skin", "fat", "soft tissue"
SKIN_MM: Final = 1.2
TIP_MM: Final = {"thumb": 5.7, "index": 3.8, "middle": 4.0, "ring": 4.0, "little": 3.7}
"""Soft tissue beyond the bone of each fingertip (Buryanov and Kotiuk 2010)."""

# Half-width and half-depth at: middle of the metacarpal, its head, middle of the proximal phalanx,
# PIP joint, middle of the middle phalanx, DIP joint, tuft; for the thumb without the fourth pair.
_TUBES: Final[dict[str, tuple[tuple[float, float], ...]]] = {
    "thumb": ((7.0, 8.0), (15.0, 12.5), (12.8, 11.5), (10.8, 9.6), (10.9, 9.0), (9.0, 6.8)),
    "index": (
        (6.0, 6.5), (10.6, 11.4), (9.8, 9.6), (9.6, 8.9), (8.6, 7.8), (8.3, 7.0), (6.8, 5.6),
    ),
    "middle": (
        (6.0, 6.5), (10.8, 11.6), (10.0, 9.8), (9.8, 9.1), (8.8, 8.0), (8.5, 7.1), (7.0, 5.7),
    ),
    "ring": (
        (6.0, 6.5), (10.2, 11.2), (9.5, 9.4), (9.3, 8.7), (8.3, 7.6), (8.0, 6.8), (6.6, 5.5),
    ),
    "little": (
        (6.0, 6.0), (9.4, 10.4), (8.5, 8.4), (8.2, 7.7), (7.3, 6.7), (7.1, 6.0), (5.9, 4.9),
    ),
}  # fmt: skip
# z, x of the little finger's side and of the thumb's, y of the palm and of the back.
_PALM: Final = (
    (END_Z_MM, -29.4, 25.6, -18.8, 16.0),
    (-64.0, -29.8, 26.5, -18.6, 15.5),
    (-50.0, -30.8, 28.5, -18.4, 15.0),
    (-35.0, -32.8, 30.8, -19.0, 14.5),
    (-18.0, -36.5, 33.6, -19.6, 14.0),
    (0.0, -40.0, 33.8, -19.2, 13.2),
    (18.0, -43.0, 32.0, -18.0, 12.4),
    (36.0, -45.0, 32.5, -16.5, 11.8),
    (48.0, -43.5, 34.0, -15.0, 10.5),
    (58.0, -38.0, 34.5, -13.5, 9.5),
    (67.0, -30.0, 33.0, -12.0, 8.0),
    (74.0, -22.0, 30.0, -10.0, 6.0),
    (80.0, -12.0, 24.0, -7.0, 3.0),
    (82.5, -5.0, 17.0, -4.5, 0.5),
)
_OUTLINES: Final[dict[str, Outline]] = {
    "palm": tuple(
        (
            math.copysign(abs(math.cos(angle)) ** 0.72, math.cos(angle)),
            math.copysign(abs(math.sin(angle)) ** 0.72, math.sin(angle)),
        )
        for angle in (math.pi * (index + 0.5) / 10 for index in range(20))
    )
}
"""Sections that are no ellipses: the palm's are squarer."""

# The web between thumb and index: a fold from the palm's edge, as sections across its length.
_WEB: Final = (
    ((10.0, -6.5, -14.0), 16.0, 9.0),
    ((20.0, -6.5, -4.0), 20.0, 9.8),
    ((29.0, -6.2, 5.5), 20.5, 9.6),
    ((35.5, -5.8, 13.0), 18.0, 8.6),
    ((40.0, -5.4, 19.0), 14.0, 7.2),
    ((42.8, -5.0, 23.4), 9.5, 5.4),
    ((44.4, -5.0, 26.0), 5.5, 3.4),
    ((45.2, -5.0, 27.2), 2.2, 1.6),
)


def outlines(
    scale: float, frames: Mapping[str, Sequence[Frame]], ends_mm: Mapping[str, float]
) -> dict[str, list[Station]]:
    """Return the sections of the skin, by name of the part.

    Parameters
    ----------
    scale
        Of the hand.
    frames
        Of the bones of each ray.
    ends_mm
        Length of each ray's distal phalanx.
    """
    outer = {digit: _tube(digit, scale, frames[digit], ends_mm[digit]) for digit in frames}
    outer["palm"] = _palm(scale)
    outer["web"] = [
        _round(_times(at, scale), scale * wide, scale * deep) for at, wide, deep in _WEB
    ]
    return outer


def envelope(outer: Mapping[str, Sequence[Station]], fat_mm: float) -> Solid:
    """Return the soft tissue, outermost first, within the sections of the skin."""
    layers = []
    for material, depth in ((SKIN, 0.0), (FAT, SKIN_MM), (SOFT, SKIN_MM + fat_mm)):
        parts = [
            swept(
                f"{name} {material}", _inside(stations, depth), material, _OUTLINES.get(name, ROUND)
            )
            for name, stations in outer.items()
        ]
        layers.append(union(*parts))
    return layered(*layers)


def within_skin(outer: Mapping[str, Sequence[Station]], point: FloatArray) -> bool:
    """Whether a point is under the skin, as seen from the sections it lies between."""
    return any(inside(stations, point, SKIN_MM) for stations in outer.values())


def _inside(stations: Sequence[Station], depth_mm: float) -> Sequence[Station]:
    if depth_mm == 0.0:
        return stations
    return within(stations, depth_mm, closed=(False, True), least_mm=0.3)


def _tube(digit: str, scale: float, frames: Sequence[Frame], end_mm: float) -> list[Station]:
    """Return the sections of a finger, from the middle of its metacarpal to its tip."""
    last = len(frames) - 1
    points = [0.5 * (frames[0].origin + frames[1].origin)]
    if digit == "thumb":
        points.insert(0, frames[0].point((-6.0 * scale, 0.0, -12.0 * scale)))
    for index in range(1, last):
        points += [frames[index].origin, 0.5 * (frames[index].origin + frames[index + 1].origin)]
    points.append(frames[last].origin)
    points.append(frames[last].point((0.0, 0.0, 0.78 * end_mm)))
    sizes = list(_TUBES[digit])
    down = np.array([0.0, -1.2 * scale, 0.0])
    made = [
        _round(tuple(point + down), scale * wide, scale * deep)
        for point, (wide, deep) in zip(points, sizes, strict=True)
    ]
    # The tip is round: a quarter of an ellipse beyond the tuft's middle.
    reach = 0.22 * end_mm + scale * TIP_MM[digit]
    wide, deep = sizes[-1]
    for share in (0.35, 0.62, 0.82, 0.94, 1.0):
        around = max((1 - share**2.2) ** (1 / 2.2), 0.12)
        point = frames[last].point((0.0, 0.0, 0.78 * end_mm + share * reach)) + down
        made.append(_round(tuple(point), scale * wide * around, scale * deep * around))
    return made


def _palm(scale: float) -> list[Station]:
    made = []
    for z, low, high, palm, back in _PALM:
        x, y = (low + high) / 2, (palm + back) / 2
        wide, deep = (high - low) / 2, (back - palm) / 2
        made.append(
            Station(
                (0.0, scale * -3.0, scale * z),
                (scale * (x - wide), scale * (x + wide)),
                (scale * (y + 3.0 - deep), scale * (y + 3.0 + deep)),
            )
        )
    return made


def _round(at: tuple[float, ...], wide: float, deep: float) -> Station:
    x, y, z = (float(value) for value in at)
    return Station((x, y, z), (-wide, wide), (-deep, deep))


def _times(point: Point, by: float) -> Point:
    x, y, z = point
    return (by * x, by * y, by * z)
