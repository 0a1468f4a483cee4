"""Steel beads on a helix round a cylinder: places that are known in every picture.

Such a phantom calibrates the geometry of a machine with a source and a detector: from where the
beads are seen follows where both stand (Cho, Moseley, Siewerdsen, Jaffray, Medical Physics 32:968,
2005, with two circles of beads in place of the helix). Every bead is a landmark of the document,
so that ``truth`` tells its column and row.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Self

from pydantic import model_validator

from phantom.document import (
    Cylinder,
    Document,
    Model,
    Point,
    ReferenceMaterial,
    Replace,
    Solid,
    Sphere,
    told,
)
from phantom.document.base import refuse
from phantom.library import Entry, Technique
from phantoms.fields import ReferenceName, count, millimetres


class Parameters(Model):
    """What the beads may be."""

    beads: Annotated[int, count("Beads", "How many.", 1, 500)] = 24
    diameter_mm: Annotated[float, millimetres("Diameter", "Of a bead.", 0.05, 20.0)] = 3.0
    radius_mm: Annotated[
        float, millimetres("Radius", "Of the helix, to the beads' centres.", 1.0, 300.0)
    ] = 50.0
    height_mm: Annotated[
        float, millimetres("Height", "From the first bead to the last (z).", 1.0, 600.0)
    ] = 120.0
    turns: Annotated[float, told("Turns", "none", "Of the helix.", ge=0.1, le=20.0)] = 1.5
    material: Annotated[
        ReferenceName, told("Material", "none", "A reference material for the beads.")
    ] = "steel"
    cylinder: Annotated[
        ReferenceName | None,
        told("Cylinder", "none", "What holds the beads; null for beads in empty space."),
    ] = "pmma"

    @model_validator(mode="after")
    def _beads_are_apart(self) -> Self:
        centres = _centres(self)
        nearest = min((math.dist(a, b) for a, b in pairwise(centres)), default=math.inf)
        if nearest <= self.diameter_mm or self.diameter_mm >= self.radius_mm:
            message = (
                f"found {self.diameter_mm:g} mm; expected less than from bead to bead,"
                f" {nearest:g} mm, and than the radius"
            )
            refuse("does_not_fit", (("diameter_mm",), message))
        return self


def _centres(parameters: Parameters) -> list[Point]:
    p = parameters
    shares = [k / (p.beads - 1) if p.beads > 1 else 0.5 for k in range(p.beads)]
    return [
        (
            p.radius_mm * math.cos(2 * math.pi * p.turns * share),
            p.radius_mm * math.sin(2 * math.pi * p.turns * share),
            p.height_mm * (0.5 - share),
        )
        for share in shares
    ]


def build(parameters: Parameters) -> Document:
    """Return the beads about the origin, the first at the head end on the patient's left."""
    p = parameters
    centres = {f"bead-{k + 1:03d}": center for k, center in enumerate(_centres(p))}
    beads: list[Solid] = [
        Sphere(type="sphere", name=name, material="bead", center=center, radius=p.diameter_mm / 2)
        for name, center in centres.items()
    ]
    materials = {"bead": ReferenceMaterial(reference=p.material)}
    if p.cylinder is not None:
        materials["cylinder"] = ReferenceMaterial(reference=p.cylinder)
        half = p.height_mm / 2 + 2 * p.diameter_mm
        body = Cylinder(
            type="cylinder",
            name="cylinder",
            material="cylinder",
            start=(0.0, 0.0, -half),
            end=(0.0, 0.0, half),
            radius=p.radius_mm + 2 * p.diameter_mm,
        )
        beads = [body, *beads]
    solid = beads[0] if len(beads) == 1 else Replace(type="replace", solids=tuple(beads))
    return Document(
        format="phantom/1",
        name="beads",
        title="Beads on a helix",
        materials=materials,
        solid=solid,
        landmarks={"isocentre": (0.0, 0.0, 0.0), **centres},
        sources=("Cho, Moseley, Siewerdsen, Jaffray, Medical Physics 32:968, 2005.",),
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="beads",
    title="Beads on a helix",
    summary="Steel beads on a helix round a cylinder; each is a landmark whose place in the picture"
    " is told, for calibration.",
    parameters=Parameters,
    build=build,
    views=("ap", "left_lateral"),
    technique=Technique(kvp=70.0, window=(2.5, 5.0)),
)
