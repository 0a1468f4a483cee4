"""The shoulder girdle: clavicles, simplified scapulae and the upper ends of the humeri.

Drawn on the left; where they are when the arms hang or are raised tells `phantoms.chest.arms`.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from phantom.document import (
    Box,
    GeneralizedCylinder,
    Intersection,
    LineAxis,
    Point,
    Solid,
    SplineContour,
    UpFrame,
)
from phantoms.chest.arms import CUT_X_MM, TOP_Z_MM
from phantoms.chest.cage import Cage
from phantoms.chest.frame import Frame
from phantoms.chest.shapes import tube
from phantoms.chest.sides import Rows
from phantoms.parts import Station, ellipsoid, layered, swept, union, within

# The blade, in its own plane: sideways from the medial border, and height over the spine's root.
_BLADE: Final = (
    (6.0, 46.0), (0.0, 22.0), (-2.0, 0.0), (0.0, -34.0), (6.0, -72.0), (15.0, -104.0),
    (22.0, -110.0), (29.0, -104.0), (40.0, -74.0), (54.0, -38.0), (66.0, -8.0), (72.0, 8.0),
    (73.0, 26.0), (66.0, 36.0), (50.0, 37.0), (32.0, 44.0), (16.0, 51.0),
)  # fmt: skip
_SIDEWAYS: Final = np.array([0.63, -0.776, 0.0])
_BEHIND: Final = np.array([0.776, 0.63, 0.0])
_UP: Final = np.array([0.0, 0.0, 1.0])
_HEAD_RADIUS_MM: Final = 23.0
_FAR_MM: Final = 2000.0


def _stations(frame: Frame, table: tuple[tuple[Point, float, float], ...]) -> list[Station]:
    return [
        Station(
            frame.at(*point),
            (-high * frame.bone, high * frame.bone),
            (-deep * frame.bone, deep * frame.bone),
        )
        for point, high, deep in table
    ]


def clavicle(frame: Frame) -> Solid:
    """Return a left clavicle: cortex, thickest over its middle, and spongiosa."""
    stations = _stations(frame, frame.girdle.clavicle)
    walls = [0.8, 1.0, 1.8, 2.3, 2.2, 1.6, 1.0, 0.8]
    return layered(
        swept("cortex", stations, "cortical_bone", up=(0.0, 0.0, 1.0)),
        swept("spongiosa", within(stations, walls), "spongiosa", up=(0.0, 0.0, 1.0)),
    )


def _on_blade(frame: Frame, sideways: float, up: float, behind: float = 0.0) -> Point:
    """Return the point of the body at a place of the blade, so far behind it."""
    turn = math.radians(frame.girdle.turn_deg)
    out = math.cos(turn) * _SIDEWAYS + math.sin(turn) * _UP
    high = math.cos(turn) * _UP - math.sin(turn) * _SIDEWAYS
    root = np.array(frame.at(*frame.girdle.root))
    at = root + frame.bone * (sideways * out + behind * _BEHIND + up * high)
    return (float(at[0]), float(at[1]), float(at[2]))


def _upward(frame: Frame) -> Point:
    """Return the way up along the blade."""
    turn = math.radians(frame.girdle.turn_deg)
    way = math.cos(turn) * _UP - math.sin(turn) * _SIDEWAYS
    return (float(way[0]), float(way[1]), float(way[2]))


def scapula(frame: Frame) -> Solid:
    """Return a left scapula: the blade, its thick side, spine, acromion, coracoid and neck."""
    f = frame
    blade = GeneralizedCylinder(
        type="generalized_cylinder",
        name="blade",
        material="blade_bone",
        axis=LineAxis(
            type="line", start=_on_blade(f, 0.0, 0.0, -1.4), end=_on_blade(f, 0.0, 0.0, 1.4)
        ),
        contour=SplineContour(
            type="spline", points=tuple((f.bone * up, f.bone * side) for side, up in _BLADE)
        ),
        frame=UpFrame(up=_upward(f)),
    )
    side = tube(
        "lateral border",
        [_on_blade(f, *p) for p in ((20.0, -104.0), (33.0, -82.0), (50.0, -42.0), (64.0, -6.0))],
        [2.4 * f.bone, 3.6 * f.bone, 4.4 * f.bone, 5.5 * f.bone],
        "arch_bone",
    )
    spine = tube(
        "spine",
        [
            _on_blade(f, *p)
            for p in ((2.0, 2.0, 2.0), (25.0, 10.0, 10.0), (48.0, 22.0, 20.0), (66.0, 40.0, 24.0))
        ],
        [2.2 * f.bone, 3.4 * f.bone, 4.2 * f.bone, 5.0 * f.bone],
        "arch_bone",
    )
    acromion = swept(
        "acromion",
        [
            Station(_on_blade(f, s, u, b), (-4.0, 4.0), (-half, half))
            for s, u, b, half in (
                (64.0, 41.0, 24.0, 6.0),
                (76.0, 50.0, 20.0, 9.0),
                (88.0, 55.0, 8.0, 9.5),
                (94.0, 57.0, -2.0, 6.0),
            )
        ],
        "arch_bone",
        up=_upward(f),
    )
    coracoid = tube(
        "coracoid",
        [_on_blade(f, *p) for p in ((64.0, 34.0, -2.0), (70.0, 44.0, -14.0), (82.0, 40.0, -30.0))],
        [6.5 * f.bone, 5.6 * f.bone, 4.4 * f.bone],
        "arch_bone",
    )
    neck = tube(
        "neck",
        [_on_blade(f, *p) for p in ((56.0, 18.0), (68.0, 20.0), (77.0, 22.0))],
        [5.0 * f.bone, 8.0 * f.bone, 12.5 * f.bone],
        "arch_bone",
    )
    return union(side, spine, acromion, coracoid, neck, blade)


def arm_axis(frame: Frame) -> list[Point]:
    """Return points of the humerus from its head to beyond where it is cut."""
    return frame.path(frame.girdle.arm)


def right_shoulder(cage: Cage) -> Rows:
    """Return the rows of what moves the left shoulder to the right."""
    return cage.sides.shoulder(cage.frame.at(*cage.frame.girdle.clavicle[0][0]))


def kept(frame: Frame, arms: Solid, of: str) -> Solid:
    """Return what of both arms lies before the planes at which they are cut."""
    half, top = CUT_X_MM * frame.x, TOP_Z_MM * frame.z
    room = Box(
        type="box",
        name=f"bounds of the {of}",
        center=(0.0, 0.0, top - _FAR_MM / 2),
        size=(2.0 * half, _FAR_MM, _FAR_MM),
    )
    return Intersection(type="intersection", solids=(arms, room))


def humerus(frame: Frame) -> Solid:
    """Return the upper end of a left humerus."""
    f = frame
    radius = _HEAD_RADIUS_MM * f.bone
    axis = arm_axis(f)
    head = axis[0]
    radii = [19.0, 19.5, 15.0, 12.5, 12.0, 12.0]
    stations = [
        Station(p, (-r * f.bone, r * f.bone), (-r * f.bone, r * f.bone))
        for p, r in zip(axis, radii, strict=True)
    ]
    inside = within(stations, [0.8, 1.0, 2.5, 4.0, 4.5, 4.5], closed=(True, False))
    up = (0.0, 1.0, 0.0)
    return layered(
        ellipsoid("head", head, (radius, radius, radius), "cortical_bone"),
        swept("cortex", stations, "cortical_bone", up=up),
        ellipsoid("spongiosa of the head", head, (radius - 0.9,) * 3, "spongiosa"),
        swept("spongiosa", inside, "spongiosa", up=up),
    )
