"""Skin, fat, muscle and breasts: the outline of the trunk, neck and shoulders."""

from __future__ import annotations

from typing import Final

import numpy as np

from phantom.document import Instance, Rotation, Solid, Transformed
from phantoms.chest import spine
from phantoms.chest.cage import Cage
from phantoms.chest.frame import Frame
from phantoms.chest.girdle import (
    arm_axis,
    blade_muscles,
    clavicle_muscles,
    from_socket,
    kept,
    shoulder_turn,
)
from phantoms.chest.shapes import Row, column, fitted, grown, rounded, sampled, tube
from phantoms.chest.sides import SIDES, on_side
from phantoms.parts import ellipsoid, union

SKIN_MM: Final = 1.6
OVER_SPINE_MM: Final = 2.0
"""Of soft tissue under the skin over the spinous processes, at least."""
LAYERS: Final = ("muscle", "fat", "skin")
"""Inside out; each is drawn with all that it encloses."""
# z, half-width, front and back of the trunk under its fat, drawn, below what the arms move.
_TRUNK: Final = (
    (-280.0, 141.0, -101.0, 84.0),
    (-150.0, 151.0, -108.0, 98.0),
    (-100.0, 155.0, -109.0, 105.0),
    (-50.0, 157.0, -110.0, 111.0),
)
_TRUNK_SHAPE: Final = rounded(2.6)
_ARM_RADII: Final = (42.0, 45.0, 44.0, 42.0, 40.0, 40.0)


def _fat(frame: Frame, z: float) -> float:
    """Return the thickness of fat at a drawn height: little over the neck and shoulders."""
    share = float(np.interp(z, (-150.0, 60.0, 110.0, 150.0), (1.0, 0.8, 0.5, 0.35)))
    return frame.sizes.fat_mm * share


def trunk_rows(frame: Frame) -> list[Row]:
    """Return the sections of the muscles' surface."""
    rows: list[Row] = [
        (z, -half, half, front, back) for z, half, front, back in (*_TRUNK, *frame.girdle.trunk)
    ]
    tips = np.array(spine.spinous_tips(frame))
    found: list[Row] = []
    for z, low, high, front, back in sampled(fitted(frame, rows), 14):
        near = tips[np.abs(tips[:, 1] - z) < 45.0, 0].max(initial=-1e3)
        least = near + OVER_SPINE_MM - 0.7 * _fat(frame, z / frame.z)
        found.append((z, low, high, front, max(back, least)))
    return found


def _trunk(frame: Frame, name: str, material: str, layer: int) -> Solid:
    """Return the trunk to its muscles' surface (0), that of its fat (1) or of its skin (2)."""
    rows = []
    for row in trunk_rows(frame):
        more = (0.0, _fat(frame, row[0] / frame.z), _fat(frame, row[0] / frame.z) + SKIN_MM)[layer]
        rows += grown([row], more)
    return column(name, rows, material, _TRUNK_SHAPE)


def _arm(frame: Frame, material: str, layer: int) -> list[Solid]:
    """Return an arm with its round upper end, and the muscle about its joint."""
    fat = 0.5 * frame.sizes.fat_mm
    more = (0.0, fat, fat + SKIN_MM)[layer]
    points = arm_axis(frame)
    radii = [r * frame.bone + more for r in _ARM_RADII]
    centre, radius = frame.girdle.shoulder
    joint = from_socket(frame, centre)
    return [
        tube("arm", points, radii, material),
        ellipsoid("top of the arm", points[0], (radii[0] + 0.5,) * 3, material),
        ellipsoid("shoulder", joint, (radius * frame.bone + more,) * 3, material),
    ]


def breast(cage: Cage, layer: int) -> Solid:
    """Return a woman's left breast: its gland (0), its fat (1) or its skin (2)."""
    f = cage.frame
    fat = f.sizes.fat_mm
    z = -52.0 * f.z
    front = min(r[3] for r in trunk_rows(f)) - _fat(f, -40.0)
    size = float(np.clip(1.0 + 0.012 * (fat - 16.0), 0.8, 1.5))
    half = (60.0 * size, 38.0 * size, 74.0 * size)
    centre = (70.0 * f.x, front + 12.0, z)
    shrink = {0: 0.55, 1: 1.0}.get(layer)
    axes = tuple(h * shrink for h in half) if shrink else tuple(h + SKIN_MM for h in half)
    name, material = ("breast", ("gland", "fat", "skin")[layer])
    if layer == 0:
        centre = (centre[0], centre[1] - 8.0, centre[2])
    # Its upper end leans back, so that it fades into the wall above and hangs below.
    return Transformed(
        type="transformed",
        solid=ellipsoid(name, (0.0, 0.0, 0.0), (axes[0], axes[1], axes[2]), material),
        rotate=Rotation(axis=(1.0, 0.0, 0.0), angle_deg=-24.0),
        translate=centre,
    )


def definitions(cage: Cage, sex: str) -> dict[str, Solid]:
    """Return what both sides have: the left shoulder's layers with the breast's."""
    f = cage.frame
    found: dict[str, Solid] = {}
    for layer, material in enumerate(LAYERS):
        over = (0.0, 0.5 * f.sizes.fat_mm, 0.5 * f.sizes.fat_mm + SKIN_MM)[layer]
        parts: list[Solid] = [
            *_arm(f, material, layer),
            blade_muscles(f, "blade", material, over),
            clavicle_muscles(f, "clavicle", material, over),
        ]
        if sex == "female" and layer > 0:
            parts.append(breast(cage, layer))
        found[f"{material} of a side"] = union(*parts)
    if sex == "female":
        found["gland of a side"] = breast(cage, 0)
    return found


def layers(cage: Cage, sex: str) -> list[Solid]:
    """Return skin, fat, gland and muscle, outside in, from the definitions."""
    result: list[Solid] = []
    for word in ("skin", "fat", "gland", "muscle"):
        part, turn = Instance(type="instance", of=f"{word} of a side"), shoulder_turn(cage)
        sides = [on_side(part, side, turn, f"{side} {word}") for side in SIDES]
        if word in LAYERS:
            trunk = _trunk(cage.frame, f"{word} of the trunk", word, LAYERS.index(word))
            result.append(union(trunk, kept(cage.frame, union(*sides), f"arms' {word}")))
        elif sex == "female":
            result.append(union(*sides))
    return result
