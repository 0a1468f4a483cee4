"""A ball: the test object whose radiograph is known in closed form.

A ray at distance d from the centre crosses 2·√(R² − d²) of it, the chord of a circle.
"""

from __future__ import annotations

from typing import Annotated

from phantom.document import Document, FixedMaterial, Model, ReferenceMaterial, Sphere, told
from phantom.library import Entry
from phantoms.fields import ReferenceName


class Parameters(Model):
    """What a sphere may be."""

    radius_mm: Annotated[
        float, told("Radius", "mm", "Of the ball.", ge=0.1, le=200.0, strict=True)
    ] = 25.0
    material: Annotated[
        ReferenceName, told("Material", "none", "A reference material that fills the ball.")
    ] = "cortical_bone_icru44"
    attenuation_per_mm: Annotated[
        float | None,
        told(
            "Attenuation",
            "1/mm",
            "Holds at every energy, in place of the material's.",
            ge=0.0,
            le=10.0,
            strict=True,
        ),
    ] = None


def build(parameters: Parameters) -> Document:
    """Return the sphere, centred on the origin."""
    fixed = parameters.attenuation_per_mm
    material = (
        ReferenceMaterial(reference=parameters.material)
        if fixed is None
        else FixedMaterial(attenuation_per_mm=fixed)
    )
    return Document(
        format="phantom/1",
        name="sphere",
        title="Sphere",
        materials={"ball": material},
        solid=Sphere(
            type="sphere",
            name="ball",
            material="ball",
            center=(0.0, 0.0, 0.0),
            radius=parameters.radius_mm,
        ),
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        parameters=parameters.model_dump(mode="json"),
    )


entry = Entry(
    name="sphere",
    title="Sphere",
    summary="A ball of one material about the origin, whose path lengths are chords of a circle.",
    parameters=Parameters,
    build=build,
    views=("ap",),
)
