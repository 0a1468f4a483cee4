"""The hand's bones in place: each tubular bone's frame and shape, then the solids."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from phantom.document import Cut, Ellipsoid, Solid, Sphere
from phantoms.hand.carpus import carpus
from phantoms.hand.forearm import forearm, sesamoids
from phantoms.hand.frames import KINDS, Frame, chain
from phantoms.hand.lengths import field as field_of
from phantoms.hand.parameters import Parameters, shaft_index
from phantoms.hand.sizes import DIGITS, METACARPAL, MIDDLE, PROXIMAL, WIDTHS
from phantoms.hand.tubular import Shape, bone
from phantoms.hand.wrist import carpal_hollows, saddle
from phantoms.parts import named, union

SPACES: Final = {METACARPAL: 1.0, PROXIMAL: 0.8, MIDDLE: 0.65}
"""Joint space beyond a bone, over that of the fingers' base joints (estimates)."""

BoneName = tuple[str, str]
"""Digit and kind."""


@dataclass(frozen=True, slots=True)
class Break:
    """A fracture: a plane of the bone's frame, the gap, and how far the outer part is moved."""

    at: tuple[float, float, float]
    normal: tuple[float, float, float]
    gap_mm: float
    step: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Placed:
    """A tubular bone: where it is, what it is made of, and what is wrong with it.

    Attributes
    ----------
    inside
        Lesions, in its frame; they replace bone and marrow.
    spurs
        Ellipsoids of cortex at its base.
    eroded
        Spheres taken out of it.
    """

    frame: Frame
    shape: Shape
    inside: tuple[Solid, ...] = ()
    spurs: tuple[Ellipsoid, ...] = ()
    eroded: tuple[Sphere, ...] = ()
    broken: Break | None = None

    def solid(self, name: str) -> Solid:
        """Return the bone in the hand's frame."""
        if self.broken is None:
            whole = bone(self.shape, *self.inside, spurs=self.spurs, eroded=self.eroded)
            return self.frame.placed(name, whole)
        parts = []
        for part, sign in (("inner fragment", 1.0), ("outer fragment", -1.0)):
            away = np.array(self.broken.normal)
            point = np.array(self.broken.at) - sign * self.broken.gap_mm / 2 * away
            cut = Cut(point=_triple(point), normal=_triple(sign * away))
            solid = bone(self.shape, spurs=self.spurs, eroded=self.eroded, cuts=(cut,))
            shift = (0.0, 0.0, 0.0) if sign > 0 else self.broken.step
            parts.append(named(part, solid, shift=shift))
        return self.frame.placed(name, union(*parts))


@dataclass(frozen=True, slots=True)
class Skeleton:
    """The tubular bones by digit and kind, and how much larger than the mean all but lengths is."""

    scale: float
    bones: Mapping[BoneName, Placed] = field(default_factory=dict)

    def changed(self, name: BoneName, **changes: object) -> Skeleton:
        """Return the skeleton with one bone changed."""
        return replace(self, bones={**self.bones, name: replace(self.bones[name], **changes)})  # type: ignore[arg-type]

    def solids(self) -> list[Solid]:
        """Return every bone in the hand's frame."""
        thumb = self.bones["thumb", METACARPAL]
        return [
            *forearm(self.scale),
            *carpus(self.scale, *saddle(self.scale, thumb.frame)),
            *(placed.solid(" ".join(name)) for name, placed in self.bones.items()),
            *sesamoids(self.scale, thumb.frame, thumb.shape.length_mm),
        ]


def skeleton(parameters: Parameters) -> Skeleton:
    """Return the healthy bones of a hand with nothing left out."""
    scale = parameters.scale * parameters.value("bone_width")
    made: dict[BoneName, Placed] = {}
    for digit in DIGITS:
        kinds = KINDS[digit]
        lengths = tuple(parameters.value(field_of(digit, kind)) for kind in kinds)
        gaps = tuple(SPACES[kind] * parameters.value("joint_space_mm") for kind in kinds[:-1])
        frames = chain(digit, scale, lengths, gaps)
        for index, kind in enumerate(kinds):
            width = WIDTHS[kind][digit].times(scale)
            share = shaft_index(kind, parameters.value("metacarpal_index"))
            shape = Shape(kind, width, lengths[index], share * width.shaft / 2)
            if kind == METACARPAL:
                shape = shape._replace(hollows=carpal_hollows(digit, scale))
            made[digit, kind] = Placed(frames[index], shape)
        for inner, outer, gap in zip(kinds, kinds[1:], gaps, strict=False):
            made[digit, outer] = met(made[digit, outer], made[digit, inner], gap)
    return Skeleton(scale, made)


def met(outer: Placed, inner: Placed, gap_mm: float) -> Placed:
    """Return the outer bone of a joint with the hollows that leave that joint space."""
    hollows = tuple(
        knob._replace(center=outer.frame.local(inner.frame.point(knob.center)))
        for knob in inner.shape.socket(gap_mm)
    )
    return replace(outer, shape=outer.shape._replace(hollows=hollows))


def beyond(digit: str, kind: str) -> Sequence[BoneName]:
    """Return the bones of a ray that are nearer to the fingertip."""
    kinds = KINDS[digit]
    return [(digit, other) for other in kinds[kinds.index(kind) + 1 :]]


def _triple(values: Iterable[float]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
