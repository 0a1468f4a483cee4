"""A slanted edge: a tungsten plate whose edge crosses the detector's columns at a small angle.

IEC 62220-1-1:2015: 1.0 mm of tungsten, 100 mm by 75 mm, tilted by 1.5 to 3 degrees; the modulation
transfer function follows from the edge's many crossings of the pixels.
"""

from __future__ import annotations

from typing import Annotated, Final

from phantom.document import (
    Box,
    CompositionMaterial,
    Document,
    Model,
    Rotation,
    Transformed,
    told,
)
from phantom.library import Entry, Technique
from phantoms.fields import millimetres

TUNGSTEN_G_CM3: Final = 19.3


class Parameters(Model):
    """What a slanted edge may be."""

    angle_deg: Annotated[
        float, told("Angle", "degrees", "Of the edge to the columns.", ge=-45.0, le=45.0)
    ] = 3.0
    width_mm: Annotated[float, millimetres("Width", "From the edge on.", 1.0, 300.0)] = 75.0
    length_mm: Annotated[float, millimetres("Length", "Along the edge.", 1.0, 300.0)] = 100.0
    thickness_mm: Annotated[float, millimetres("Thickness", "Along the beam (y).", 0.01, 20.0)] = (
        1.0
    )


def build(parameters: Parameters) -> Document:
    """Return the plate; its edge passes through the origin and the plate lies at +x of it."""
    p = parameters
    plate = Box(
        type="box",
        name="plate",
        material="tungsten",
        center=(p.width_mm / 2, 0.0, 0.0),
        size=(p.width_mm, p.thickness_mm, p.length_mm),
    )
    return Document(
        format="phantom/1",
        name="slanted-edge",
        title="Slanted edge",
        materials={
            "tungsten": CompositionMaterial(composition={"W": 1.0}, density_g_cm3=TUNGSTEN_G_CM3)
        },
        solid=Transformed(
            type="transformed",
            solid=plate,
            rotate=Rotation(axis=(0.0, 1.0, 0.0), angle_deg=p.angle_deg),
        ),
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        sources=("IEC 62220-1-1:2015, the edge test device.",),
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="slanted-edge",
    title="Slanted edge",
    summary="A tungsten plate whose edge is tilted by a few degrees: what a detector makes of it"
    " gives the modulation transfer function.",
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=Technique(kvp=70.0),
)
