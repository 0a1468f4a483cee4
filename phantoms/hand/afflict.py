"""How each abnormality changes the hand, whether it fits, and what a reader should find."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from phantom.document import Finding, Solid, Sphere
from phantom.errors import InvalidInputError, Problem
from phantom.library import Abnormality
from phantoms.hand.abnormalities import (
    CARTILAGE,
    DENSE,
    BlasticLesion,
    Erosion,
    ForeignBody,
    Fracture,
    LyticLesion,
    Osteoarthritis,
)
from phantoms.hand.frames import Frame
from phantoms.hand.places import DIRECTIONS, bone_of, bowed_mm, half_mm, joint_of, point_at, touches
from phantoms.hand.skeleton import SPACES, Break, Skeleton, beyond, met
from phantoms.hand.soft import Skin
from phantoms.hand.tubular import CORTEX, PLATE_MM
from phantoms.parts import ellipsoid

_SPARE_MM: Final = 0.2
"""Left between a lesion and the bone's surface, and between bone, foreign body and skin."""

# Share of the joint space left, length of the spurs, dense bone under the joint, by grade.
_GRADES: Final = {
    1: (0.95, 0.5, 0.0),
    2: (0.75, 1.0, 0.3),
    3: (0.45, 1.7, 0.8),
    4: (0.15, 2.5, 1.4),
}


@dataclass(frozen=True, slots=True)
class Hand:
    """The bones with what is wrong with them, splinters beside them, and the findings."""

    bones: Skeleton
    joint_space_mm: float
    splinters: tuple[Solid, ...] = ()
    findings: tuple[Finding, ...] = ()

    def found(self, finding: Finding, bones: Skeleton, *splinters: Solid) -> Hand:
        """Return the hand with one finding more."""
        return replace(
            self,
            bones=bones,
            splinters=(*self.splinters, *splinters),
            findings=(*self.findings, finding),
        )


class MisfitError(Exception):
    """An abnormality that does not fit: the field, and what was found and expected."""

    def __init__(self, field: str, message: str, kind: str = "does_not_fit") -> None:
        super().__init__(message)
        self.field, self.message, self.kind = field, message, kind


def afflicted(hand: Hand, wrong: Sequence[Abnormality], skin: Skin) -> Hand:
    """Return a healthy hand with what is wrong with it.

    Raises
    ------
    InvalidInputError
        What does not fit, with paths under ``/abnormalities``.
    """
    problems = []
    counts: dict[str, int] = {}
    names = []
    for one in wrong:
        kind = type(one).model_fields["type"].default
        counts[kind] = counts.get(kind, 0) + 1
        number = f" {counts[kind]}" if counts[kind] > 1 else ""
        names.append(one.name or f"{kind.replace('_', ' ')}{number}")
    # Fractures last: what they move has been shaped by then.
    order = sorted(range(len(wrong)), key=lambda index: isinstance(wrong[index], Fracture))
    for index in order:
        try:
            hand = _APPLY[type(wrong[index])](hand, wrong[index], names[index], skin)
        except MisfitError as misfit:
            path = f"/abnormalities/{index}/{misfit.field}"
            problems.append(Problem(path, misfit.kind, misfit.message))
    if problems:
        raise InvalidInputError(problems)
    return hand


def _fracture(hand: Hand, wrong: Fracture, name: str, _: Skin) -> Hand:
    place = bone_of(wrong.bone)
    placed = hand.bones.bones[place]
    if placed.broken is not None or placed.inside:
        message = f"found {wrong.bone!r}, which has a fracture or a lesion; expected another bone"
        raise MisfitError("bone", message, "conflict")
    at = (0.0, 0.0, wrong.at * placed.shape.length_mm)
    tilt = math.radians(wrong.angle_deg)
    step = (wrong.step_mm, 0.0, 0.0)
    broken = Break(at, (math.sin(tilt), 0.0, math.cos(tilt)), wrong.gap_mm, step)
    bones = hand.bones.changed(place, broken=broken)
    moved = placed.frame.axes @ np.array(step)
    for other in beyond(*place):
        frame = bones.bones[other].frame
        bones = bones.changed(other, frame=Frame(frame.origin + moved, frame.axes))
    width = 2 * half_mm(placed.shape.outer, at[2])[0]
    leaves = tuple(f"{wrong.bone}/{part} fragment/cortex" for part in ("inner", "outer"))
    finding = Finding(
        name=name,
        kind="fracture",
        leaves=leaves,
        center=point_at(placed.frame, at),
        size_mm=round(width / math.cos(tilt) + abs(wrong.step_mm), 3),
    )
    return hand.found(finding, bones)


def _lesion(hand: Hand, wrong: LyticLesion | BlasticLesion, name: str, _: Skin) -> Hand:
    place = bone_of(wrong.bone)
    placed = hand.bones.bones[place]
    shape, outer = placed.shape, placed.shape.outer
    z = wrong.at * shape.length_mm
    half = wrong.length_mm / 2
    ends = (outer[0].at[2] + _SPARE_MM + PLATE_MM, outer[-1].at[2])
    if not ends[0] <= z - half <= z + half <= ends[1]:
        most = 2 * min(z - ends[0], ends[1] - z)
        message = f"found {wrong.length_mm:g} mm; expected at most {max(most, 0):.3g} mm there"
        raise MisfitError("length_mm", message)
    flat = shape.width.shaft_depth / shape.width.shaft
    most = math.inf
    for share in np.linspace(-0.98, 0.98, 25):
        wide, deep = half_mm(outer, z + float(share) * half)
        round_ = math.sqrt(1 - float(share) ** 2)
        most = min(most, (wide - _SPARE_MM) / round_, (deep - _SPARE_MM) / round_ / flat)
    if wrong.width_mm > 2 * most:
        message = f"found {wrong.width_mm:g} mm; expected at most {2 * most:.3g} mm in that bone"
        raise MisfitError("width_mm", message)
    middle = (0.0, bowed_mm(outer, z), z)
    lytic = isinstance(wrong, LyticLesion)
    size = (wrong.width_mm / 2, flat * wrong.width_mm / 2, half)
    leaf = ellipsoid(name, middle, size, CARTILAGE if lytic else DENSE)
    finding = Finding(
        name=name,
        kind="lytic lesion" if lytic else "blastic lesion",
        leaves=(f"{wrong.bone}/{name}",),
        center=point_at(placed.frame, middle),
        size_mm=(wrong.width_mm, round(flat * wrong.width_mm, 3), wrong.length_mm),
    )
    return hand.found(finding, hand.bones.changed(place, inside=(*placed.inside, leaf)))


def _osteoarthritis(hand: Hand, wrong: Osteoarthritis, name: str, _: Skin) -> Hand:
    inner_name, outer_name = joint_of(wrong.joint)
    inner, outer = hand.bones.bones[inner_name], hand.bones.bones[outer_name]
    space, spur, dense = _GRADES[wrong.grade]
    space = space if wrong.space is None else wrong.space
    spur = spur if wrong.spur_mm is None else wrong.spur_mm
    dense = dense if wrong.sclerosis_mm is None else wrong.sclerosis_mm
    gap = SPACES[inner.shape.kind] * hand.joint_space_mm
    outer = met(outer, inner, space * gap)
    width, depth = outer.shape.width.base, outer.shape.width.base_depth
    spurs = tuple(
        ellipsoid(
            f"{name} {edge}",
            (sign * (width / 2 - 0.3 - 0.4 * spur), 0.0, 0.9),
            (0.3 + 0.75 * spur, 0.4 * depth, 0.7 + 0.45 * spur),
            CORTEX,
        )
        for edge, sign in (("radial spur", 1.0), ("ulnar spur", -1.0))
    )
    plates = outer.shape.plate_mm
    outer = replace(
        outer,
        shape=outer.shape._replace(plate_mm=(PLATE_MM + dense, plates[1])),
        spurs=(*outer.spurs, *spurs),
    )
    plates = inner.shape.plate_mm
    inner = replace(inner, shape=inner.shape._replace(plate_mm=(plates[0], PLATE_MM + dense)))
    bones = replace(hand.bones, bones={**hand.bones.bones, inner_name: inner, outer_name: outer})
    finding = Finding(
        name=name,
        kind=f"osteoarthritis, grade {wrong.grade}",
        leaves=tuple(f"{' '.join(outer_name)}/{leaf.name}" for leaf in spurs),
        center=point_at(outer.frame, (0.0, 0.0, -gap / 2)),
        size_mm=round(width + spur, 3),
    )
    return hand.found(finding, bones)


def _erosion(hand: Hand, wrong: Erosion, name: str, _: Skin) -> Hand:
    _inner, place = joint_of(wrong.joint)
    placed = hand.bones.bones[place]
    sign = 1.0 if wrong.edge == "radial" else -1.0
    center = (sign * 0.47 * placed.shape.width.base, 0.0, 0.4 + 0.35 * wrong.diameter_mm)
    bite = Sphere(type="sphere", name=name, center=center, radius=wrong.diameter_mm / 2)
    finding = Finding(
        name=name,
        kind="erosion",
        center=point_at(placed.frame, center),
        size_mm=wrong.diameter_mm,
    )
    return hand.found(finding, hand.bones.changed(place, eroded=(*placed.eroded, bite)))


def _foreign_body(hand: Hand, wrong: ForeignBody, name: str, skin: Skin) -> Hand:
    placed = hand.bones.bones[bone_of(wrong.bone)]
    center = (wrong.aside_mm, -wrong.deep_mm, wrong.at * placed.shape.length_mm)
    size = (wrong.width_mm / 2, wrong.width_mm / 2, wrong.length_mm / 2)
    surface = np.array(center) + (np.array(size) + _SPARE_MM) * DIRECTIONS
    points = placed.frame.origin + surface @ placed.frame.axes.T
    where = f"found {wrong.deep_mm:g} mm"
    for name_, other in hand.bones.bones.items():
        if touches(other, points):
            message = f"{where}, in or against the {' '.join(name_)}; expected it beside all bones"
            raise MisfitError("deep_mm", message)
    if not all(skin.holds(point) for point in points):
        message = f"{where}, through the skin; expected it within the hand"
        raise MisfitError("deep_mm", message)
    body = placed.frame.placed(
        f"beside {wrong.bone}", ellipsoid(name, center, size, wrong.substance)
    )
    finding = Finding(
        name=name,
        kind=f"foreign body of {wrong.substance}",
        leaves=(f"beside {wrong.bone}/{name}",),
        center=point_at(placed.frame, center),
        size_mm=(wrong.width_mm, wrong.width_mm, wrong.length_mm),
    )
    return hand.found(finding, hand.bones, body)


_APPLY: Final[dict[type[Abnormality], Callable[..., Hand]]] = {
    Fracture: _fracture,
    LyticLesion: _lesion,
    BlasticLesion: _lesion,
    Osteoarthritis: _osteoarthritis,
    Erosion: _erosion,
    ForeignBody: _foreign_body,
}
