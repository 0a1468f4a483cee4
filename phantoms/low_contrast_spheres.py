"""Low-contrast spheres in a block: diameters across, contrasts down.

A sphere is of the block's own material, denser by its contrast, so that the ratio of its
attenuation to the block's is the same at every energy.
"""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from phantom.document import Box, Document, Model, ReferenceMaterial, Replace, Sphere, told
from phantom.document.base import Number, refuse
from phantom.library import Entry, Technique
from phantom.materials import reference
from phantoms.fields import ReferenceName, millimetres

Diameter = Annotated[Number, told("Diameter", "mm", "Of a sphere.", ge=0.1, le=100.0)]
Contrast = Annotated[Number, told("Contrast", "1", "Of density.", ge=-0.99, le=5.0)]


class Parameters(Model):
    """What a block with spheres may be."""

    diameters_mm: Annotated[
        tuple[Diameter, ...],
        told("Diameters", "mm", "One a column.", min_length=1, max_length=20),
    ] = (16.0, 12.0, 8.0, 6.0, 4.0, 3.0)
    contrasts: Annotated[
        tuple[Contrast, ...],
        told("Contrasts", "1", "One a row: density over the block's, less 1.", min_length=1),
    ] = (0.20, 0.10, 0.05, 0.02)
    spacing_mm: Annotated[float, millimetres("Spacing", "From sphere to sphere.", 1.0, 200.0)] = (
        24.0
    )
    thickness_mm: Annotated[
        float, millimetres("Thickness", "Of the block, along the beam (y).", 1.0, 500.0)
    ] = 50.0
    material: Annotated[
        ReferenceName, told("Material", "none", "A reference material for the block.")
    ] = "water"

    @model_validator(mode="after")
    def _spheres_fit(self) -> Self:
        most = min(self.spacing_mm, self.thickness_mm)
        for index, diameter in enumerate(self.diameters_mm):
            if diameter > most:
                message = (
                    f"found {diameter:g} mm; expected no more than the spacing and the"
                    f" thickness, {most:g} mm"
                )
                refuse("does_not_fit", (("diameters_mm", index), message))
        return self


def build(parameters: Parameters) -> Document:
    """Return the block about the origin, with the spheres in its middle plane."""
    p = parameters
    density = reference(p.material).density_g_cm3
    columns, rows = len(p.diameters_mm), len(p.contrasts)
    block = Box(
        type="box",
        name="block",
        material="block",
        center=(0.0, 0.0, 0.0),
        size=(columns * p.spacing_mm, p.thickness_mm, rows * p.spacing_mm),
    )
    spheres = [
        Sphere(
            type="sphere",
            name=f"sphere-{row + 1}-{column + 1}",
            material=f"contrast-{row + 1}",
            center=(
                (column - (columns - 1) / 2) * p.spacing_mm,
                0.0,
                ((rows - 1) / 2 - row) * p.spacing_mm,
            ),
            radius=diameter / 2,
        )
        for row in range(rows)
        for column, diameter in enumerate(p.diameters_mm)
    ]
    materials = {"block": ReferenceMaterial(reference=p.material)}
    for row, contrast in enumerate(p.contrasts):
        materials[f"contrast-{row + 1}"] = ReferenceMaterial(
            reference=p.material, density_g_cm3=density * (1 + contrast)
        )
    return Document(
        format="phantom/1",
        name="low-contrast-spheres",
        title="Low-contrast spheres",
        materials=materials,
        solid=Replace(type="replace", solids=(block, *spheres)),
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="low-contrast-spheres",
    title="Low-contrast spheres",
    summary="Spheres a little denser than the block around them, of falling diameter from left to"
    " right and of falling contrast downward.",
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=Technique(kvp=70.0, window=(1.3, 0.5)),
)
