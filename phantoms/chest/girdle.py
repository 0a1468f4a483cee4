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
    Instance,
    Intersection,
    LineAxis,
    Point,
    Rotation,
    Solid,
    SplineContour,
    Transformed,
    UpFrame,
)
from phantoms.chest.arms import CUT_X_MM, TOP_Z_MM
from phantoms.chest.cage import Cage, FloatArray
from phantoms.chest.frame import Frame
from phantoms.chest.shapes import cone, tube
from phantoms.chest.sides import SIDES, on_side
from phantoms.parts import Station, ellipsoid, layered, swept, union, within

# The blade, in its own plane: sideways from the medial border, and height over the spine's root.
_BLADE: Final = (
    (6.0, 46.0), (0.0, 22.0), (-2.0, 0.0), (0.0, -34.0), (6.0, -72.0), (15.0, -104.0),
    (22.0, -110.0), (29.0, -104.0), (40.0, -74.0), (54.0, -38.0), (66.0, -8.0), (72.0, 8.0),
    (73.0, 26.0), (66.0, 36.0), (50.0, 37.0), (32.0, 44.0), (16.0, 51.0),
)  # fmt: skip
# Sideways, up and behind on the blade.
_ACROMION: Final = (90.0, 56.0, 2.0)
_SOCKET: Final = (77.0, 22.0, 0.0)
_STERNUM_Y: Final = -40.0
_HEAD_RADIUS_MM: Final = 23.0
_FAR_MM: Final = 2000.0


def joint(frame: Frame) -> Point:
    """Return the inner end of the left clavicle, before and beside the breastbone."""
    x, y, z = frame.girdle.clavicle[0][0]
    _, middle, height = frame.at(0.0, _STERNUM_Y, z)
    return (frame.bone * x, middle + frame.bone * (y - _STERNUM_Y), height)


def _clavicle_stations(frame: Frame) -> list[Station]:
    """Return sections of the left clavicle; its outer end follows the scapula."""
    table = frame.girdle.clavicle
    inner = np.array(joint(frame)) - frame.at(*table[0][0])
    outer = np.array(_on_blade(frame, *_ACROMION)) - frame.at(*frame.girdle.acromion)
    stations = []
    for share, (point, high, deep) in zip(np.linspace(0, 1, len(table)) ** 1.5, table, strict=True):
        x, y, z = np.array(frame.at(*point)) + (1.0 - share) * inner + share * outer
        reaches = ((-h * frame.bone, h * frame.bone) for h in (high, deep))
        stations.append(Station((float(x), float(y), float(z)), *reaches))
    return stations


def clavicle(frame: Frame) -> Solid:
    """Return a left clavicle: cortex, thickest over its middle, and spongiosa."""
    stations = _clavicle_stations(frame)
    walls = [0.8, 1.0, 1.8, 2.3, 2.2, 1.6, 1.0, 0.8]
    return layered(
        swept("cortex", stations, "cortical_bone", up=(0.0, 0.0, 1.0)),
        swept("spongiosa", within(stations, walls), "spongiosa", up=(0.0, 0.0, 1.0)),
    )


def clavicle_muscles(frame: Frame, name: str, material: str, more_mm: float) -> Solid:
    """Return the muscles about the outer half of the clavicle, so much thicker."""
    stations = _clavicle_stations(frame)
    radii = (10.0 * frame.bone + more_mm, 13.0 * frame.bone + more_mm)
    start, end = stations[4].at, stations[-2].at
    return union(
        cone(name, start, end, radii, material),
        ellipsoid(f"start of the {name}", start, (radii[0] + 0.5,) * 3, material),
        ellipsoid(f"end of the {name}", end, (radii[1] + 0.5,) * 3, material),
    )


def _blade_axes(frame: Frame) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the ways sideways and up along the blade, and behind it."""
    facing, turn = (math.radians(a) for a in (frame.girdle.facing_deg, frame.girdle.turn_deg))
    sideways = np.array([math.cos(facing), -math.sin(facing), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    return (
        math.cos(turn) * sideways + math.sin(turn) * up,
        math.cos(turn) * up - math.sin(turn) * sideways,
        np.array([math.sin(facing), math.cos(facing), 0.0]),
    )


def _on_blade(frame: Frame, sideways: float, up: float, behind: float = 0.0) -> Point:
    """Return the point of the body at a place of the blade, so far behind it."""
    ways = _blade_axes(frame)
    root = np.array(frame.at(*frame.girdle.root))
    at = root + frame.bone * (sideways * ways[0] + up * ways[1] + behind * ways[2])
    return (float(at[0]), float(at[1]), float(at[2]))


def _upward(frame: Frame) -> Point:
    """Return the way up along the blade."""
    way = _blade_axes(frame)[1]
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
    thick = 4.0 * f.bone
    acromion = swept(
        "acromion",
        [
            Station(_on_blade(f, s, u, b), (-thick, thick), (-half * f.bone, half * f.bone))
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


def from_socket(frame: Frame, offset: Point) -> Point:
    """Return the point so far from the socket of the shoulder, in mm of the drawn man."""
    at = np.array(_on_blade(frame, *_SOCKET)) + frame.bone * np.array(offset)
    return (float(at[0]), float(at[1]), float(at[2]))


def arm_axis(frame: Frame) -> list[Point]:
    """Return points of the humerus from its head to beyond where it is cut."""
    return [from_socket(frame, offset) for offset in frame.girdle.arm]


def blade_muscles(frame: Frame, name: str, material: str, more_mm: float) -> Solid:
    """Return the muscles on both sides of the blade, so much thicker."""
    ways = np.array(_blade_axes(frame)).T
    middle = _on_blade(frame, 35.0, -31.0, 3.0)
    rows = [(*map(float, way), at) for way, at in zip(ways, middle, strict=True)]
    half = [frame.bone * h + more_mm for h in (50.0, 92.0, 10.0)]
    return Transformed(
        type="transformed",
        solid=ellipsoid(name, (0.0, 0.0, 0.0), (half[0], half[1], half[2]), material),
        matrix=tuple(rows),
    )


def shoulder_turn(cage: Cage) -> Rotation:
    """Return what turns the mirror image of the left shoulder into the right one."""
    return cage.sides.shoulder(joint(cage.frame))


def bone(cage: Cage, name: str) -> Solid:
    """Return a bone of the shoulders, from the definitions, on both sides."""
    part, turn = Instance(type="instance", of=name), shoulder_turn(cage)
    return union(*(on_side(part, side, turn, f"{side} {name}") for side in SIDES))


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
