"""Osteoarthritis: one compartment narrows, its margins grow spurs, its plateau hardens."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from phantom.document import Finding, Point, ReferenceMaterial, Solid
from phantoms.knee import condyles, plateau
from phantoms.knee.abnormalities import Osteoarthritis
from phantoms.knee.plateau import Facet, under_facet
from phantoms.knee.poses import Pose
from phantoms.parts import ellipsoid

if TYPE_CHECKING:
    from phantoms.knee.plan import Plan

_CONTACT_X: Final = 23.0
"""Where the condyles stand on the plateau, from the middle."""
_LEAST_SPACE_MM: Final = 0.3
_ROOM_MM: Final = 3.5
"""What lies over the joint's margins besides fat."""


def osteoarthritis(plan: Plan, index: int, name: str, one: Osteoarthritis) -> None:
    """Lift the tibia in one compartment, about the other, and add what has grown."""
    sizes = plan.sizes
    side = 1.0 if one.compartment == "medial" else -1.0
    if any(finding.kind == one.type for finding in plan.findings):
        message = "found osteoarthritis again; expected one at most"
        return plan.refuse(index, "type", "repeated", message)
    most = sizes.joint_space - _LEAST_SPACE_MM
    if one.loss_mm > most:
        message = f"found {one.loss_mm:g}; expected {most:.3g} at most, in a joint this wide"
        plan.refuse(index, "joint_space_loss_mm", "does_not_fit", message)
    room = _ROOM_MM + 0.9 * sizes.fat
    if one.spur_mm > room:
        message = f"found {one.spur_mm:g}; expected {room:.3g} at most, under the skin"
        plan.refuse(index, "osteophyte_mm", "does_not_fit", message)
    across, _ = plateau.scales(sizes)
    pivot = (-side * _CONTACT_X * across, 12.0, 0.0)
    angle = math.degrees(math.atan2(one.loss_mm, 2.0 * _CONTACT_X * across))
    plan.shin = Pose((0.0, 0.0, plan.at.plateau_z), side * angle, pivot)
    leaves = []
    if one.spur_mm > 0.0:
        plan.materials["osteophyte"] = ReferenceMaterial(
            reference="spongiosa_icru44", density_g_cm3=round(1.3 * sizes.spongiosa_density, 4)
        )
        spurs = _spurs(plan, name, one, side)
        plan.around.extend(spurs)
        leaves += [str(spur.name) for spur in spurs if hasattr(spur, "name")]
    if one.dense_mm > 0.0:
        plan.materials["sclerosis"] = ReferenceMaterial(
            reference="cortical_bone_icru44",
            density_g_cm3=round(0.85 * sizes.cortical_density, 4),
        )
        which: Facet = "medial facet" if side > 0.0 else "lateral facet"
        plate = under_facet(sizes, which, one.dense_mm, "sclerosis")
        plan.inside.append(plan.shin.solid(f"{name}, sclerosis", plate))
        leaves.append(f"{name}, sclerosis")
    middle = plan.shin.point((side * _CONTACT_X * across, 12.0, 0.0))
    size = (40.0 * across, 40.0 * across, max(sizes.joint_space - one.loss_mm, _LEAST_SPACE_MM))
    plan.findings.append(
        Finding(name=name, kind=one.type, leaves=tuple(leaves), center=middle, size_mm=size)
    )
    return None


def _spurs(plan: Plan, name: str, one: Osteoarthritis, side: float) -> list[Solid]:
    """Return spurs at the margins: all of the compartment's, small ones of the other."""
    tibia_x = plan.sizes.plateau_width / 2.0
    femur_x = 0.975 * plan.sizes.bicondylar_width / 2.0
    along = condyles.scales(plan.sizes)[1]
    found: list[Solid] = []
    for at_side, word in ((1.0, "medial"), (-1.0, "lateral")):
        spur = one.spur_mm if at_side == side else 0.4 * one.spur_mm
        on_tibia = plan.shin.point((at_side * (tibia_x - 1.0), 14.0 * along, -2.5))
        on_femur = plan.thigh.point((at_side * (femur_x - 2.2), 16.0 * along, 7.6 * along))
        axes = (spur + 1.0, 11.0 * along, 0.45 * spur + 1.6)
        found.append(_spur(f"{name}, {word} spur of the tibia", on_tibia, axes))
        axes = (spur + 2.2, 12.0 * along, 0.45 * spur + 2.0)
        found.append(_spur(f"{name}, {word} spur of the femur", on_femur, axes))
    return found


def _spur(name: str, middle: Point, axes: Point) -> Solid:
    return ellipsoid(name, middle, axes, "osteophyte")
