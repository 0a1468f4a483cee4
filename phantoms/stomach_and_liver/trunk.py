"""The trunk about the organs: skin, fat, muscle, the cavity, lung bases and the diaphragm's domes.

Sizes are estimates: the cavity grows with the body's surface, and in depth with the body mass
index.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from phantom.document import Cut, Ellipsoid, GeneralizedCylinder, Intersection, Point, Solid
from phantom.library import Person
from phantoms.parts import Outline, Station, layered, swept, union
from phantoms.people import muscle_scale
from phantoms.stomach_and_liver.parameters import body_surface_m2

SKIN, FAT, MUSCLE, VISCERA, LUNG = "skin", "fat", "muscle", "viscera", "lung"
SKIN_MM: Final = 2.0
MIDDLE_MM: Final = 37.0
"""Height of the middle of what is seen."""
SEEN_MM: Final = 178.0
"""How far from there the trunk goes on, up and down: more than the detector shows of its back."""
_ROOM: Final = 0.95
"""How near to the cavity's wall organs may come."""
_BEYOND_MM: Final = 30.0
"""How far the parts reach beyond the ends before they are cut."""
_OUTLINE: Final[Outline] = (
    (0.0, -1.0), (0.42, -0.94), (0.76, -0.72), (0.96, -0.34), (1.0, 0.08), (0.92, 0.5),
    (0.68, 0.84), (0.36, 0.99), (0.0, 0.95), (-0.36, 0.99), (-0.68, 0.84), (-0.92, 0.5),
    (-1.0, 0.08), (-0.96, -0.34), (-0.76, -0.72), (-0.42, -0.94),
)  # fmt: skip
# Share of the way up, and of the size there.
_TAPER: Final = ((0.0, 1.07), (0.2, 1.02), (0.4, 0.97), (0.6, 0.99), (0.8, 1.01), (1.0, 0.99))


class Trunk(NamedTuple):
    """Sizes of one person's trunk, in mm; heights are over the middle of L3."""

    half_width: float
    half_depth: float
    muscle: float
    fat: float
    bottom: float
    top: float

    @property
    def depth(self) -> float:
        """Half the depth with muscle, fat and skin."""
        return 1.01 * self.half_depth + self.muscle + self.fat + SKIN_MM

    @property
    def ends(self) -> tuple[Cut, Cut]:
        """The planes of both ends."""
        return (
            Cut(point=(0.0, 0.0, self.top), normal=(0.0, 0.0, 1.0)),
            Cut(point=(0.0, 0.0, self.bottom), normal=(0.0, 0.0, -1.0)),
        )


def trunk_of(
    person: Person,
    scale: float,
    fat_mm: float,
    *,
    reached: Sequence[tuple[float, float]],
    highest_mm: float,
) -> Trunk:
    """Return the trunk of a person, about organs that reach these places (x, y) and that height."""
    broad = (body_surface_m2(person) / 1.9) ** 0.5
    width = 133.0 * broad
    depth = 96.0 * broad * (1.0 + 0.010 * min(max(person.bmi - 25.0, -6.0), 25.0))
    tight = max(math.hypot(x / width, y / depth) for x, y in reached) / _ROOM
    room = max(tight, 1.0)
    return Trunk(
        half_width=room * width,
        half_depth=room * depth,
        muscle=13.0 * muscle_scale(person),
        fat=fat_mm,
        bottom=scale * MIDDLE_MM - SEEN_MM,
        top=max(scale * MIDDLE_MM + SEEN_MM, highest_mm + 8.0),
    )


def envelope(trunk: Trunk) -> Solid:
    """Return skin, fat, muscle and the cavity."""
    wall = trunk.muscle
    layers = (
        (SKIN, wall + trunk.fat + SKIN_MM),
        (FAT, wall + trunk.fat),
        (MUSCLE, wall),
        (VISCERA, 0.0),
    )
    return layered(*(_shell(name, name, trunk, beyond) for name, beyond in layers))


def lungs(trunk: Trunk, scale: float, highest_mm: float) -> list[Solid]:
    """Return the lung bases, heart, and the abdomen's domes that replace them again."""
    cut = Cut(point=(0.0, 0.0, scale * 70.0), normal=(0.0, 0.0, -1.0))
    bases = _shell("lung bases", LUNG, trunk, -4.0, (cut,))
    width, depth = trunk.half_width, trunk.half_depth
    left_mm = scale * 157.0
    heart = union(
        _ellipsoid(
            "heart",
            (0.2 * width, -0.3 * depth, left_mm + 16.0),
            (0.46 * width, 0.5 * depth, 46.0),
            MUSCLE,
            trunk.ends,
        ),
        _ellipsoid(
            "mediastinum",
            (0.02 * width, 0.25 * depth, left_mm + 10.0),
            (0.24 * width, 0.62 * depth, 90.0),
            VISCERA,
            trunk.ends,
        ),
    )
    domes = union(
        _ellipsoid(
            "right dome",
            (-0.5 * width, 0.0, scale * 40.0),
            (0.56 * width, 1.12 * depth, highest_mm + 6.0 - scale * 40.0),
            VISCERA,
            trunk.ends,
        ),
        _ellipsoid(
            "left dome",
            (0.5 * width, 0.04 * depth, scale * 40.0),
            (0.56 * width, 1.12 * depth, left_mm - scale * 40.0),
            VISCERA,
            trunk.ends,
        ),
        _ellipsoid(
            "middle",
            (0.0, 0.1 * depth, scale * 60.0),
            (0.5 * width, 1.0 * depth, left_mm - 12.0 - scale * 60.0),
            VISCERA,
            trunk.ends,
        ),
    )
    cavity = _shell("cavity", VISCERA, trunk, 0.0)
    return [bases, Intersection(type="intersection", solids=(layered(heart, domes), cavity))]


def _ellipsoid(
    name: str, center: Point, semi_axes: Point, material: str, cuts: tuple[Cut, ...]
) -> Ellipsoid:
    return Ellipsoid(
        type="ellipsoid",
        name=name,
        material=material,
        center=center,
        semi_axes=semi_axes,
        cuts=cuts,
    )


def _shell(
    name: str, material: str, trunk: Trunk, beyond: float, cuts: tuple[Cut, ...] = ()
) -> GeneralizedCylinder:
    rows = []
    for share, size in _TAPER:
        wide, deep = size * trunk.half_width + beyond, size * trunk.half_depth + beyond
        z = trunk.bottom - _BEYOND_MM + share * (trunk.top - trunk.bottom + 2 * _BEYOND_MM)
        rows.append(Station((0.0, 0.0, z), (-wide, wide), (-deep, deep)))
    return swept(name, rows, material, _OUTLINE, cuts=(*trunk.ends, *cuts))
