"""Depth targets for stereo displays: plus signs on a grid, and fibrils that cross one another.

Alone, each picture of a stereo pair shows signs all alike and a tangle of threads; only together do
they tell which sign is nearer and which thread passes in front. Signs and threads as targets follow
studies of depth in stereo mammography (Goodsitt, Chan, Hadjiiski, Medical Physics 27:1305, 2000);
all measures are estimates. Depth is along y, and greater toward the source of the ``ap`` view.
"""

from __future__ import annotations

from typing import Annotated, Self

import numpy as np
from pydantic import model_validator

from phantom.document import (
    Box,
    CircleContour,
    Document,
    GeneralizedCylinder,
    Model,
    Point,
    ReferenceMaterial,
    Replace,
    Solid,
    SplineAxis,
    Union,
    told,
)
from phantom.document.base import Integer, refuse
from phantom.library import Entry, Technique
from phantoms.draws import generator_of
from phantoms.fields import ReferenceName, count, millimetres


class Parameters(Model):
    """What the depth targets may be."""

    columns: Annotated[int, count("Columns", "Of signs.", 0, 12)] = 4
    rows: Annotated[int, count("Rows", "Of signs.", 0, 12)] = 3
    fibrils: Annotated[int, count("Fibrils", "Threads below the signs.", 0, 24)] = 6
    depth_mm: Annotated[
        float, millimetres("Depth", "From the farthest target to the nearest.", 0.0, 200.0)
    ] = 40.0
    spacing_mm: Annotated[float, millimetres("Spacing", "From sign to sign.", 2.0, 100.0)] = 20.0
    thread_mm: Annotated[
        float, millimetres("Thread", "Width of a sign's bars and of a fibril.", 0.05, 5.0)
    ] = 1.0
    slab_mm: Annotated[float, millimetres("Slab", "Thickness around the targets.", 1.0, 300.0)] = (
        60.0
    )
    material: Annotated[
        ReferenceName, told("Material", "none", "A reference material for the targets.")
    ] = "aluminium"
    slab: Annotated[
        ReferenceName, told("Slab material", "none", "A reference material around them.")
    ] = "pmma"
    seed: Annotated[
        Annotated[Integer, told("Seed", "none", "Deals out the depths.", ge=0, lt=2**64)],
        told("Seed", "none", "Deals out the depths."),
    ] = 0

    @model_validator(mode="after")
    def _there_is_something_that_fits(self) -> Self:
        if self.columns * self.rows + self.fibrils == 0:
            refuse("out_of_range", (("fibrils",), "found no sign and no fibril; expected some"))
        need = self.depth_mm + 2 * self.thread_mm
        if self.slab_mm < need:
            message = f"found {self.slab_mm:g} mm; expected {need:g} mm at least, for the depth"
            refuse("does_not_fit", (("slab_mm",), message))
        return self


def _depths_mm(parameters: Parameters, number: int, generator: np.random.Generator) -> list[float]:
    """Return as many depths, evenly spaced over the range, in a random order."""
    p = parameters
    if number == 0:
        return []
    even = np.linspace(-p.depth_mm / 2, p.depth_mm / 2, number) if number > 1 else np.zeros(1)
    return [float(depth) for depth in generator.permutation(even)]


def _sign(name: str, at: Point, p: Parameters) -> tuple[Solid, ...]:
    long, thin = 0.5 * p.spacing_mm, p.thread_mm
    upright = Box(type="box", name=name, material="target", center=at, size=(thin, thin, long))
    across = Box(
        type="box", name=f"{name}-bar", material="target", center=at, size=(long, thin, thin)
    )
    return upright, across


def _fibril(name: str, depth: float, z: float, width: float, p: Parameters, bend: float) -> Solid:
    """Return a thread in the plane of its depth, bent up and down so that it crosses the others."""
    x = np.linspace(-width / 2, width / 2, 5)
    lift = bend * np.array([-1.0, 0.7, 0.0, -0.7, 1.0]) * 0.5 * p.spacing_mm
    points = tuple((float(a), -depth, float(z + b)) for a, b in zip(x, lift, strict=True))
    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material="target",
        axis=SplineAxis(points=points),
        contour=CircleContour(radius=p.thread_mm / 2),
    )


def build(parameters: Parameters) -> Document:
    """Return the slab about the origin; the landmarks tell where each target is."""
    p = parameters
    generator = generator_of(p.seed)
    width = max(p.columns, 4) * p.spacing_mm
    field = (p.rows + (2 if p.fibrils else 0)) * p.spacing_mm
    targets: list[Solid] = []
    marks: dict[str, Point] = {}
    for index, depth in enumerate(_depths_mm(p, p.columns * p.rows, generator)):
        row, column = divmod(index, p.columns)
        name = f"plus-{row + 1}-{column + 1}"
        x = (column - (p.columns - 1) / 2) * p.spacing_mm
        marks[name] = (x, -depth, field / 2 - (row + 0.5) * p.spacing_mm)
        targets += _sign(name, marks[name], p)
    middle = p.spacing_mm - field / 2
    for index, depth in enumerate(_depths_mm(p, p.fibrils, generator)):
        name = f"fibril-{index + 1:02d}"
        z = middle + (index - (p.fibrils - 1) / 2) * p.spacing_mm / max(p.fibrils, 1)
        bend = 1.0 if index % 2 else -1.0
        targets.append(_fibril(name, depth, z, 0.9 * width, p, bend))
        marks[name] = (0.0, -depth, z)
    slab = Box(
        type="box",
        name="slab",
        material="slab",
        center=(0.0, 0.0, 0.0),
        size=(width + p.spacing_mm, p.slab_mm, field + p.spacing_mm),
    )
    inside: Solid = targets[0] if len(targets) == 1 else Union(type="union", solids=tuple(targets))
    return Document(
        format="phantom/1",
        name="stereo-targets",
        title="Depth targets",
        materials={
            "slab": ReferenceMaterial(reference=p.slab),
            "target": ReferenceMaterial(reference=p.material),
        },
        solid=Replace(type="replace", solids=(slab, inside)),
        landmarks={"isocentre": (0.0, 0.0, 0.0), **marks},
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="stereo-targets",
    title="Depth targets",
    summary="Plus signs and fibrils at known depths in a slab, for stereo displays.",
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=Technique(kvp=50.0, source_detector_mm=1000.0, window=(1.8, 1.4)),
)
