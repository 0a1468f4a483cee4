"""The upper half of tibia and fibula: heads, tuberosity, shafts.

The tibia is a generalized cylinder that leans back toward the sloping plateau and is round at its
rim; facets are hollowed from it, and the eminence rises from it. The fibula is another, with neck,
head and styloid.

The tables hold a man's right bones, the middle of the plateau at z = 0; they are estimates between
the published sizes that scale them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from phantom.document import Cut, Difference, Ellipsoid, Solid
from phantoms.draws import generator_of
from phantoms.knee.femur import tilted_ellipsoid
from phantoms.knee.plateau import MIDDLE_Y, PLATEAU_WALL_MM, eminence, facets, scales
from phantoms.knee.sizes import Sizes
from phantoms.knee.trabeculae import Region, plates, solids_of
from phantoms.parts import (
    Outline,
    Station,
    ellipsoid,
    is_left,
    layered,
    round_station,
    swept,
    union,
    within,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

SHAFT: Final = 24.0
FIBULA_SHAFT: Final = 13.0

# In the frame (x, y): the crest in front at -1, a hollow behind, the medial side (x > 0) fuller.
OUTLINE: Final[Outline] = (
    (0.02, -1.0),
    (0.5, -0.78),
    (0.92, -0.12),
    (0.97, 0.5),
    (0.64, 0.9),
    (0.1, 1.0),
    (-0.55, 0.93),
    (-0.97, 0.48),
    (-0.92, -0.14),
    (-0.5, -0.8),
)
# Under the plateau, x of the lateral and medial border, y of front and back border, wall in mm. The
# rim is round.
_HEAD: Final = (
    (0.0, -34.0, 34.0, -7.8, 32.4, 1.2),
    (1.0, -36.4, 36.4, -10.4, 34.8, 1.2),
    (4.4, -38.05, 38.05, -12.0, 36.3, 1.0),
    (9.5, -37.4, 37.6, -12.2, 35.4, 1.0),
    (18.0, -33.8, 35.0, -13.4, 31.8, 1.2),
    (29.0, -28.4, 30.4, -16.4, 27.8, 1.5),
    (42.0, -23.2, 24.8, -19.4, 24.4, 1.9),
    (60.0, -18.0, 18.8, -15.8, 22.4, 2.5),
)
_LEANS: Final = (2.0, 20.0)
"""Under the plateau, where the axis stops to lean with it, and from where on it is upright."""
# z as a share of half the tibia's length, x and y of the borders, share of the cortex.
_SHAFT: Final = (
    (-0.46, -15.2, 15.4, -12.4, 21.6, 0.58),
    (-0.68, -13.2, 13.3, -10.0, 21.0, 0.84),
    (-1.0, -12.0, 12.0, -7.5, 20.0, 1.0),
    (-1.25, -12.0, 12.0, -6.5, 19.5, 1.0),
)
_MIDSHAFT: Final = 2
_BEYOND_MM: Final = 8.0
_PLATES: Final = 56
"""Trabeculae under the plateau."""
_PLATES_Z: Final = (-66.0, -3.4)
_PLATES_Y: Final = 19.0
"""How far from the middle of the plateau they are at most."""
_SPREAD_PER_MM: Final = 0.006
_CANAL_FROM_Z: Final = -62.0
# z under the plateau, x and y of the axis, its radius across and from front to back, the wall; the
# styloid is at the back of the head.
_FIBULA_HEAD: Final = (
    (-9.8, -36.6, 38.6, 1.5, 1.7, 1.0),
    (-12.6, -36.4, 37.6, 4.0, 4.4, 1.0),
    (-18.6, -36.0, 36.0, 8.3, 8.6, 1.0),
    (-27.0, -35.4, 34.9, 9.9, 10.2, 1.0),
    (-37.0, -34.8, 33.4, 8.3, 8.8, 1.1),
    (-49.0, -33.7, 31.7, 6.4, 6.8, 1.6),
)
_FIBULA_SHAFT: Final = (
    (-68.0, -32.4, 30.0, 5.7, 6.2, 0.8),
    (-100.0, -31.4, 28.6, 6.0, 6.4, 1.0),
    (-160.0, -30.4, 27.4, 6.5, 6.6, 1.0),
    (-250.0, -29.6, 27.4, 6.5, 6.6, 1.0),
)
_FIBULA_CANAL_FROM_Z: Final = -44.0


def tibia(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the tibia, the middle of its plateau at z = 0, as far as ``cuts`` keep it."""
    stations, walls = tibia_stations(sizes)
    inner = within(stations, walls, closed=(False, True))
    bone = swept("cortex", stations, "cortical bone", OUTLINE, cuts=cuts)
    spongy = swept("spongiosa", inner, "spongiosa", OUTLINE, cuts=cuts)
    return layered(
        union(
            Difference(type="difference", solids=(bone, *facets(sizes, 0.0))),
            *eminence(sizes, 0.0, cuts),
        ),
        union(
            Difference(type="difference", solids=(spongy, *facets(sizes, PLATEAU_WALL_MM))),
            *eminence(sizes, PLATEAU_WALL_MM, cuts),
        ),
        *solids_of(_trabeculae(sizes, inner), cuts),
        *_left(_canal(sizes), cuts),
    )


def _trabeculae(sizes: Sizes, inner: Sequence[Station]) -> list[FloatArray]:
    """Return upright plates under the plateau, which lean out with the borders."""
    import numpy as np

    across, along = scales(sizes)
    _, generator = generator_of(sizes.trabecular_seed).spawn(2)
    # The plateau falls away behind; plates end under what is lowest of it.
    fall = _PLATES_Y * along * math.tan(math.radians(sizes.slope_deg))
    low, high = (z * along for z in _PLATES_Z)

    def upright(points: FloatArray) -> FloatArray:
        found = np.zeros_like(points)
        found[:, 0], found[:, 2] = _SPREAD_PER_MM * points[:, 0] / across, 1.0
        return found

    return plates(Region(inner, "z", 0.79, (low, high - fall)), _PLATES, upright, generator, along)


def tibia_stations(sizes: Sizes) -> tuple[list[Station], list[float]]:
    """Return the tibia's sections from below to the plateau, and the wall at each."""
    import numpy as np

    across, along = scales(sizes)
    wide, half_length = sizes.tibia_shaft / SHAFT, sizes.tibia_length / 2.0
    rows: list[tuple[float, ...]] = [
        (-down * along, left * across, right * across, front * along, back * along, wall)
        for down, left, right, front, back, wall in _HEAD
    ]
    rows += [
        (z * half_length, *(wide * value for value in borders), share * sizes.tibia_cortex)
        for z, *borders, share in _SHAFT
        if z * half_length < 1.25 * rows[-1][0]
    ]
    bottom = -sizes.limb - _BEYOND_MM
    table = np.array(rows[::-1])
    last = [float(np.interp(bottom, table[:, 0], column)) for column in table.T[1:]]
    rows = [*(row for row in rows if row[0] > bottom + 18.0), (bottom, *last)]
    stations = []
    for z, left, right, front, back, _ in rows:
        y, at_z, upright = _axis(sizes, -z)
        # Where the axis leans, borders go with it.
        middle = MIDDLE_Y * along * (1.0 - upright) + y * upright
        stations.append(Station((0.0, y, at_z), (left, right), (front - middle, back - middle)))
    # From below, so that b = t x n is +y.
    return stations[::-1], [row[5] for row in rows][::-1]


def _axis(sizes: Sizes, down_mm: float) -> tuple[float, float, float]:
    """Return y and z of the axis so far down it, and how far it has come upright (0 to 1)."""
    import numpy as np

    along = scales(sizes)[1]
    start, end = (at * along for at in _LEANS)
    steps = np.linspace(0.0, down_mm, 101)
    share = np.clip((steps - start) / (end - start), 0.0, 1.0)
    lean = math.radians(sizes.slope_deg) * (1.0 - share)
    y = MIDDLE_Y * along - float(np.trapezoid(np.sin(lean), steps))
    return y, -float(np.trapezoid(np.cos(lean), steps)), float(share[-1])


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
        (z * along, x * across, y * along, a * along, b * along, wall)
        for z, x, y, a, b, wall in _FIBULA_HEAD
    ]
    rows += [
        (z, x * across, y * along, a * thick, b * thick, share * sizes.fibula_cortex)
        for z, x, y, a, b, share in _FIBULA_SHAFT
        if bottom + 18.0 < z < rows[-1][0] - 10.0
    ]
    rows.append((bottom, *rows[-1][1:]))
    stations = [round_station((x, y, z), a, b) for z, x, y, a, b, _ in rows]
    inner = within(stations, [row[5] for row in rows], closed=(True, False))
    return layered(
        swept("cortex", stations, "cortical bone", cuts=cuts),
        swept("spongiosa", inner, "spongiosa", cuts=cuts),
        *_fibula_canal(sizes, rows, cuts),
    )


def _fibula_canal(
    sizes: Sizes, rows: Sequence[tuple[float, ...]], cuts: Sequence[Cut]
) -> list[Solid]:
    """Return the canal: a long ellipsoid from the neck to the middle of the shaft."""
    _, along = scales(sizes)
    end = _FIBULA_CANAL_FROM_Z * along
    _, high_x, high_y, *_ = rows[len(_FIBULA_HEAD) - 1]
    low_z, low_x, low_y, *_ = rows[-1]
    low_z = min(low_z, -0.5 * sizes.tibia_length)
    tilt = math.degrees(math.atan2(high_x - low_x, end - low_z))
    radius = sizes.fibula_shaft / 2.0 - sizes.fibula_cortex
    middle = (low_x, low_y + 0.25 * (high_y - low_y), low_z)
    return tilted_ellipsoid("marrow", middle, (radius, radius, end - low_z), tilt, cuts)


def _left(solid: Ellipsoid, cuts: Sequence[Cut]) -> list[Ellipsoid]:
    """Return what planes leave of an ellipsoid, if anything."""
    kept = solid.model_copy(update={"cuts": tuple(cuts)})
    return [kept] if is_left(kept) else []
