"""What is around the bones: skin, fat, muscle, tendons, fat pads and cartilage (estimates).

Skin, fat and muscle are generalized cylinders with elliptic sections; how thick each is over the
bones is tabled for a man of the median weight. Tendons, pads and cartilage are quadrics.
"""

from __future__ import annotations

from typing import Final

from phantom.document import Cylinder, Point, Solid
from phantoms.knee import condyles, plateau
from phantoms.knee.placing import Placed
from phantoms.knee.sizes import Sizes
from phantoms.parts import Station, ellipsoid, swept

SKIN_MM: Final = 1.8
_LEAST_FAT_MM: Final = 1.0
_HOLLOW_MM: Final = 2.0

# z; how far bones reach to the right, left, front and back; how far muscle lies over them there;
# the fat over that at the sides and behind, and in front, as a share of the person's.
_ROWS: Final = (
    (-235.0, (-36.0, 12.0, -8.0, 34.0), (15.0, 36.0, 5.0, 36.0), 0.8, 0.4),
    (-150.0, (-37.0, 12.0, -8.5, 34.0), (17.0, 40.0, 5.0, 41.0), 0.8, 0.3),
    (-115.0, (-38.0, 13.0, -9.0, 34.0), (17.0, 40.0, 5.5, 42.0), 0.8, 0.3),
    (-75.0, (-41.0, 17.0, -12.0, 36.0), (15.0, 34.0, 8.0, 34.0), 0.7, 0.4),
    (-38.0, (-47.0, 27.0, -20.0, 44.0), (11.0, 22.0, 6.0, 20.0), 0.7, 0.4),
    (0.0, (-46.0, 45.0, -31.0, 41.0), (6.0, 6.0, 3.0, 16.0), 0.9, 0.5),
    (33.0, (-45.0, 45.0, -43.0, 38.0), (7.0, 7.0, 3.0, 18.0), 1.0, 0.4),
    (62.0, (-34.0, 28.0, -20.0, 20.0), (22.0, 28.0, 24.0, 38.0), 1.1, 0.7),
    (100.0, (-22.0, 12.0, -16.0, 14.0), (42.0, 50.0, 36.0, 50.0), 1.2, 0.9),
    (150.0, (-26.0, 6.0, -17.0, 12.0), (48.0, 60.0, 46.0, 58.0), 1.2, 1.1),
    (235.0, (-34.0, -2.0, -17.0, 12.0), (56.0, 74.0, 56.0, 66.0), 1.3, 1.2),
)


def envelope(sizes: Sizes) -> list[Solid]:
    """Return skin, fat and muscle, each inside the one before."""
    layers = (("skin", 1.0, SKIN_MM), ("fat", 1.0, 0.0), ("muscle", 0.0, 0.0))
    return [
        swept(name, [_station(sizes, row, fat, more) for row in _rows(sizes)], name)
        for name, fat, more in layers
    ]


def _rows(sizes: Sizes) -> list[tuple[float, ...]]:
    """Return the table from below, its ends at those of the limb."""
    import numpy as np

    table = np.array([(z, *bones, *over, side, front) for z, bones, over, side, front in _ROWS])
    inside = [float(z) for z in table[:, 0] if abs(z) < sizes.limb - 15.0]
    zs = [-sizes.limb, *inside, sizes.limb]
    columns = [np.interp(zs, table[:, 0], column) for column in table.T[1:]]
    return [tuple(map(float, row)) for row in zip(zs, *columns, strict=True)]


def _station(sizes: Sizes, row: tuple[float, ...], fat: float, more_mm: float) -> Station:
    across, along = (
        max(pair) for pair in zip(condyles.scales(sizes), plateau.scales(sizes), strict=True)
    )
    z, right, left, front, back, *over, fat_side, fat_front = row
    muscle = [sizes.muscle * value for value in over]
    side = fat * max(sizes.fat * fat_side, _LEAST_FAT_MM) + more_mm
    before = fat * max(sizes.fat * fat_front, _LEAST_FAT_MM) + more_mm
    # What is thin over bone stays as thick on slight people.
    thin = [max(m, min(o, 6.0)) for m, o in zip(muscle, over, strict=True)]
    return Station(
        (0.0, 0.0, z),
        (right * across - thin[0] - side, left * across + thin[1] + side),
        (front * along - thin[2] - before, back * along + thin[3] + side),
    )


def inner_parts(sizes: Sizes, at: Placed) -> list[Solid]:
    """Return fat pads, tendons and cartilage."""
    across, along = condyles.scales(sizes)
    _, ridge_y, ridge_z = at.ridge
    top, apex = ridge_z + sizes.patella_height / 2.0, ridge_z - sizes.patella_height / 2.0
    front = ridge_y - sizes.patella_thickness
    tuberosity = (-1.0, -21.5 * along, at.plateau_z - 42.0 * along)

    behind = min(9.0, 8.0 * sizes.muscle)

    def lift(z: float) -> float:
        return z * along + at.femur_z

    def pad(name: str, center: Point, axes: Point) -> Solid:
        scaled = (axes[0] * across, axes[1] * along, axes[2] * along)
        return ellipsoid(name, center, scaled, "fat")

    return [
        pad("suprapatellar fat pad", (0.0, ridge_y - 8.5 * along, top + 11.0), (22.0, 6.0, 12.0)),
        pad("prefemoral fat pad", (-2.0, -23.0 * along, lift(76.0)), (22.0, 4.4, 26.0)),
        pad("infrapatellar fat pad", (0.0, -19.0 * along, lift(3.0)), (19.0, 10.5, 17.0)),
        ellipsoid(
            "popliteal fat",
            (0.0, 41.0 * along + behind, lift(18.0)),
            (17.0 * across, behind, 26.0 * along),
            "fat",
        ),
        _band(
            "quadriceps tendon",
            (0.0, front + 9.0 * along, top - 4.0),
            (-4.0, -17.0 * along - 19.0 * sizes.muscle, lift(112.0)),
            (15.0 * across, 3.4),
        ),
        _band(
            "patellar tendon", (0.0, ridge_y - 12.5 * along, apex + 5.0), tuberosity, (12.0, 2.7)
        ),
        _tibiofemoral_cartilage(sizes, at.plateau_z),
    ]


def _band(name: str, start: Point, end: Point, semi_axes: tuple[float, float]) -> Cylinder:
    return Cylinder(
        type="cylinder",
        name=name,
        material="tendon",
        start=start,
        end=end,
        semi_axes=semi_axes,
        up=(1.0, 0.0, 0.0),
    )


def _tibiofemoral_cartilage(sizes: Sizes, plateau_z: float) -> Cylinder:
    """Return the disc between the bones: both layers of cartilage, and the menisci around them."""
    plane = plateau.plane(sizes)
    nx, ny, nz = plane.normal
    x, y, z = plane.point[0], plane.point[1], plane.point[2] + plateau_z
    thick = sizes.joint_space + 2.0
    return Cylinder(
        type="cylinder",
        name="tibiofemoral cartilage",
        material="cartilage",
        # The facets are hollow; what is not is bone.
        start=(x - _HOLLOW_MM * nx, y - _HOLLOW_MM * ny, z - _HOLLOW_MM * nz),
        end=(x + thick * nx, y + thick * ny, z + thick * nz),
        semi_axes=(0.465 * sizes.plateau_width, 0.45 * sizes.plateau_depth),
        up=(1.0, 0.0, 0.0),
    )
