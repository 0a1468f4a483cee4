"""The lumbar spine and the last thoracic vertebrae, simplified; the lower ribs; the psoas.

The fifth lumbar vertebra's heights and pedicles are published means (International Journal of Spine
Surgery: heights 30.7 and 29.6 mm in front, pedicles 13.1 by 16.6 and 12.5 by 15.1 mm in men and
women); all else is an estimate. Sizes are for the mean adult and grow with stature.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from phantom.document import Cone, Cylinder, Point, Solid
from phantoms.parts import (
    Station,
    ellipsoid,
    layered,
    named,
    round_station,
    swept,
    union,
    within,
)
from phantoms.stomach_and_liver.trunk import MUSCLE, Trunk

CORTEX, SPONGIOSA = "cortical bone", "spongiosa"
_SHELL_MM: Final = 0.7
_ARCH_SHELL_MM: Final = 0.6
_RIB_SECTIONS: Final = 8


class Vertebra(NamedTuple):
    """A vertebra: the middle of its body (y, z), sizes of the body, and its processes, in mm."""

    y: float
    z: float
    width: float
    depth: float
    height: float
    pedicle: tuple[float, float]
    apart: float
    reach: float


VERTEBRAE: Final[dict[str, Vertebra]] = {
    "T9": Vertebra(43.0, 198.0, 33.0, 28.0, 21.5, (6.0, 13.0), 11.0, 27.0),
    "T10": Vertebra(42.0, 169.0, 35.5, 29.0, 22.5, (6.5, 14.0), 11.5, 26.0),
    "T11": Vertebra(41.0, 138.5, 38.0, 30.0, 24.0, (7.0, 15.0), 12.0, 23.0),
    "T12": Vertebra(39.0, 107.0, 41.0, 31.0, 25.5, (7.5, 15.0), 12.5, 24.0),
    "L1": Vertebra(35.0, 72.0, 42.5, 32.0, 26.5, (8.0, 15.0), 12.5, 35.0),
    "L2": Vertebra(31.0, 36.0, 44.0, 33.0, 27.0, (8.5, 14.5), 13.0, 40.0),
    "L3": Vertebra(29.0, -1.0, 45.5, 34.0, 27.5, (10.0, 14.0), 14.0, 45.0),
    "L4": Vertebra(31.0, -38.5, 47.5, 35.0, 27.5, (12.0, 14.0), 15.5, 42.0),
    "L5": Vertebra(37.0, -76.5, 50.0, 35.2, 29.6, (15.8, 12.8), 18.0, 42.0),
}
# A body's outline in the frame (x, back): hollow behind.
_BODY: Final = (
    (0.0, -1.0), (0.42, -0.93), (0.8, -0.62), (1.0, -0.06), (0.92, 0.5), (0.6, 0.92),
    (0.26, 0.96), (0.0, 0.88), (-0.26, 0.96), (-0.6, 0.92), (-0.92, 0.5), (-1.0, -0.06),
    (-0.8, -0.62), (-0.42, -0.93),
)  # fmt: skip
# Share of the height, and of the width there.
_WAIST: Final = (
    (-0.5, 0.93), (-0.47, 0.985), (-0.42, 1.0), (-0.3, 0.945), (-0.12, 0.895), (0.0, 0.885),
    (0.12, 0.895), (0.3, 0.945), (0.42, 1.0), (0.47, 0.985), (0.5, 0.93),
)  # fmt: skip


def spine(scale: float) -> list[Solid]:
    """Return the vertebrae, each named."""
    return [named(name, _vertebra(bone, scale)) for name, bone in VERTEBRAE.items()]


def _vertebra(bone: Vertebra, scale: float) -> Solid:
    y, z, width, depth, height = (scale * value for value in bone[:5])
    rows = [
        Station(
            (0.0, y, z + at * height),
            (-share * width / 2, share * width / 2),
            (-share * depth / 2, share * depth / 2),
        )
        for at, share in _WAIST
    ]
    body = swept("body", rows, CORTEX, _BODY)
    inside = swept("spongiosa", within(rows, scale * _SHELL_MM, count=9), SPONGIOSA, _BODY)
    wide, high = (scale * value / 2 for value in bone.pedicle)
    back, apart, reach = y + depth / 2, scale * bone.apart, scale * bone.reach
    arch: list[Solid] = []
    cores: list[Solid] = []
    for side, sign in (("right", -1.0), ("left", 1.0)):
        x = sign * apart
        up = z + 0.16 * height
        ends = ((x, back - 4.0 * scale, up), (1.1 * x, back + 11.0 * scale, up))
        arch.append(_tube(f"{side} pedicle", ends, (wide, high), CORTEX))
        inner = ((ends[0][0], ends[0][1] - 0.5, up), (ends[1][0], ends[1][1] - 1.0, up))
        hollow = (wide - _ARCH_SHELL_MM, high - _ARCH_SHELL_MM)
        cores.append(_tube(f"{side} pedicle spongiosa", inner, hollow, SPONGIOSA))
        root: Point = (sign * 0.9 * apart, back + 12.0 * scale, up - 1.0 * scale)
        tip: Point = (sign * reach, back + 17.0 * scale, up + 2.0 * scale)
        shell, core = (
            Cone(
                type="cone",
                name=f"{side} transverse {part}",
                material=material,
                start=root,
                end=tip,
                start_radius=5.4 * scale - less,
                end_radius=3.6 * scale - less,
            )
            for part, material, less in (
                ("process", CORTEX, 0.0),
                ("spongiosa", SPONGIOSA, _ARCH_SHELL_MM),
            )
        )
        arch.append(shell)
        cores.append(core)
        arch += [
            ellipsoid(
                f"{side} {which} joint process",
                (x * wide_, back + deep_ * scale, z + far * height),
                (4.2 * scale, 4.2 * scale, 9.0 * scale),
                SPONGIOSA,
            )
            for which, far, wide_, deep_ in (("upper", 0.5, 1.4, 14.5), ("lower", -0.6, 0.85, 24.5))
        ]
        arch.append(
            ellipsoid(
                f"{side} lamina",
                (x * 0.62, back + 23.0 * scale, z - 0.22 * height),
                (8.6 * scale, 4.4 * scale, 11.0 * scale),
                SPONGIOSA,
            )
        )
    spinous = (0.0, back + 36.0 * scale, z - 0.42 * height)
    half = (3.3 * scale, 14.0 * scale, 8.5 * scale)
    arch.append(ellipsoid("spinous process", spinous, half, CORTEX))
    core_half = (half[0] - 0.45, half[1] - 0.45, half[2] - 0.45)
    cores.append(ellipsoid("spinous spongiosa", spinous, core_half, SPONGIOSA))
    return layered(union(*arch), union(*cores), body, inside)


def _tube(
    name: str, ends: tuple[Point, Point], semi_axes: tuple[float, float], material: str
) -> Solid:
    return Cylinder(
        type="cylinder",
        name=name,
        material=material,
        start=ends[0],
        end=ends[1],
        semi_axes=semi_axes,
        up=(1.0, 0.0, 0.0),
    )


# Height at the spine, angle from the back at which a rib ends, and how far it falls on the way.
_RIBS: Final = {
    "8": (226.0, 132.0, 118.0),
    "9": (196.0, 128.0, 118.0),
    "10": (164.0, 118.0, 112.0),
    "11": (134.0, 92.0, 92.0),
    "12": (106.0, 52.0, 54.0),
}


# The head and the neck: across from the middle, back, over the rib's height, half its own height.
_NECK: Final = ((22.0, 46.0, 4.0, 4.0), (30.0, 60.0, 3.0, 5.0), (41.0, 74.0, 0.0, 5.6))
_FIRST_DEG: Final = 30.0
"""Angle from the back at which a rib has reached the wall."""


def ribs(scale: float, trunk: Trunk) -> list[Solid]:
    """Return the lower ribs, in the wall about the cavity."""
    made: list[Solid] = []
    for number, (start_z, end_deg, fall) in _RIBS.items():
        for side, sign in (("right", -1.0), ("left", 1.0)):
            rows = [
                round_station(
                    (sign * scale * x, scale * y, scale * (start_z + up)), scale * half, scale * 3.0
                )
                for x, y, up, half in _NECK
            ]
            for index in range(_RIB_SECTIONS + 1):
                share = index / _RIB_SECTIONS
                angle = math.radians(_FIRST_DEG + share * (end_deg - _FIRST_DEG))
                x = sign * (trunk.half_width + 5.0) * math.sin(angle)
                y = (trunk.half_depth + 5.0) * math.cos(angle)
                z = scale * (start_z - 8.0 - fall * math.sin(math.pi / 2 * share) ** 1.3)
                size = 0.55 if index == _RIB_SECTIONS else 1.0 - 0.12 * share
                rows.append(round_station((x, y, z), 6.5 * scale * size, 3.3 * scale * size))
            inner = within(rows, 0.8 * scale, least_mm=0.4)
            up = (0.0, 0.0, 1.0)
            shell = swept("cortex", rows, CORTEX, up=up, cuts=trunk.ends[:1])
            core = swept("spongiosa", inner, SPONGIOSA, up=up, cuts=trunk.ends[:1])
            made.append(named(f"{side} rib {number}", layered(shell, core)))
    return made


_PSOAS: Final = (
    (76.0, 27.0, 42.0, 4.0, 6.0),
    (64.0, 29.0, 42.0, 8.0, 10.0),
    (40.0, 33.0, 40.0, 12.0, 14.0),
    (5.0, 39.0, 37.0, 16.5, 18.5),
    (-30.0, 46.0, 35.0, 20.0, 21.0),
    (-65.0, 54.0, 32.0, 21.0, 21.0),
    (-95.0, 61.0, 26.0, 20.0, 20.0),
    (-125.0, 67.0, 18.0, 18.5, 19.0),
    (-145.0, 70.0, 12.0, 17.0, 17.0),
)


def psoas(scale: float, girth: float, trunk: Trunk) -> list[Solid]:
    """Return the psoas muscles beside the spine."""
    made: list[Solid] = []
    for side, sign in (("right", -1.0), ("left", 1.0)):
        rows = [
            round_station(
                (sign * scale * x, scale * y, scale * z), scale * girth * wide, scale * girth * deep
            )
            for z, x, y, wide, deep in _PSOAS
        ]
        made.append(swept(f"{side} psoas", rows, MUSCLE, cuts=trunk.ends[1:]))
    return made
