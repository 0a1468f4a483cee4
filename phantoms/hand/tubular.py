"""A tubular bone of the hand: cortex, spongiosa and marrow, with a head and a hollow base."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from phantom.document import Cut, Difference, Ellipsoid, Point, Solid, Sphere
from phantoms.hand.sizes import DISTAL, METACARPAL, Width, head_length_mm, stations
from phantoms.parts import Station, layered, swept, union, within

CORTEX, SPONGIOSA, MARROW = "cortical bone", "spongiosa", "marrow"
PLATE_MM: Final = 0.5
"""Thickness of the bone under a joint's cartilage; an estimate."""
_THIN_MM: Final = 0.5
"""Thickness of the cortex at the ends of a bone; an estimate."""
_BOW: Final = {METACARPAL: 0.028, DISTAL: 0.0}


class Knob(NamedTuple):
    """An ellipsoid of a joint: a head or one of its condyles, in the frame of its bone."""

    name: str
    center: Point
    semi_axes: Point

    def grown(self, by_mm: float) -> Knob:
        """Return the ellipsoid with that much more on every semi-axis."""
        a, b, c = self.semi_axes
        return self._replace(semi_axes=(a + by_mm, b + by_mm, c + by_mm))

    def reaches(self, cut: Cut) -> bool:
        """Whether something is left of it where a plane takes the rest away."""
        away = np.array(cut.normal) / np.linalg.norm(cut.normal)
        depth = float(away @ (np.array(self.center) - cut.point))
        return depth - float(np.linalg.norm(away * self.semi_axes)) < -0.01

    def solid(self, name: str, material: str | None, cuts: Sequence[Cut] = ()) -> Ellipsoid:
        """Return the leaf."""
        return Ellipsoid(
            type="ellipsoid",
            name=name,
            material=material,
            center=self.center,
            semi_axes=self.semi_axes,
            cuts=tuple(cuts),
        )


class Shape(NamedTuple):
    """What a tubular bone is made of, in its own frame.

    Attributes
    ----------
    kind, width, length_mm
        As in :mod:`phantoms.hand.sizes`.
    cortex_mm
        Thickness of the cortex of the shaft.
    hollows
        What is taken out of the base: the head that it meets, grown by the joint space.
    plate_mm
        Thickness of the bone under the joints: of the base, and of the head.
    """

    kind: str
    width: Width
    length_mm: float
    cortex_mm: float
    hollows: tuple[Knob, ...] = ()
    plate_mm: tuple[float, float] = (PLATE_MM, PLATE_MM)

    @property
    def outer(self) -> list[Station]:
        """The sections of base and shaft."""
        return stations(self.kind, self.width, self.length_mm, self.bow_mm)

    @property
    def bow_mm(self) -> float:
        """How far the shaft bows to the back of the hand."""
        return _BOW.get(self.kind, 0.02) * self.length_mm

    @property
    def knobs(self) -> tuple[Knob, ...]:
        """The ellipsoids of its head; none of a distal phalanx."""
        if self.kind == DISTAL:
            return ()
        reach = head_length_mm(self.kind, self.width)
        z = self.length_mm - reach
        half, deep = self.width.head / 2, self.width.head_depth / 2
        if self.kind == METACARPAL:
            return (Knob("head", (0.0, 0.0, z), (0.985 * half, deep, reach)),)
        aside, wide = 0.36 * half, 0.64 * half
        return (
            Knob("radial condyle", (aside, 0.0, z), (wide, deep, reach)),
            Knob("ulnar condyle", (-aside, 0.0, z), (wide, deep, reach)),
        )

    def socket(self, gap_mm: float) -> tuple[Knob, ...]:
        """The hollows, in this bone's frame, that leave that joint space about its head."""
        grown = [knob.grown(gap_mm) for knob in self.knobs]
        if self.kind != METACARPAL:
            return tuple(grown)
        # A proximal phalanx's base is flatter than the head it rides on.
        return tuple(
            k._replace(semi_axes=(k.semi_axes[0] + 4.0, k.semi_axes[1] + 3.0, k.semi_axes[2]))
            for k in grown
        )

    def walls(self, outer: Sequence[Station]) -> list[float]:
        """Return the thickness of the cortex at each section."""
        z = [station.at[2] / self.length_mm for station in outer]
        ends = (0.05, 0.2, 0.36, 0.62, 0.78, 0.9)
        if self.kind == DISTAL:
            ends = (0.06, 0.25, 0.45, 0.6, 0.75, 0.88)
        middle = 0.5 * (_THIN_MM + self.cortex_mm)
        values = (_THIN_MM, middle, self.cortex_mm, self.cortex_mm, middle, _THIN_MM)
        return [float(wall) for wall in np.interp(z, ends, values)]


def bone(
    shape: Shape,
    *inside: Solid,
    spurs: Sequence[Ellipsoid] = (),
    eroded: Sequence[Sphere] = (),
    cuts: Sequence[Cut] = (),
) -> Solid:
    """Return a bone in its own frame.

    Parameters
    ----------
    shape
        What it is made of.
    inside
        What replaces bone and marrow, such as a lesion.
    spurs, eroded
        Ellipsoids of cortex at the base, and what is taken out of it.
    cuts
        Planes that take a part of every leaf away.
    """
    outer = shape.outer

    def kept(knob: Knob) -> bool:
        return all(knob.reaches(cut) for cut in cuts)

    spongy = within(outer, shape.walls(outer), closed=(True, shape.kind == DISTAL), count=9)
    whole = union(
        swept("cortex", _level(outer), CORTEX, cuts=cuts),
        *(knob.solid(knob.name, CORTEX, cuts) for knob in shape.knobs if kept(knob)),
        *(spur.model_copy(update={"cuts": tuple(cuts)}) for spur in spurs if kept(_knob(spur))),
    )
    core = union(
        swept("spongiosa", _level(spongy), SPONGIOSA, cuts=cuts),
        *(
            knob.grown(-_under(shape)).solid(f"{knob.name} spongiosa", SPONGIOSA, cuts)
            for knob in shape.knobs
            if kept(knob.grown(-_under(shape)))
        ),
    )
    plates = [knob.grown(shape.plate_mm[0]) for knob in shape.hollows]
    canal = _canal(spongy, shape)
    made = layered(
        _hollowed(whole, shape.hollows, "hollow"),
        _hollowed(core, plates, "inner hollow"),
        *([canal.solid("marrow", MARROW, cuts)] if kept(canal) else []),
        *inside,
    )
    return Difference(type="difference", solids=(made, *eroded)) if eroded else made


def _level(rows: Sequence[Station]) -> list[Station]:
    """Return the sections of a bowed bone shifted from a straight axis instead."""
    return [
        Station((0.0, 0.0, z), reach, (low + bow, high + bow))
        for (_, bow, z), reach, (low, high) in rows
    ]


def _knob(spur: Ellipsoid) -> Knob:
    return Knob(spur.name or "", spur.center, spur.semi_axes)


def _under(shape: Shape) -> float:
    return min(shape.plate_mm[1], 0.45 * min(min(knob.semi_axes) for knob in shape.knobs))


def _canal(spongy: Sequence[Station], shape: Shape) -> Knob:
    """Return the marrow canal: the thickest ellipsoid of its length within the spongiosa."""
    first, last = (0.08, 0.9) if shape.kind != DISTAL else (0.2, 0.74)
    z = [station.at[2] / shape.length_mm for station in spongy]
    middle = (first + last) / 2
    # How far the bone's wall is, at places all along, from the ellipsoid's own straight axis.
    share = np.linspace(-0.97, 0.97, 39)
    places = middle + share * (last - first) / 2
    y = np.interp(places, z, [station.at[1] for station in spongy])
    y0 = float(np.interp(middle, z, [station.at[1] for station in spongy]))
    wide = np.interp(places, z, [station.x[1] for station in spongy])
    deep = np.interp(places, z, [station.b[1] for station in spongy])
    least = 0.98 / np.sqrt(1 - share**2)
    a, b = (least * wide).min(), (least * (deep - abs(y - y0))).min()
    size = (float(a), max(float(b), 0.2), (last - first) / 2 * shape.length_mm)
    return Knob("marrow", (0.0, y0, middle * shape.length_mm), size)


def _hollowed(solid: Solid, hollows: Sequence[Knob], name: str) -> Solid:
    if not hollows:
        return solid
    taken = [hollow.solid(f"{name} {index}", None) for index, hollow in enumerate(hollows)]
    return Difference(type="difference", solids=(solid, *taken))
