"""The upper half of tibia and fibula: plateau, spines, tuberosity, shafts.

The tibia is a generalized cylinder that a sloping plane cuts off at the plateau; two ellipsoids
rise from it as the spines, between them and around them a lower one. The fibula is one generalized
cylinder with its head.

The tables hold a man's right bones, the middle of the plateau at z = 0; they are estimates between
the published sizes that scale them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from phantom.document import Cut, Ellipsoid, Solid
from phantoms.knee.femur import tilted_ellipsoid
from phantoms.knee.sizes import Sizes
from phantoms.parts import Outline, Station, ellipsoid, is_left, layered, swept, union, within

WIDTH: Final = 75.87
DEPTH: Final = 47.75
"""Of the table's plateau, as traced."""
SHAFT: Final = 24.0
FIBULA_SHAFT: Final = 13.0
NOTCH: Final = 22.0

# In the frame (x, y): the crest in front at -1, a hollow behind, the medial side (x > 0) fuller.
OUTLINE: Final[Outline] = (
    (0.02, -1.0),
    (0.5, -0.78),
    (0.92, -0.12),
    (0.97, 0.5),
    (0.62, 0.97),
    (0.0, 0.82),
    (-0.6, 0.94),
    (-0.97, 0.48),
    (-0.92, -0.14),
    (-0.5, -0.8),
)
# z from the plateau, x of the lateral and medial border, y of front and back border, wall in mm.
_HEAD: Final = (
    (12.0, -37.0, 37.0, -11.4, 35.2, 1.4),
    (-3.0, -38.05, 38.05, -11.9, 36.3, 1.4),
    (-8.0, -37.6, 37.8, -12.0, 35.4, 1.4),
    (-17.0, -34.2, 35.4, -13.4, 32.0, 1.5),
    (-28.0, -29.0, 31.0, -16.8, 27.8, 1.7),
    (-42.0, -23.4, 25.0, -19.8, 24.4, 2.0),
    (-60.0, -18.0, 18.8, -15.8, 22.4, 2.5),
)
# z as a share of half the tibia's length, x and y of the borders, share of the cortex.
_SHAFT: Final = (
    (-0.46, -15.2, 15.4, -12.4, 21.6, 0.58),
    (-0.68, -13.2, 13.3, -10.0, 21.0, 0.84),
    (-1.0, -12.0, 12.0, -7.5, 20.0, 1.0),
    (-1.25, -12.0, 12.0, -6.5, 19.5, 1.0),
)
_MIDSHAFT: Final = 2
_PLATEAU_Y: Final = 12.0
_PLATEAU_WALL_MM: Final = 1.7
_BEYOND_MM: Final = 8.0
_CANAL_FROM_Z: Final = -62.0
# Center and semi-axes, in mm over the plateau: medial spine, lateral spine, the rise around them.
_SPINES: Final = (
    ("medial spine", (5.4, 13.0, -1.0), (3.7, 8.5, 9.2)),
    ("lateral spine", (-5.0, 15.0, -1.0), (3.6, 8.0, 7.8)),
    ("eminence", (0.2, 14.5, -1.5), (12.0, 12.0, 4.2)),
)

# z under the plateau, x and y of the axis, its radius across and from front to back.
_FIBULA_HEAD: Final = (
    (-12.2, -38.7, 36.6, 2.4, 2.5),
    (-14.0, -38.6, 36.3, 5.6, 5.8),
    (-17.6, -38.4, 35.8, 8.3, 8.5),
    (-25.0, -37.9, 34.8, 9.8, 10.0),
    (-36.0, -36.8, 33.2, 8.4, 8.7),
    (-52.0, -35.2, 31.2, 5.9, 6.3),
)
_FIBULA_SHAFT: Final = (
    (-95.0, -32.4, 28.4, 6.2, 6.5),
    (-150.0, -30.6, 27.4, 6.5, 6.6),
    (-250.0, -29.6, 27.4, 6.5, 6.6),
)
_FIBULA_INSIDE: Final = ((-37.8, 34.6, -25.0), (8.6, 8.8, 11.0))
"""Center and semi-axes of the spongiosa of the head."""
_FIBULA_NECK: Final = ((-35.3, 31.4, -51.0), (4.2, 4.6, 26.0))
"""Center and semi-axes of the marrow of the neck."""
_FIBULA_CANAL_FROM_Z: Final = -38.0


def scales(sizes: Sizes) -> tuple[float, float]:
    """Return the factors of the plateau across and from front to back."""
    return sizes.plateau_width / WIDTH, sizes.plateau_depth / DEPTH


def plateau(sizes: Sizes, down_mm: float = 0.0) -> Cut:
    """Return the plane of the plateau, or one below it."""
    slope = math.radians(sizes.slope_deg)
    normal = (0.0, math.sin(slope), math.cos(slope))
    _, along = scales(sizes)
    point = (0.0, _PLATEAU_Y * along - down_mm * normal[1], -down_mm * normal[2])
    return Cut(point=point, normal=normal)


def tibia(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the tibia, the middle of its plateau at z = 0, as far as ``cuts`` keep it."""
    stations, walls = tibia_stations(sizes)
    inner = within(stations, walls, closed=(False, False))
    top, under = plateau(sizes), plateau(sizes, _PLATEAU_WALL_MM)
    return layered(
        union(
            swept("cortex", stations, "cortical bone", OUTLINE, cuts=(top, *cuts)),
            *_spines(sizes, "cortex of the ", "cortical bone", 0.0, cuts),
        ),
        union(
            swept("spongiosa", inner, "spongiosa", OUTLINE, cuts=(under, *cuts)),
            *_spines(sizes, "spongiosa of the ", "spongiosa", 1.0, cuts),
        ),
        *_left(_canal(sizes), cuts),
    )


def tibia_stations(sizes: Sizes) -> tuple[list[Station], list[float]]:
    """Return the tibia's sections from below to over the plateau, and the wall at each."""
    import numpy as np

    across, along = scales(sizes)
    wide, half_length = sizes.tibia_shaft / SHAFT, sizes.tibia_length / 2.0
    rows: list[tuple[float, ...]] = [
        (z * along, left * across, right * across, front * along, back * along, wall)
        for z, left, right, front, back, wall in _HEAD
    ]
    rows += [
        (z * half_length, *(wide * value for value in borders), share * sizes.tibia_cortex)
        for z, *borders, share in _SHAFT
        if z * half_length < 1.25 * _HEAD[-1][0] * along
    ]
    bottom = -sizes.limb - _BEYOND_MM
    table = np.array(rows[::-1])
    last = [float(np.interp(bottom, table[:, 0], column)) for column in table.T[1:]]
    rows = [*(row for row in rows if row[0] > bottom + 18.0), (bottom, *last)]
    y = _PLATEAU_Y * along
    stations = [
        Station((0.0, y, row[0]), (row[1], row[2]), (row[3] - y, row[4] - y)) for row in rows
    ]
    # From below, so that b = t x n is +y.
    return stations[::-1], [row[5] for row in rows][::-1]


def _canal(sizes: Sizes) -> Ellipsoid:
    """Return the marrow canal: an ellipsoid along the shaft, widest at midshaft."""
    _, left, right, _, back, _ = _SHAFT[_MIDSHAFT]
    wide = sizes.tibia_shaft / SHAFT
    middle_z = -sizes.tibia_length / 2.0
    long = _CANAL_FROM_Z * scales(sizes)[1] - middle_z
    half = (right - left) / 2.0 * wide - sizes.tibia_cortex
    # The crest in front is solid; the canal is as deep as it is wide.
    y = back * wide - sizes.tibia_cortex - half - 0.8
    return ellipsoid("marrow", (0.0, y, middle_z), (half - 0.5, half - 0.3, long), "marrow")


def fibula(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the fibula, beside and behind the tibia, as far as ``cuts`` keep it."""
    across, along = scales(sizes)
    thick = sizes.fibula_shaft / FIBULA_SHAFT
    bottom = -sizes.limb - _BEYOND_MM
    rows = [
        (z * along, x * across, y * along, a * along, b * along) for z, x, y, a, b in _FIBULA_HEAD
    ]
    rows += [
        (z, x * across, y * along, a * thick, b * thick)
        for z, x, y, a, b in _FIBULA_SHAFT
        if z > bottom + 18.0
    ]
    rows.append((bottom, *rows[-1][1:]))
    x0, y0 = rows[-1][1], rows[-1][2]
    stations = [
        Station((x0, y0, z), (x - x0 - a, x - x0 + a), (-(y - y0) - b, -(y - y0) + b))
        for z, x, y, a, b in rows
    ]
    return layered(swept("cortex", stations, "cortical bone", cuts=cuts), *_in_fibula(sizes, cuts))


def _in_fibula(sizes: Sizes, cuts: Sequence[Cut]) -> list[Solid]:
    """Return the spongiosa of the head and the canal of the shaft."""
    across, along = scales(sizes)
    (x, y, z), (a, b, c) = _FIBULA_INSIDE
    center = (x * across, y * along, z * along)
    head = ellipsoid("spongiosa", center, (a * along, b * along, c * along), "spongiosa")
    end = _FIBULA_CANAL_FROM_Z * along
    low_z = min(-0.5 * sizes.tibia_length, end - 60.0)
    low_x, low_y = (
        factor * float(_between(low_z, column)) for factor, column in ((across, 1), (along, 2))
    )
    high_x, high_y = -36.4 * across, 32.8 * along
    # From the head's neck down the middle of the shaft.
    tilt = math.degrees(math.atan2(high_x - low_x, end - low_z))
    radius = sizes.fibula_shaft / 2.0 - sizes.fibula_cortex
    middle = (low_x, (low_y + 0.25 * (high_y - low_y)), low_z)
    canal = tilted_ellipsoid("marrow", middle, (radius, radius, end - low_z), tilt, cuts)
    x, y, z = _FIBULA_NECK[0]
    a, b, c = _FIBULA_NECK[1]
    center = (x * across, y * along, z * along)
    axes = (a * along, b * along, c * along)
    neck = tilted_ellipsoid("marrow of the neck", center, axes, tilt, cuts)
    return [*_left(head, cuts), *neck, *canal]


def _left(solid: Ellipsoid, cuts: Sequence[Cut]) -> list[Ellipsoid]:
    """Return what planes leave of an ellipsoid, if anything."""
    kept = solid.model_copy(update={"cuts": tuple(cuts)})
    return [kept] if is_left(kept) else []


def _between(z: float, column: int) -> float:
    """Return x or y of the fibula's axis in the table, at a height."""
    rows = sorted((*_FIBULA_HEAD, *_FIBULA_SHAFT))
    for low, high in pairwise(rows):
        if z <= high[0]:
            share = max(0.0, (z - low[0]) / (high[0] - low[0]))
            return low[column] + share * (high[column] - low[column])
    return rows[-1][column]


def _spines(
    sizes: Sizes, prefix: str, material: str, wall_mm: float, cuts: Sequence[Cut]
) -> list[Solid]:
    """Return what rises over the plateau, a wall's thickness inside."""
    across, along = scales(sizes)
    # The spines stand in the notch.
    across = min(across, sizes.notch_width / NOTCH)
    slope = math.tan(math.radians(sizes.slope_deg))
    found: list[Solid] = []
    for name, (x, y, z), (a, b, c) in _SPINES:
        fall = (y - _PLATEAU_Y) * along * slope
        solid = ellipsoid(
            prefix + name,
            (x * across, y * along, z * along - fall),
            (a * across - wall_mm, b * along - wall_mm, c * along - wall_mm),
            material,
        )
        found += _left(solid, cuts)
    return found
