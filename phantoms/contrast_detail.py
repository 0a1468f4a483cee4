"""A contrast-detail plate: holes of falling diameter across, of falling depth down.

The plan is that of plates such as CDRAD 2.0 (PMMA 10 mm thick, 15 by 15 holes from 0.3 to 8 mm in
diameter and depth), with one hole in each square; how many, and from what to what, is free.
"""

from __future__ import annotations

from typing import Annotated, Self

import numpy as np
from pydantic import model_validator

from phantom.document import Box, Cylinder, Document, Model, ReferenceMaterial, Replace, told
from phantom.document.base import refuse
from phantom.library import Entry, Technique
from phantoms.fields import ReferenceName, count, millimetres


class Parameters(Model):
    """What a contrast-detail plate may be."""

    columns: Annotated[int, count("Columns", "Different diameters.", 1, 30)] = 15
    rows: Annotated[int, count("Rows", "Different depths.", 1, 30)] = 15
    smallest_mm: Annotated[
        float, millimetres("Smallest", "Least diameter and depth.", 0.01, 20.0)
    ] = 0.3
    largest_mm: Annotated[
        float, millimetres("Largest", "Greatest diameter and depth.", 0.01, 20.0)
    ] = 8.0
    square_mm: Annotated[float, millimetres("Square", "From hole to hole.", 0.1, 50.0)] = 15.0
    thickness_mm: Annotated[
        float, millimetres("Thickness", "Of the plate, along the beam (y).", 0.1, 100.0)
    ] = 10.0
    material: Annotated[
        ReferenceName, told("Material", "none", "A reference material for the plate.")
    ] = "pmma"

    @model_validator(mode="after")
    def _holes_fit(self) -> Self:
        most = min(self.square_mm, self.thickness_mm)
        if not self.smallest_mm <= self.largest_mm <= most:
            message = (
                f"found holes of {self.smallest_mm:g} to {self.largest_mm:g} mm; expected the"
                f" smallest first, and no more than the square and the thickness, {most:g} mm"
            )
            refuse("does_not_fit", (("largest_mm",), message))
        return self


def sizes_mm(parameters: Parameters, number: int) -> list[float]:
    """Return sizes from the largest to the smallest, each the same share of the one before."""
    return [
        float(size) for size in np.geomspace(parameters.largest_mm, parameters.smallest_mm, number)
    ]


def build(parameters: Parameters) -> Document:
    """Return the plate about the origin; its holes open on the side of the detector in ``ap``."""
    p = parameters
    face = p.thickness_mm / 2
    plate = Box(
        type="box",
        name="plate",
        material="plate",
        center=(0.0, 0.0, 0.0),
        size=(p.columns * p.square_mm, p.thickness_mm, p.rows * p.square_mm),
    )
    holes = [
        Cylinder(
            type="cylinder",
            name=f"hole-{row + 1:02d}-{column + 1:02d}",
            material="air",
            start=(x, face - depth, z),
            end=(x, face, z),
            radius=diameter / 2,
        )
        for row, depth in enumerate(sizes_mm(p, p.rows))
        for column, diameter in enumerate(sizes_mm(p, p.columns))
        for x, z in [
            (
                (column - (p.columns - 1) / 2) * p.square_mm,
                ((p.rows - 1) / 2 - row) * p.square_mm,
            )
        ]
    ]
    return Document(
        format="phantom/1",
        name="contrast-detail",
        title="Contrast-detail plate",
        materials={
            "plate": ReferenceMaterial(reference=p.material),
            "air": ReferenceMaterial(reference="air"),
        },
        solid=Replace(type="replace", solids=(plate, *holes)),
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        sources=("CDRAD 2.0, Artinis Medical Systems: the plan of the plate.",),
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="contrast-detail",
    title="Contrast-detail plate",
    summary="A plate with holes, their diameters falling from left to right, their depths downward:"
    " which of them a reader still sees tells what an image is worth.",
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=Technique(kvp=70.0, window=(0.2, 0.3)),
)
