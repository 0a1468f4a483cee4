"""Ribs, their cartilages and the breastbone.

A rib is an oval swept along its line, its long axis in the wall of the chest: a shell of cortical
bone, thickest over the middle of the rib, about spongiosa.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from phantom.document import (
    EllipseContour,
    GeneralizedCylinder,
    Instance,
    LinearSweep,
    Point,
    Solid,
    SplineAxis,
    Transformed,
    UpFrame,
)
from phantoms.chest.cage import Cage, FloatArray, RibLine
from phantoms.chest.shapes import chain
from phantoms.chest.sides import SIDES, on_side
from phantoms.parts import Station, chord_lengths, knots, layered, swept, union, within

# Along a rib: height and thickness of its section over those at its middle, and its cortex.
_ALONG: Final = (
    (0.0, 0.72, 1.0, 0.6),
    (0.12, 0.80, 1.05, 0.8),
    (0.3, 1.0, 1.05, 1.0),
    (0.6, 1.0, 1.0, 1.0),
    (0.85, 1.02, 0.95, 0.75),
    (1.0, 1.12, 0.95, 0.6),
)
# Size of a rib's section over the sixth's.
_SIZE: Final = {
    1: (1.12, 0.72), 2: (0.82, 0.85), 3: (0.88, 0.93), 4: (0.94, 0.97),
    5: (0.98, 1.0), 6: (1.0, 1.0), 7: (1.03, 1.02), 8: (1.0, 1.0),
    9: (0.96, 0.96), 10: (0.9, 0.92), 11: (0.8, 0.86), 12: (0.68, 0.78),
}  # fmt: skip


def rib(cage: Cage, number: int) -> Solid:
    """Return a left rib: its cortex, and in it its spongiosa."""
    line = cage.rib(number)
    sizes = cage.frame.sizes
    high, thick = _SIZE[number]
    half = (sizes.rib_height_mm * high / 2, sizes.rib_thickness_mm * thick / 2)
    table = np.array(_ALONG)
    at = np.array(chord_lengths([_point(p) for p in line.points]))
    height, thickness, share = (np.interp(at, table[:, 0], table[:, i]) for i in (1, 2, 3))
    if number >= 11:  # floating ribs end in a point
        taper = np.clip((1.04 - at) / 0.35, 0.25, 1.0)
        height, thickness = height * taper, thickness * taper
    outer = (half[0] * height, half[1] * thickness)
    wall = np.minimum(sizes.rib_cortex_mm * share, 0.42 * outer[1])
    inner = (outer[0] - wall, outer[1] - wall)
    psi = _turns_deg(line)
    return layered(
        _oval("cortex", line.points, outer, psi, "cortical_bone"),
        _oval("spongiosa", _short(line.points, 0.6), inner, psi, "spongiosa"),
    )


def _point(given: FloatArray) -> Point:
    return (float(given[0]), float(given[1]), float(given[2]))


def _short(points: FloatArray, by_mm: float) -> FloatArray:
    """Return the points of an axis whose ends are drawn in, so that the ends have a wall."""
    shorter = points.copy()
    for end, beside in ((0, 1), (-1, -2)):
        along = points[beside] - points[end]
        shorter[end] += by_mm * along / np.linalg.norm(along)
    return shorter


def _turns_deg(line: RibLine) -> FloatArray:
    """Return how far sections turn from upright so that they lie in the wall of the chest."""
    from scipy.interpolate import CubicSpline

    at = np.array(chord_lengths([_point(p) for p in line.points]))
    tangents = CubicSpline(at, line.points)(at, 1)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    n = np.array([0.0, 0.0, 1.0]) - tangents * tangents[:, 2:]
    n /= np.linalg.norm(n, axis=1)[:, None]
    b = np.cross(tangents, n)
    long_axis = np.cross(line.normals, tangents)
    angle = np.arctan2((long_axis * b).sum(1), (long_axis * n).sum(1))
    angle = (angle + math.pi / 2) % math.pi - math.pi / 2  # an oval is its own half turn
    unwrapped: FloatArray = np.degrees(np.unwrap(angle, period=math.pi))
    return unwrapped


def _oval(
    name: str,
    points: FloatArray,
    half: tuple[FloatArray, FloatArray],
    turn_deg: FloatArray,
    material: str,
) -> GeneralizedCylinder:
    places = [_point(p) for p in points]
    at = chord_lengths(places)
    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material=material,
        axis=SplineAxis(type="spline", points=tuple(places)),
        contour=EllipseContour(type="ellipse", semi_axes=(1.0, 1.0)),
        sweep=LinearSweep(
            type="linear",
            scale=(knots(at, half[0].tolist()), knots(at, half[1].tolist())),
            rotate_deg=knots(at, turn_deg.tolist()),
        ),
        frame=UpFrame(up=(0.0, 0.0, 1.0)),
    )


def definitions(cage: Cage) -> dict[str, Solid]:
    """Return the twelve left ribs and the cartilages of ten by name."""
    found = {f"rib {number}": rib(cage, number) for number in range(1, 13)}
    return found | {f"cartilage {number}": cartilage(cage, number) for number in range(1, 11)}


def cartilages(cage: Cage, side: str) -> Transformed:
    """Return the cartilages of a side, each moved as its rib is."""
    parts = (
        on_side(Instance(type="instance", of=f"cartilage {number}"), side, cage.turn(number))
        for number in range(1, 11)
    )
    return Transformed(type="transformed", name=f"{side} side", solid=union(*parts))


def ribs(cage: Cage, changed: Mapping[tuple[str, int], Solid]) -> Solid:
    """Return all ribs; ``changed`` ones in place of the usual."""
    return union(
        *(
            changed.get((side, number)) or in_place(cage, side, number)
            for number in range(1, 13)
            for side in SIDES
        )
    )


def in_place(cage: Cage, side: str, number: int, name: str | None = None) -> Transformed:
    """Return a healthy rib on its side."""
    rib = Instance(type="instance", of=f"rib {number}")
    return on_side(rib, side, cage.turn(number), name or f"{side} rib {number}")


# Drawn heights of the sides of the breastbone where cartilages meet it, and its half-widths.
_STERNAL_Z: Final = {1: 76.0, 2: 48.0, 3: 24.0, 4: 4.0, 5: -15.0, 6: -32.0, 7: -46.0}
_STERNUM: Final = (
    (86.0, 20.0, 4.0), (80.0, 26.0, 5.5), (68.0, 26.0, 6.0), (56.0, 18.0, 5.5), (48.0, 14.0, 5.5),
    (38.0, 14.5, 5.0), (10.0, 17.5, 5.0), (-20.0, 19.5, 5.0), (-44.0, 16.0, 4.8), (-56.0, 8.5, 4.0),
    (-72.0, 6.5, 3.0), (-88.0, 4.0, 2.2),
)  # fmt: skip
_CORTEX_MM: Final = 0.9


def sternum_y(cage: Cage, z_mm: float) -> float:
    """Return where the middle plane of the breastbone is at a height of the body."""
    return cage.section(z_mm)[1]


def breastbone(cage: Cage) -> Solid:
    """Return manubrium, body and xiphoid in one."""
    f = cage.frame
    stations = []
    for z, half, thick in _STERNUM:
        height = z * f.z
        at = (0.0, sternum_y(cage, height), height)
        stations.append(
            Station(at, (-half * f.bone, half * f.bone), (-thick * f.bone, thick * f.bone))
        )
    stations.reverse()
    return layered(
        swept("cortex", stations, "cortical_bone"),
        swept("spongiosa", within(stations, _CORTEX_MM), "spongiosa"),
    )


def cartilage(cage: Cage, number: int) -> Solid:
    """Return the cartilage from a left rib's end to the breastbone, or to the one above."""
    f = cage.frame
    line = cage.rib(number)
    end = line.points[-1]
    along = line.points[-1] - line.points[-2]
    start = end + 1.0 * along / np.linalg.norm(along)
    radius = 0.42 * f.sizes.rib_height_mm
    if number <= 7:
        z = _STERNAL_Z[number] * f.z
        half = float(
            np.interp(
                z / f.z, [r[0] for r in reversed(_STERNUM)], [r[1] for r in reversed(_STERNUM)]
            )
        )
        last = np.array([half * f.bone + 1.5, sternum_y(cage, z) - 0.5, z])
    else:  # beside the cartilage above
        above = cage.rib(number - 1).points[-1]
        last = above + np.array([-16.0, -6.0, -15.0 * f.z])
    if number <= 4:
        middle = start + 0.5 * (last - start) + np.array([0.0, -1.5, 0.0])
    else:
        dip = (start[2] - last[2]) * (0.1 if number > 7 else 0.0)
        middle = start + np.array([0.45, 0.5, 0.0]) * (last - start)
        middle[2] = start[2] + 0.12 * (last[2] - start[2]) - dip - 2.0
    points = [start, last] if number == 1 else [start, middle, last]
    radii = np.linspace(radius, 0.8 * radius, len(points))
    places = [_point(p) for p in points]
    return union(*chain(f"costal cartilage {number}", places, radii.tolist(), "cartilage"))
