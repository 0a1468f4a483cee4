"""The shoulder girdle: clavicles, simplified scapulae and the upper ends of the humeri.

Drawn on the left as for a PA view: shoulders rolled forward, so that the scapulae clear the lungs,
and the arms away from the sides.
"""

from __future__ import annotations

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
from phantoms.chest.frame import Frame
from phantoms.chest.shapes import tube
from phantoms.parts import Station, ellipsoid, layered, swept, union, within

# The clavicle: points, and half its height and depth there.
_CLAVICLE: Final = (
    ((17.0, -52.0, 88.0), 10.5, 9.5),
    ((27.0, -54.5, 89.5), 9.0, 8.5),
    ((45.0, -56.0, 92.5), 6.6, 6.4),
    ((70.0, -51.0, 96.5), 5.8, 6.0),
    ((95.0, -38.0, 101.0), 5.6, 6.2),
    ((120.0, -23.0, 105.5), 5.4, 7.5),
    ((141.0, -12.0, 108.5), 5.2, 9.0),
    ((153.0, -7.0, 109.5), 4.6, 8.5),
)
# The blade, in its own plane: sideways from the medial border, and height over the spine's root.
_BLADE: Final = (
    (6.0, 46.0), (0.0, 22.0), (-2.0, 0.0), (0.0, -34.0), (6.0, -72.0), (15.0, -104.0),
    (22.0, -110.0), (29.0, -104.0), (40.0, -74.0), (54.0, -38.0), (66.0, -8.0), (72.0, 8.0),
    (73.0, 26.0), (66.0, 36.0), (50.0, 37.0), (32.0, 44.0), (16.0, 51.0),
)  # fmt: skip
_ROOT: Final = (119.0, 78.0, 52.0)
_SIDEWAYS: Final = np.array([0.63, -0.776, 0.0])
HEAD: Final = (184.0, 3.0, 82.0)
_HEAD_RADIUS_MM: Final = 23.0
CUT_X_MM: Final = 214.0
"""The arms are drawn to here."""


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
    stations = _stations(frame, _CLAVICLE)
    walls = [0.8, 1.0, 1.8, 2.3, 2.2, 1.6, 1.0, 0.8]
    return layered(
        swept("cortex", stations, "cortical_bone", up=(0.0, 0.0, 1.0)),
        swept("spongiosa", within(stations, walls), "spongiosa", up=(0.0, 0.0, 1.0)),
    )


def _on_blade(frame: Frame, sideways: float, up: float, behind: float = 0.0) -> Point:
    """Return the point of the body at a place of the blade, so far behind it."""
    back = np.array([0.776, 0.63, 0.0])
    root = np.array(frame.at(*_ROOT))
    at = root + frame.bone * (sideways * _SIDEWAYS + behind * back + up * np.array([0, 0, 1.0]))
    return (float(at[0]), float(at[1]), float(at[2]))


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
        frame=UpFrame(up=(0.0, 0.0, 1.0)),
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
        up=(0.0, 0.0, 1.0),
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
    """Return points of the humerus from its head to where it is cut."""
    return [
        frame.at(*HEAD),
        frame.at(HEAD[0] + 12.0, HEAD[1] - 1.0, HEAD[2] - 17.0),
        frame.at(HEAD[0] + 26.0, HEAD[1] - 4.0, HEAD[2] - 40.0),
        frame.at(HEAD[0] + 42.0, HEAD[1] - 8.0, HEAD[2] - 68.0),
        frame.at(HEAD[0] + 60.0, HEAD[1] - 12.0, HEAD[2] - 100.0),
        frame.at(HEAD[0] + 112.0, HEAD[1] - 22.0, HEAD[2] - 190.0),
    ]


def cut_x(frame: Frame) -> float:
    """Return how far from the middle the arms are cut."""
    return CUT_X_MM * frame.x


def kept(frame: Frame, arm: Solid) -> Solid:
    """Return what of a left arm lies before the plane at which arms are cut."""
    far = 1000.0
    middle = (cut_x(frame) - far / 2, 0.0, 0.0)
    room = Box(type="box", name="bounds of the arm", center=middle, size=(far, far, far))
    return Intersection(type="intersection", solids=(arm, room))


def humerus(frame: Frame) -> Solid:
    """Return the upper end of a left humerus."""
    f = frame
    head = f.at(*HEAD)
    radius = _HEAD_RADIUS_MM * f.bone
    axis = arm_axis(f)
    radii = [19.0, 19.5, 15.0, 12.5, 12.0, 12.0]
    stations = [
        Station(p, (-r * f.bone, r * f.bone), (-r * f.bone, r * f.bone))
        for p, r in zip(axis, radii, strict=True)
    ]
    inside = within(stations, [0.8, 1.0, 2.5, 4.0, 4.5, 4.5], closed=(True, False))
    up = (0.0, 1.0, 0.0)
    bone = layered(
        ellipsoid("head", head, (radius, radius, radius), "cortical_bone"),
        swept("cortex", stations, "cortical_bone", up=up),
        ellipsoid("spongiosa of the head", head, (radius - 0.9,) * 3, "spongiosa"),
        swept("spongiosa", inside, "spongiosa", up=up),
    )
    return kept(f, bone)
