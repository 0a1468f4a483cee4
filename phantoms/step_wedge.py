"""A step wedge: the test object that turns thickness into grey levels.

Steps stand side by side along x on one plane that faces the detector of the ``ap`` view; step k
is k + 1 step heights thick along y.
"""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from phantom.document import Box, Document, ReferenceMaterial, Solid, Union
from phantom.library import Entry
from phantoms.fields import ReferenceName


class Parameters(BaseModel):
    """What a step wedge may be."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    steps: int = Field(10, ge=1, le=50, title="Steps", description="how many there are")
    step_height_mm: float = Field(
        2.0, ge=0.01, le=50.0, title="Step height", description="in mm, along the beam (y)"
    )
    step_length_mm: float = Field(
        10.0, ge=0.1, le=100.0, title="Step length", description="in mm, from step to step (x)"
    )
    width_mm: float = Field(
        30.0, ge=0.1, le=400.0, title="Width", description="in mm, along the steps' edges (z)"
    )
    material: ReferenceName = Field(
        "aluminium", title="Material", description="a reference material"
    )


def _step(parameters: Parameters, index: int) -> Box:
    """Return one step, its foot on the plane y = half the tallest step."""
    tallest = parameters.steps * parameters.step_height_mm
    thickness = (index + 1) * parameters.step_height_mm
    middle = (index + 0.5 - parameters.steps / 2) * parameters.step_length_mm
    return Box(
        type="box",
        name=f"step-{index + 1:02d}",
        material="wedge",
        center=(middle, (tallest - thickness) / 2, 0.0),
        size=(parameters.step_length_mm, thickness, parameters.width_mm),
    )


def build(parameters: Parameters) -> Document:
    """Return the wedge, its bounding box centred on the origin, thickest at +x."""
    steps = tuple(_step(parameters, index) for index in range(parameters.steps))
    solid: Solid = steps[0] if len(steps) == 1 else Union(type="union", solids=steps)
    return Document(
        format="phantom/1",
        name="step-wedge",
        title="Step wedge",
        materials={"wedge": ReferenceMaterial(reference=parameters.material)},
        solid=solid,
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        parameters=parameters.model_dump(mode="json"),
    )


entry = Entry(
    name="step-wedge",
    title="Step wedge",
    summary="Steps of one material, each thicker than the last by one step height.",
    parameters=Parameters,
    build=build,
    views=("ap",),
)
