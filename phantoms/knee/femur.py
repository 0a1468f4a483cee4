"""The lower half of the femur: shaft, condyles, trochlea and notch.

One generalized cylinder is the bone: its axis comes down the shaft and curls backward under the
joint, so that one outline draws the trochlea in front, the condyles below and their overhang
behind. An ellipsoid taken from it deepens the groove in front, an elliptic cylinder makes the
notch. Spongiosa is the same a wall's thickness inside; a long ellipsoid in it is the canal.

The tables hold a man's right femur whose medial condyle touches z = 0; they are estimates between
the published sizes that scale them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from phantom.document import Cut, Cylinder, Difference, Point, Rotation, Solid, Transformed
from phantoms.knee.sizes import Sizes
from phantoms.parts import Outline, Station, ellipsoid, is_left, layered, swept, within

WIDTH: Final = 88.45
DEPTH: Final = 60.08
"""Of the tables' condyles, as traced."""
SHAFT: Final = 26.5

# In the frame (x, outward): behind the shaft and within the bend b = -1, in front of the shaft and
# under the condyles b = 1. The medial condyle (x > 0) is the lower, the lateral one the broader.
OUTLINE: Final[Outline] = (
    (0.0, 0.86),
    (0.27, 0.94),
    (0.54, 1.0),
    (0.83, 0.82),
    (0.98, 0.2),
    (0.96, -0.45),
    (0.62, -0.92),
    (0.0, -1.0),
    (-0.62, -0.92),
    (-0.96, -0.45),
    (-0.99, 0.2),
    (-0.88, 0.81),
    (-0.57, 0.97),
    (-0.27, 0.925),
)
# Shaft: z, y of the axis, half-width, depth behind and in front of the axis, the cortex as a share
# of that at midshaft.
_SHAFT: Final = (
    (60.0, -0.4, 29.0, 18.0, 18.4, 0.25),
    (80.0, -0.9, 20.7, 16.6, 16.2, 0.38),
    (104.0, -1.7, 16.8, 15.5, 14.7, 0.60),
    (160.0, -3.2, 14.0, 14.6, 13.6, 0.90),
    (224.0, -3.6, 13.25, 14.2, 13.4, 1.0),
    (260.0, -3.2, 13.25, 14.2, 13.4, 1.0),
)
_MIDSHAFT: Final = 4
# Condyles: degrees round the bend from the front, half-width, inner and outer radius, wall in mm.
_CONDYLES: Final = (
    (0.0, 38.4, 3.5, 40.0, 1.5),
    (32.0, 43.4, 3.5, 41.5, 1.4),
    (64.0, 44.3, 3.0, 43.0, 1.4),
    (94.0, 43.9, 2.5, 42.6, 1.4),
    (120.0, 41.4, 2.5, 35.6, 1.3),
    (138.0, 36.0, 2.5, 26.4, 1.2),
    (150.0, 29.0, 2.5, 17.0, 1.2),
)
# Middle (y, z) and radius of the bend in which the axis curls back.
BEND_YZ: Final = (20.0, 43.0)
BEND_RADIUS: Final = 21.0
_LEAN_FROM_Z: Final = 55.0
_BEYOND_MM: Final = 8.0
"""The shaft is drawn this much longer than the limb, to be cut level with it."""

_ROOF: Final = ((9.0, 9.0), (33.0, 39.0))
"""Two points (y, z) of the roof of the notch, from the trochlea up and back."""
_NOTCH_DEPTH: Final = 15.0
_TAKEN_WALL_MM: Final = 1.4
_BETWEEN: Final = ((0.0, 22.0, -1.5), (16.0, 30.0, 8.0))
"""Center and semi-axes of what rounds the inner edges of the condyles."""
# The groove of the trochlea: degrees round the bend, distance from its middle, and the semi-axes
# of the ellipsoid across, outward and along.
_GROOVE: Final = (46.0, 45.0, (17.0, 8.5, 40.0))
_CANAL_FROM_Z: Final = 76.0


def femur(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the femur, its medial condyle touching z = 0, as far as ``cuts`` keep it."""
    stations, walls = stations_of(sizes)
    inner = within(stations, walls, closed=(False, True))
    cortex = swept("cortex", stations, "cortical bone", OUTLINE, cuts=cuts)
    spongiosa = swept("spongiosa", inner, "spongiosa", OUTLINE, cuts=cuts)
    return layered(
        Difference(type="difference", solids=(cortex, *_taken(sizes, 0.0))),
        Difference(type="difference", solids=(spongiosa, *_taken(sizes, _TAKEN_WALL_MM))),
        *_canal(sizes, cuts),
    )


def scales(sizes: Sizes) -> tuple[float, float]:
    """Return the factors across (x) and along (y and z) of the condyles."""
    return sizes.bicondylar_width / WIDTH, sizes.condylar_depth / DEPTH


def lean_x(sizes: Sizes, z: float) -> float:
    """Return x of the shaft's axis."""
    from_z = _LEAN_FROM_Z * scales(sizes)[1]
    return -math.tan(math.radians(sizes.valgus_deg)) * max(0.0, z - from_z)


def _condyle_stations(sizes: Sizes) -> list[Station]:
    """Return the sections round the bend."""
    across, along = scales(sizes)
    radius = BEND_RADIUS * along
    stations = []
    for angle_deg, half, inner, outer, _ in _CONDYLES:
        cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
        at = (0.0, BEND_YZ[0] * along - radius * cos, BEND_YZ[1] * along - radius * sin)
        reach = (inner * along - radius, outer * along - radius)
        stations.append(Station(at, (-half * across, half * across), reach))
    return stations


def shaft_rows(sizes: Sizes, zs: Sequence[float] | None = None) -> list[tuple[float, ...]]:
    """Return z, y, half-width, depth behind and in front, and the wall of the shaft.

    At the table's heights, or at those of ``zs``.
    """
    import numpy as np
    from scipy.interpolate import PchipInterpolator

    across, along = scales(sizes)
    thick, long = sizes.femur_shaft / SHAFT, sizes.femur_length / 2.0 / _SHAFT[_MIDSHAFT][0]
    table = np.array(_SHAFT)
    # From the condyles to midshaft the sizes of the one go over into those of the other.
    share = np.clip((table[:, 0] - 60.0) / 100.0, 0.0, 1.0)
    table[:, 0] *= (1.0 - share) * along + share * long
    table[:, 2] *= (1.0 - share) * across + share * thick
    table[:, (1, 3, 4)] *= ((1.0 - share) * along + share * thick)[:, None]
    table[:, 5] = np.maximum(table[:, 5] * sizes.femur_cortex, _CONDYLES[0][4])
    wanted = table[:, 0] if zs is None else np.asarray(zs)
    found = PchipInterpolator(table[:, 0], table[:, 1:])(wanted)
    return [(float(z), *map(float, row)) for z, row in zip(wanted, found, strict=True)]


def stations_of(sizes: Sizes) -> tuple[list[Station], list[float]]:
    """Return the femur's sections from the shaft's top round to the back, and the wall at each."""
    top = sizes.limb + _BEYOND_MM
    zs = [row[0] for row in shaft_rows(sizes) if row[0] < top - 20.0]
    if top - zs[-1] > 40.0:
        zs.append((top + zs[-1]) / 2.0)
    stations, walls = [], []
    for z, y, half, back, front, wall in shaft_rows(sizes, [top, *reversed(zs)]):
        # The axis stays upright, and b is -y there; the section leans.
        lean = lean_x(sizes, z)
        reach = (lean - half, lean + half)
        stations.append(Station((0.0, 0.0, z), reach, (-back - y, front - y)))
        walls.append(wall)
    return stations + _condyle_stations(sizes), walls + [row[4] for row in _CONDYLES]


def _canal(sizes: Sizes, cuts: Sequence[Cut]) -> list[Solid]:
    """Return the marrow canal: an ellipsoid along the shaft, widest at midshaft."""
    middle_z = sizes.femur_length / 2.0
    ((_, y, half, back, front, wall),) = shaft_rows(sizes, [middle_z])
    center = (lean_x(sizes, middle_z), y + (back - front) / 2.0, middle_z)
    long = middle_z - _CANAL_FROM_Z * scales(sizes)[1]
    axes = (half - wall - 0.3, (back + front) / 2.0 - wall - 0.3, long)
    return tilted_ellipsoid("marrow", center, axes, -sizes.valgus_deg, cuts)


def tilted_ellipsoid(
    name: str, center: Point, semi_axes: Point, tilt_deg: float, cuts: Sequence[Cut]
) -> list[Solid]:
    """Return a canal turned about y by an angle, if ``cuts``, not turned, leave any of it."""
    lean = math.radians(tilt_deg)
    cos, sin = math.cos(lean), math.sin(lean)

    def back(v: Point, about: Point) -> Point:
        x, y, z = (v[i] - about[i] for i in range(3))
        return (about[0] + cos * x - sin * z, about[1] + y, about[2] + sin * x + cos * z)

    upright = ellipsoid(name, center, semi_axes, "marrow")
    turned = tuple(
        Cut(point=back(cut.point, center), normal=back(cut.normal, (0.0, 0.0, 0.0))) for cut in cuts
    )
    rotate = Rotation(axis=(0.0, 1.0, 0.0), angle_deg=tilt_deg, about=center)
    kept = upright.model_copy(update={"cuts": turned})
    return [Transformed(type="transformed", solid=kept, rotate=rotate)] if is_left(kept) else []


def _taken(sizes: Sizes, wall_mm: float) -> list[Solid]:
    """Return what is taken away of the condyles, or of what is a wall's thickness inside."""
    across, along = scales(sizes)
    (x, y, z), (a, b, c) = _BETWEEN
    between = ellipsoid(
        "between the condyles" if wall_mm == 0.0 else "wall between the condyles",
        (x, y * along, z * along),
        (a * across + wall_mm, b * along + wall_mm, c * along + wall_mm),
    )
    return [_notch(sizes, wall_mm), _groove(sizes, wall_mm), between]


def _groove(sizes: Sizes, wall_mm: float) -> Solid:
    """Return the ellipsoid that makes the groove of the trochlea."""
    across, along = scales(sizes)
    angle_deg, distance, (a, b, c) = _GROOVE
    cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    y, z = BEND_YZ[0] - distance * cos, BEND_YZ[1] - distance * sin
    center = (0.0, y * along, z * along)
    axes = (a * across + wall_mm, b * along + wall_mm, c * along + wall_mm)
    upright = ellipsoid("groove" if wall_mm == 0.0 else "groove wall", center, axes)
    turned = Rotation(axis=(1.0, 0.0, 0.0), angle_deg=angle_deg, about=center)
    return Transformed(type="transformed", solid=upright, rotate=turned)


def _notch(sizes: Sizes, wall_mm: float) -> Cylinder:
    """Return what is taken away between the condyles, a wall wider than the notch."""
    along = scales(sizes)[1]
    (y0, z0), (y1, z1) = ((y * along, z * along) for y, z in _ROOF)
    length = math.hypot(y1 - y0, z1 - z0)
    along_y, along_z = (y1 - y0) / length, (z1 - z0) / length
    # Square to the roof, away from the bone: down and back.
    out_y, out_z = along_z, -along_y
    depth = _NOTCH_DEPTH * along

    def at(distance: float) -> Point:
        return (
            0.0,
            y0 + distance * along_y + depth * out_y,
            z0 + distance * along_z + depth * out_z,
        )

    return Cylinder(
        type="cylinder",
        name="notch" if wall_mm == 0.0 else "notch wall",
        start=at(-60.0),
        end=at(length + 60.0),
        semi_axes=(sizes.notch_width / 2.0 + wall_mm, depth + wall_mm),
        up=(1.0, 0.0, 0.0),
    )
