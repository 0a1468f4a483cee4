"""A step wedge: the test object that turns thickness into grey levels.

Steps stand side by side along x on one plane that faces the detector of the ``ap`` view; step k
is k + 1 step heights thick along y.
"""

from __future__ import annotations

from typing import Annotated

from phantom.document import Box, Document, Model, ReferenceMaterial, Solid, Union, told
from phantom.library import Entry
from phantoms.fields import ReferenceName


class Parameters(Model):
    """What a step wedge may be."""

    steps: Annotated[
        int, told("Steps", "none", "How many there are.", ge=1, le=50, strict=True)
    ] = 10
    step_height_mm: Annotated[
        float, told("Step height", "mm", "Along the beam (y).", ge=0.01, le=50.0, strict=True)
    ] = 2.0
    step_length_mm: Annotated[
        float, told("Step length", "mm", "From step to step (x).", ge=0.1, le=100.0, strict=True)
    ] = 10.0
    width_mm: Annotated[
        float, told("Width", "mm", "Along the steps' edges (z).", ge=0.1, le=400.0, strict=True)
    ] = 30.0
    material: Annotated[
        ReferenceName, told("Material", "none", "A reference material that the steps are made of.")
    ] = "aluminium"


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
