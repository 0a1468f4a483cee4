"""The spine from C6 to L2: vertebral bodies with end plates, arches, processes and discs.

Three vertebrae are drawn, an upper, a middle and a lower one; each of the others is one of them in
another size, tilted by the curve of the spine.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from phantom.document import Cut, Instance, Quadric, Rotation, Solid, Transformed
from phantoms.chest.frame import Frame
from phantoms.chest.shapes import bar, cone
from phantoms.parts import ellipsoid, layered, union


class Level(NamedTuple):
    """A vertebra: its kind, drawn height of its middle and factor of its size."""

    kind: str
    z: float
    size: float


LEVELS: Final = {
    "C4": Level("upper", 187.0, 0.74), "C5": Level("upper", 171.5, 0.77),
    "C6": Level("upper", 156.0, 0.80), "C7": Level("upper", 141.0, 0.83),
    "T1": Level("upper", 124.0, 0.90), "T2": Level("upper", 105.5, 0.98),
    "T3": Level("upper", 85.5, 1.0), "T4": Level("upper", 65.0, 1.02),
    "T5": Level("middle", 44.0, 0.97), "T6": Level("middle", 22.5, 0.98),
    "T7": Level("middle", 0.0, 1.0), "T8": Level("middle", -24.0, 1.05),
    "T9": Level("middle", -49.5, 1.10), "T10": Level("lower", -76.5, 0.95),
    "T11": Level("lower", -105.0, 1.0), "T12": Level("lower", -134.5, 1.04),
    "L1": Level("lower", -166.0, 1.10), "L2": Level("lower", -198.5, 1.13),
    "L3": Level("lower", -233.0, 1.15),
}  # fmt: skip


class Kind(NamedTuple):
    """Half-widths of a body and its height; ends of its processes, in mm."""

    half_x: float
    half_y: float
    height: float
    pedicle: tuple[float, float]
    transverse: tuple[float, float, float]
    spinous: tuple[float, float]
    spinous_height: float


KINDS: Final = {
    "upper": Kind(14.2, 9.8, 17.0, (2.6, 5.0), (33.0, 35.0, 4.0), (52.0, -12.0), 6.0),
    "middle": Kind(14.6, 13.2, 19.2, (2.6, 6.0), (29.0, 35.0, 5.0), (55.0, -26.0), 7.0),
    "lower": Kind(17.6, 14.4, 23.5, (4.2, 8.0), (24.0, 32.0, 2.0), (52.0, -12.0), 9.0),
}
SHELL_MM: Final = 0.3
"""Of compact bone about a body and at its end plates."""
WAIST: Final = 0.91
"""Half-widths of a body at its middle over those of its end plates."""


def spine_y(z: float) -> float:
    """Return where the middles of the vertebral bodies are, front to back, in the drawn man."""
    if z > 130.0:  # the neck bends back upright
        above = z - 130.0
        return spine_y(130.0) - 0.349 * above + 0.0016 * above**2
    if z < -130.0:
        return spine_y(-130.0) + 0.30 * (z + 130.0)
    return 49.0 - z * z / (2.0 * 372.0)


def tilt_deg(frame: Frame, z: float) -> float:
    """Return how far a vertebra at a drawn height leans: its top forward where positive."""
    step = 4.0
    up, down = (
        frame.at(0.0, spine_y(z + step), z + step),
        frame.at(0.0, spine_y(z - step), z - step),
    )
    return -math.degrees(math.atan2(up[1] - down[1], up[2] - down[2]))


def _body(kind: Kind, shrink: float, name: str, material: str) -> Solid:
    """Return a body, narrowest at its middle: a hyperboloid between its end plates."""
    half = kind.height / 2 - shrink
    x, y = WAIST * kind.half_x - shrink, WAIST * kind.half_y - shrink
    flare = (1.0 / WAIST**2 - 1.0) / (kind.height / 2) ** 2
    return Quadric(
        type="quadric",
        name=name,
        material=material,
        coefficients=(1.0 / x**2, 1.0 / y**2, -flare, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0),
        cuts=(
            Cut(point=(0.0, 0.0, half), normal=(0.0, 0.0, 1.0)),
            Cut(point=(0.0, 0.0, -half), normal=(0.0, 0.0, -1.0)),
        ),
    )


def vertebra(kind: Kind) -> Solid:
    """Return a vertebra about the middle of its body, its axis upright."""
    back = kind.half_y
    canal = 17.0
    wide, high = kind.pedicle
    tx, ty, tz = kind.transverse
    sy, sz = kind.spinous
    parts: list[Solid] = []
    for side, sign in (("right", -1.0), ("left", 1.0)):
        root = (sign * (kind.half_x - 4.0), back - 4.0, 3.0)
        pillar = (sign * (kind.half_x - 1.0), back + 9.0, 2.0)
        parts += [
            bar(f"{side} pedicle", root, pillar, (high, wide), (0.0, 0.0, 1.0), "arch_bone"),
            bar(
                f"{side} lamina",
                (pillar[0], pillar[1] - 1.0, 0.0),
                (0.0, back + canal + 2.0, -3.0),
                (0.42 * kind.height, 2.6),
                (0.0, 0.0, 1.0),
                "arch_bone",
            ),
            ellipsoid(
                f"{side} joints",
                (pillar[0] * 0.95, pillar[1] + 1.0, 0.0),
                (5.0, 3.6, 0.52 * kind.height),
                "arch_bone",
            ),
            cone(
                f"{side} transverse process",
                (sign * (kind.half_x - 1.0), back + 12.5, tz - 2.0),
                (sign * tx, ty, tz),
                (4.6, 4.2),
                "arch_bone",
            ),
        ]
    parts.append(
        bar(
            "spinous process",
            (0.0, back + canal, -2.0),
            (0.0, sy, sz),
            (kind.spinous_height, 2.8),
            (0.0, 0.0, 1.0),
            "arch_bone",
        )
    )
    return layered(
        union(*parts),
        _body(kind, 0.0, "cortex", "cortical_bone"),
        _body(kind, SHELL_MM, "spongiosa", "spongiosa"),
    )


def definitions() -> dict[str, Solid]:
    """Return the three drawn vertebrae by name."""
    return {f"{name} vertebra": vertebra(kind) for name, kind in KINDS.items()}


def centre(frame: Frame, name: str) -> tuple[float, float, float]:
    """Return the middle of a vertebral body."""
    z = LEVELS[name].z
    return frame.at(0.0, spine_y(z), z)


def spinous_tips(frame: Frame) -> list[tuple[float, float]]:
    """Return how far back (y) each spinous process reaches, and at which height."""
    found = []
    for name, level in LEVELS.items():
        kind, size = KINDS[level.kind], level.size * frame.bone
        lean = math.radians(tilt_deg(frame, level.z))
        y, z = kind.spinous
        _, middle_y, middle_z = centre(frame, name)
        found.append(
            (
                middle_y
                + size * (y * math.cos(lean) - z * math.sin(lean))
                + 0.5 * size * kind.spinous_height,
                middle_z + size * (y * math.sin(lean) + z * math.cos(lean)),
            )
        )
    return found


def placed(frame: Frame, name: str) -> Transformed:
    """Return a vertebra where it is."""
    level = LEVELS[name]
    return Transformed(
        type="transformed",
        name=name,
        solid=Instance(type="instance", of=f"{level.kind} vertebra"),
        scale=level.size * frame.bone,
        rotate=Rotation(axis=(1.0, 0.0, 0.0), angle_deg=tilt_deg(frame, level.z)),
        translate=centre(frame, name),
    )
