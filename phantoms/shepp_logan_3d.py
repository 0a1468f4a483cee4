"""The head phantom of Shepp and Logan in three dimensions, as Kak and Slaney tabulate it.

Kak, Slaney, Principles of Computerized Tomographic Imaging, SIAM 2001, section 3.2: ten
ellipsoids whose grey values add up where they overlap. A document has no negative attenuation, so
each region is given its sum: ellipsoids replace what they lie in, and where two of the inner ones
overlap (two pairs do) their intersection does.

x to the patient's left and z to the head are the table's; its y points to the face, ours to the
back. The unit of length is ``semi_axis_mm``, that of attenuation ``attenuation_per_mm``.
"""

from __future__ import annotations

from typing import Annotated, Final, NamedTuple

from phantom.document import (
    Document,
    Ellipsoid,
    FixedMaterial,
    Intersection,
    Model,
    Replace,
    Rotation,
    Solid,
    Transformed,
    told,
)
from phantom.library import Entry, Technique
from phantoms.fields import millimetres


class Part(NamedTuple):
    """One ellipsoid: its grey value, semi-axes, centre, and turn from x to y in degrees."""

    name: str
    grey: float
    semi_axes: tuple[float, float, float]
    center: tuple[float, float, float]
    turn_deg: float = 0.0


TABLE: Final = (
    Part("skull", 2.0, (0.69, 0.92, 0.90), (0.0, 0.0, 0.0)),
    Part("brain", -0.98, (0.6624, 0.874, 0.88), (0.0, 0.0, 0.0)),
    Part("right-ventricle", -0.02, (0.41, 0.16, 0.21), (-0.22, 0.0, -0.25), 108.0),
    Part("left-ventricle", -0.02, (0.31, 0.11, 0.22), (0.22, 0.0, -0.25), 72.0),
    Part("front", 0.02, (0.21, 0.25, 0.50), (0.0, 0.35, -0.25)),
    Part("ball", 0.02, (0.046, 0.046, 0.046), (0.0, 0.1, -0.25)),
    Part("right-spot", 0.01, (0.046, 0.023, 0.02), (-0.08, -0.65, -0.25)),
    Part("left-spot", 0.01, (0.046, 0.023, 0.02), (0.06, -0.65, -0.25), 90.0),
    Part("upper-back", 0.02, (0.056, 0.04, 0.10), (0.06, -0.105, 0.625), 90.0),
    Part("upper-front", -0.02, (0.056, 0.056, 0.10), (0.0, 0.1, 0.625)),
)
OVERLAPS: Final = ((2, 4), (4, 5))
"""The inner ellipsoids that overlap, by pairs."""


class Parameters(Model):
    """What the head may be."""

    semi_axis_mm: Annotated[
        float, millimetres("Unit of length", "1 of the table, in mm.", 1.0, 1000.0)
    ] = 100.0
    attenuation_per_mm: Annotated[
        float, told("Attenuation", "1/mm", "Of grey value 1.", ge=1e-6, le=1.0, strict=True)
    ] = 0.02


def _ellipsoid(part: Part, material: str, unit_mm: float, name: str) -> Solid:
    """Return the part in the patient's axes: y is turned over, and with it the sense of turns."""
    a, b, c = (unit_mm * s for s in part.semi_axes)
    x, y, z = part.center
    center = (unit_mm * x, -unit_mm * y, unit_mm * z)
    solid = Ellipsoid(
        type="ellipsoid", name=name, material=material, center=center, semi_axes=(a, b, c)
    )
    if part.turn_deg == 0.0:
        return solid
    turn = Rotation(axis=(0.0, 0.0, 1.0), angle_deg=-part.turn_deg, about=center)
    return Transformed(type="transformed", solid=solid, rotate=turn)


def build(parameters: Parameters) -> Document:
    """Return the head about the origin."""
    p = parameters
    skull, brain, *inner = TABLE
    greys = {"skull": skull.grey, "brain": skull.grey + brain.grey}
    ground = greys["brain"]
    solids = [
        _ellipsoid(skull, "skull", p.semi_axis_mm, "skull"),
        _ellipsoid(brain, "brain", p.semi_axis_mm, "brain"),
    ]
    for part in inner:
        greys[part.name] = ground + part.grey
        solids.append(_ellipsoid(part, part.name, p.semi_axis_mm, part.name))
    for pair in OVERLAPS:
        one, other = (TABLE[k] for k in pair)
        name = f"{one.name}-and-{other.name}"
        greys[name] = ground + one.grey + other.grey
        both = (
            _ellipsoid(one, name, p.semi_axis_mm, name),
            _ellipsoid(other, name, p.semi_axis_mm, f"{name}-bound"),
        )
        solids.append(Intersection(type="intersection", solids=both))
    return Document(
        format="phantom/1",
        name="shepp-logan-3d",
        title="Shepp-Logan head, 3-D",
        materials={
            name: FixedMaterial(attenuation_per_mm=round(grey, 9) * p.attenuation_per_mm)
            for name, grey in greys.items()
        },
        solid=Replace(type="replace", solids=tuple(solids)),
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        sources=(
            "Kak, Slaney, Principles of Computerized Tomographic Imaging, SIAM 2001, section 3.2.",
        ),
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="shepp-logan-3d",
    title="Shepp-Logan head, 3-D",
    summary="Ten ellipsoids whose grey values add up: the head phantom of tomography, whose"
    " projections are known in closed form.",
    parameters=Parameters,
    build=build,
    views=("ap", "left_lateral"),
    technique=Technique(window=(2.6, 3.0)),
)
