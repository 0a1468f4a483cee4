"""The lower half of the femur: shaft, metaphysis and epicondyles, with the condyles below.

One upright generalized cylinder is shaft, flare and epicondyles, its front the groove of the
trochlea; a plane cuts its end to the roof of the notch (Blumensaat's line from the side). The
condyles stand in it. The bone's outside is all of them in cortical bone; the inside is all of them
a wall's thickness smaller, in place of whatever was there, so that no wall is left inside the bone.

The tables hold a man's right femur whose medial condyle touches z = 0; they are estimates between
the published sizes that scale them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from phantom.document import Cut, Cylinder, Difference, Point, Rotation, Solid, Transformed
from phantoms.draws import generator_of
from phantoms.knee.condyles import INSIDE, OUTSIDE, WALL_MM, condyles, scales, wheel
from phantoms.knee.sizes import Sizes
from phantoms.knee.trabeculae import Region, plates, solids_of
from phantoms.parts import Outline, Station, ellipsoid, is_left, layered, swept, union, within

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

SHAFT: Final = 26.5

# In the frame (x, forward): the groove of the trochlea in front (b = 1), the medial side x > 0.
OUTLINE: Final[Outline] = (
    (0.0, 0.85),
    (0.53, 1.0),
    (0.88, 0.55),
    (0.9, -0.42),
    (0.5, -0.95),
    (0.0, -1.0),
    (-0.5, -0.95),
    (-0.9, -0.42),
    (-0.89, 0.55),
    (-0.54, 0.98),
)
# z; x of the lateral and the medial border; y of front and back; the wall as a share of that at
# midshaft.
_ROWS: Final = (
    (6.0, -22.0, 22.0, 8.0, 18.5, 0.1),
    (14.0, -35.0, 35.0, -8.0, 20.0, 0.1),
    (23.0, -42.0, 42.4, -14.4, 22.5, 0.1),
    (33.0, -43.8, 44.3, -17.6, 22.8, 0.12),
    (46.0, -36.6, 38.6, -19.0, 21.2, 0.17),
    (60.0, -28.2, 29.4, -18.8, 17.6, 0.24),
    (80.0, -20.7, 20.7, -17.1, 15.7, 0.38),
    (104.0, -16.8, 16.8, -16.4, 13.8, 0.60),
    (160.0, -14.0, 14.0, -16.8, 11.4, 0.90),
    (224.0, -13.25, 13.25, -17.0, 10.6, 1.0),
    (260.0, -13.25, 13.25, -16.6, 11.0, 1.0),
)
_CONDYLES_TO_Z, _MIDSHAFT_Z = 60.0, 224.0
_LEAN_FROM_Z: Final = 55.0
_BEYOND_MM: Final = 8.0
"""The shaft is drawn this much longer than the limb, to be cut level with it."""
_ROOF: Final = ((4.0, 6.0), (23.0, 33.0))
"""Two points (y, z) of the top of the notch's roof, from the trochlea up and back."""
_NOTCH_DEPTH: Final = 13.0
_NOTCH_WIDER_MM: Final = 1.5
"""How far the notch goes into each condyle, which fills it."""
_CANAL_FROM_Z: Final = 76.0
_PLATES: Final = (30, 20)
"""Trabeculae over the notch and in each condyle; where from, what is between, where to."""
_PLATES_Z: Final = (2.0, 36.0, 100.0)
_FAN_Z: Final = 125.0
"""Where their lines would meet."""


def femur(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the femur, its medial condyle touching z = 0, as far as ``cuts`` keep it."""
    stations, walls = stations_of(sizes)
    inner = within(stations, walls, closed=(False, True))
    denser = solids_of(_trabeculae(sizes, inner), cuts)
    # A break is through the shaft: a piece has both condyles, whole, or none.
    below = all(cut.normal[2] > 0.0 for cut in cuts)
    outside = condyles(sizes, "cortex", OUTSIDE) if below else []
    inside = condyles(sizes, "spongiosa", INSIDE) if below else []
    bone = swept("cortex", stations, "cortical bone", OUTLINE, cuts=cuts)
    spongy = swept("spongiosa", inner, "spongiosa", OUTLINE, cuts=cuts)
    return layered(
        union(Difference(type="difference", solids=(bone, _notch(sizes, 0.0))), *outside),
        union(Difference(type="difference", solids=(spongy, _notch(sizes, WALL_MM))), *inside),
        *denser,
        *_canal(sizes, cuts),
    )


def _trabeculae(sizes: Sizes, inner: Sequence[Station]) -> list[FloatArray]:
    """Return plates that spread from the shaft into the condyles like a fan."""
    import numpy as np

    along = scales(sizes)[1]
    generator, *_ = generator_of(sizes.trabecular_seed).spawn(2)
    low, between, high = (z * along for z in _PLATES_Z)

    def fan(points: FloatArray) -> FloatArray:
        return np.array([0.0, 0.0, _FAN_Z * along]) - points

    found = plates(Region(inner, "z", 0.78, (between, high)), _PLATES[0], fan, generator, along)
    region = Region(wheel(sizes).inside, "x", 0.72, (low, 2.0 * between))
    for side in (1.0, -1.0):
        mirror = np.array([[side], [1.0], [1.0]])
        drawn = plates(region, _PLATES[1], fan, generator, along)
        found += [mirror * plate for plate in drawn]
    return found


def lean_x(sizes: Sizes, z: float) -> float:
    """Return x of the shaft's axis."""
    from_z = _LEAN_FROM_Z * scales(sizes)[1]
    return -math.tan(math.radians(sizes.valgus_deg)) * max(0.0, z - from_z)


def shaft_rows(sizes: Sizes, zs: Sequence[float] | None = None) -> list[tuple[float, ...]]:
    """Return z, the lateral and medial border, front and back, and the wall of the shaft.

    At the table's heights, or at those of ``zs``; borders are from the shaft's leaning axis.
    """
    import numpy as np
    from scipy.interpolate import PchipInterpolator

    across, along = scales(sizes)
    thick, long = sizes.femur_shaft / SHAFT, sizes.femur_length / 2.0 / _MIDSHAFT_Z
    table = np.array(_ROWS)
    # From the condyles to midshaft the sizes of the one go over into those of the other.
    share = np.clip((table[:, 0] - _CONDYLES_TO_Z) / 100.0, 0.0, 1.0)
    table[:, 0] *= (1.0 - share) * along + share * long
    table[:, (1, 2)] *= ((1.0 - share) * across + share * thick)[:, None]
    table[:, (3, 4)] *= ((1.0 - share) * along + share * thick)[:, None]
    table[:, 5] = np.maximum(table[:, 5] * sizes.femur_cortex, WALL_MM)
    wanted = table[:, 0] if zs is None else np.asarray(zs)
    found = PchipInterpolator(table[:, 0], table[:, 1:])(wanted)
    return [(float(z), *map(float, row)) for z, row in zip(wanted, found, strict=True)]


def stations_of(sizes: Sizes) -> tuple[list[Station], list[float]]:
    """Return the sections from the shaft's top down to the notch, and the wall at each."""
    top = sizes.limb + _BEYOND_MM
    zs = [row[0] for row in shaft_rows(sizes) if row[0] < top - 20.0]
    if top - zs[-1] > 40.0:
        zs.append((top + zs[-1]) / 2.0)
    stations, walls = [], []
    for z, lateral, medial, front, back, wall in shaft_rows(sizes, [top, *reversed(zs)]):
        # The axis stays upright, and b is -y there; the section leans.
        lean = lean_x(sizes, z)
        reach = (lean + lateral, lean + medial)
        stations.append(Station((0.0, 0.0, z), reach, (-back, -front)))
        walls.append(wall)
    return stations, walls


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
        name="notch" if wall_mm == 0.0 else "wall of the notch",
        start=at(-60.0),
        end=at(length + 60.0),
        semi_axes=(sizes.notch_width / 2.0 + _NOTCH_WIDER_MM + wall_mm, depth + wall_mm),
        up=(1.0, 0.0, 0.0),
    )


def _canal(sizes: Sizes, cuts: Sequence[Cut]) -> list[Solid]:
    """Return the marrow canal: an ellipsoid along the shaft, widest at midshaft."""
    middle_z = sizes.femur_length / 2.0
    ((_, lateral, medial, front, back, wall),) = shaft_rows(sizes, [middle_z])
    center = (lean_x(sizes, middle_z), (front + back) / 2.0, middle_z)
    long = middle_z - _CANAL_FROM_Z * scales(sizes)[1]
    axes = ((medial - lateral) / 2.0 - wall - 0.3, (back - front) / 2.0 - wall - 0.3, long)
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
