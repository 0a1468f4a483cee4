"""The breast of spheres: balls of many sizes at random in a half ball, for stereo studies.

After Hsu, Chelberg, Babbs, Pizlo and Delp (IEEE Transactions on Medical Imaging 14:318, 1995), who
asked readers of such breasts for two kinds of abnormality: balls *arranged* against chance, which
only depth tells, and balls too *dense*, which one picture tells as well. Numbers and sizes are
estimates.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Final, Literal, Self

import numpy as np
from pydantic import model_validator

from phantom.document import (
    Cut,
    Document,
    Finding,
    Model,
    Point,
    ReferenceMaterial,
    Replace,
    Solid,
    Sphere,
    told,
)
from phantom.document.base import Integer, refuse
from phantom.errors import InvalidInputError, Problem, pointer
from phantom.library import Abnormality, Entry, Technique
from phantoms.draws import generator_of
from phantoms.fields import count, millimetres

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]


class Parameters(Model):
    """What the breast of spheres may be."""

    radius_mm: Annotated[float, millimetres("Radius", "Of the half ball.", 20.0, 150.0)] = 60.0
    spheres: Annotated[int, count("Spheres", "How many.", 1, 1000)] = 160
    smallest_mm: Annotated[float, millimetres("Smallest", "Least diameter.", 0.5, 30.0)] = 3.0
    largest_mm: Annotated[float, millimetres("Largest", "Greatest diameter.", 0.5, 30.0)] = 9.0
    seed: Annotated[Integer, told("Seed", "none", "Of the places.", ge=0, lt=2**64)] = 0

    @model_validator(mode="after")
    def _sizes_rise(self) -> Self:
        if self.smallest_mm > self.largest_mm:
            message = f"found {self.largest_mm:g} mm; expected {self.smallest_mm:g} mm at least"
            refuse("bad_range", (("largest_mm",), message))
        return self


class Arrangement(Abnormality):
    """Spheres in a ring around a point, as alike as the others in all but their places."""

    type: Literal["arrangement"] = "arrangement"
    number: Annotated[int, count("Number", "Of spheres.", 3, 40)] = 8
    ring_mm: Annotated[float, millimetres("Ring", "Its diameter.", 4.0, 100.0)] = 24.0
    diameter_mm: Annotated[float, millimetres("Diameter", "Of a sphere.", 0.5, 20.0)] = 5.0
    seed: Annotated[Integer, told("Seed", "none", "Of its place.", ge=0, lt=2**64)] = 0


class Density(Abnormality):
    """One sphere denser than the others."""

    type: Literal["density"] = "density"
    diameter_mm: Annotated[float, millimetres("Diameter", "Of the sphere.", 0.5, 30.0)] = 6.0
    density_g_cm3: Annotated[
        float, told("Density", "g/cm3", "The others have 1.02.", ge=0.5, le=3.0, strict=True)
    ] = 1.15
    seed: Annotated[Integer, told("Seed", "none", "Of its place.", ge=0, lt=2**64)] = 0


def _in_half_ball(radius_mm: float, generator: np.random.Generator) -> FloatArray:
    """Return a point of the half ball in front of the chest wall, all places alike."""
    way = generator.standard_normal(3)
    way *= radius_mm * generator.random() ** (1 / 3) / np.linalg.norm(way)
    return np.array([way[0], -abs(way[1]), way[2]])


def _ball(name: str, material: str, center: FloatArray, diameter_mm: float) -> Sphere:
    """Return a sphere; what reaches through the chest wall is cut off."""
    x, y, z = (round(float(c), 9) for c in center)
    wall = Cut(point=(0.0, 0.0, 0.0), normal=(0.0, 1.0, 0.0))
    return Sphere(
        type="sphere",
        name=name,
        material=material,
        center=(x, y, z),
        radius=diameter_mm / 2,
        cuts=(wall,) if y + diameter_mm / 2 > 0 else (),
    )


def _added(
    name: str, material: str, wanted: Abnormality, radius_mm: float
) -> tuple[list[Solid], Point, float]:
    """Return the spheres of an abnormality, its centre and its size in mm."""
    if isinstance(wanted, Density):
        generator = generator_of(wanted.seed)
        center = _in_half_ball(0.8 * radius_mm - wanted.diameter_mm / 2, generator)
        ball = _ball(name, material, center, wanted.diameter_mm)
        return [ball], ball.center, wanted.diameter_mm
    assert isinstance(wanted, Arrangement)
    generator = generator_of(wanted.seed)
    room = radius_mm - (wanted.ring_mm + wanted.diameter_mm) / 2
    middle = _in_half_ball(0.7 * room, generator)
    one, other, _ = np.linalg.qr(generator.standard_normal((3, 3)))[0]
    turns = 2 * math.pi * (np.arange(wanted.number) / wanted.number + generator.random())
    ring = [middle + wanted.ring_mm / 2 * (math.cos(t) * one + math.sin(t) * other) for t in turns]
    back = min(0.0, -1.0 - max(float(p[1]) for p in ring))  # all of it before the chest wall
    lift = np.array([0.0, back, 0.0])
    balls: list[Solid] = [
        _ball(f"{name}-{k + 1:02d}", material, p + lift, wanted.diameter_mm)
        for k, p in enumerate(ring)
    ]
    x, y, z = (round(float(c), 9) for c in middle + lift)
    return balls, (x, y, z), wanted.ring_mm


def _room_mm(wanted: Abnormality) -> tuple[str, float]:
    """Return the field that decides whether an abnormality fits, and the radius it needs."""
    if isinstance(wanted, Arrangement):
        return "ring_mm", (wanted.ring_mm + wanted.diameter_mm) / 2 + 1.0
    assert isinstance(wanted, Density)
    return "diameter_mm", wanted.diameter_mm / 2


def build(parameters: Parameters, abnormalities: Sequence[Abnormality] = ()) -> Document:
    """Return the breast, the middle of its chest wall at the origin, the nipple's side at -y."""
    p = parameters
    generator = generator_of(p.seed)
    wall = Cut(point=(0.0, 0.0, 0.0), normal=(0.0, 1.0, 0.0))
    fat = Sphere(
        type="sphere",
        name="fat",
        material="fat",
        center=(0.0, 0.0, 0.0),
        radius=p.radius_mm,
        cuts=(wall,),
    )
    solids: list[Solid] = [fat]
    for k in range(p.spheres):
        diameter = float(generator.uniform(p.smallest_mm, p.largest_mm))
        center = _in_half_ball(p.radius_mm - diameter / 2, generator)
        solids.append(_ball(f"sphere-{k + 1:03d}", "spheres", center, diameter))
    materials = {
        "fat": ReferenceMaterial(reference="adipose_icru44"),
        "spheres": ReferenceMaterial(reference="breast_gland_icru44"),
    }
    findings = []
    for index, wanted in enumerate(abnormalities):
        field, need = _room_mm(wanted)
        if need > 0.6 * p.radius_mm:
            message = f"found a reach of {need:.4g} mm; expected {0.6 * p.radius_mm:.4g} mm at most"
            path = pointer(("abnormalities", index, field))
            raise InvalidInputError([Problem(path, "does_not_fit", message)])
        kind = "density" if isinstance(wanted, Density) else "arrangement"
        name = wanted.name or f"{kind}-{index + 1}"
        material = "spheres"
        if isinstance(wanted, Density):
            material = name
            materials[name] = ReferenceMaterial(
                reference="breast_gland_icru44", density_g_cm3=wanted.density_g_cm3
            )
        added, center_mm, size_mm = _added(name, material, wanted, p.radius_mm)
        solids += added
        leaves = tuple(str(getattr(ball, "name", "")) for ball in added)
        findings.append(
            Finding(name=name, kind=kind, leaves=leaves, center=center_mm, size_mm=size_mm)
        )
    return Document(
        format="phantom/1",
        name="breast-of-spheres",
        title="Breast of spheres",
        materials=materials,
        solid=Replace(type="replace", solids=tuple(solids)),
        landmarks={"isocentre": (0.0, -p.radius_mm / 2, 0.0)},
        sources=(
            "Hsu, Chelberg, Babbs, Pizlo, Delp, IEEE Transactions on Medical Imaging 14:318, 1995.",
        ),
        parameters=p.model_dump(mode="json"),
        findings=tuple(findings),
    )


_TECHNIQUE: Final = Technique(
    kvp=40.0,
    source_detector_mm=1000.0,
    window=(1.3, 1.6),
)

entry = Entry(
    name="breast-of-spheres",
    title="Breast of spheres",
    summary="Balls at random in a half ball of fat, some arranged against chance or too dense where"
    " asked for: the phantom of the first study of stereo radiographs with this method.",
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=_TECHNIQUE,
    abnormalities={"arrangement": Arrangement, "density": Density},
)
