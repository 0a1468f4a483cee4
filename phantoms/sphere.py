"""A ball: the test object whose radiograph is known in closed form.

A ray at distance d from the centre crosses 2·√(R² − d²) of it, the chord of a circle.
"""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from phantom.document import Document, FixedMaterial, ReferenceMaterial, Sphere
from phantom.library import Entry
from phantoms.fields import ReferenceName


class Parameters(BaseModel):
    """What a sphere may be."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    radius_mm: float = Field(25.0, ge=0.1, le=200.0, title="Radius", description="in mm")
    material: ReferenceName = Field(
        "cortical_bone_icru44", title="Material", description="a reference material"
    )
    attenuation_per_mm: float | None = Field(
        None,
        ge=0.0,
        le=10.0,
        title="Fixed attenuation",
        description="in 1/mm, the same at every energy; takes the place of the material",
    )


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
