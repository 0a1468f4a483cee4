"""A bar pattern: groups of lead bars, each group finer than the last.

A group of f line pairs a millimetre has bars 1/(2f) wide with gaps as wide between them, as in the
resolution charts that hang in X-ray rooms: 0.05 mm of lead, frequencies in steps of the R10 series.
"""

from __future__ import annotations

from typing import Annotated, Final

from phantom.document import (
    Box,
    CompositionMaterial,
    Document,
    Model,
    ReferenceMaterial,
    Replace,
    Rotation,
    Transformed,
    told,
)
from phantom.document.base import Number
from phantom.library import Entry, Technique
from phantoms.fields import count, millimetres

LEAD_G_CM3: Final = 11.35
_GAP_MM: Final = 3.0
_R10: Final = (0.5, 0.63, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0)


class Parameters(Model):
    """What a bar pattern may be."""

    pairs_per_mm: Annotated[
        tuple[Annotated[Number, told("Frequency", "1/mm", "Of a group.", ge=0.05, le=50.0)], ...],
        told("Frequencies", "1/mm", "Line pairs a millimetre.", min_length=1, max_length=40),
    ] = _R10
    bars: Annotated[int, count("Bars", "In each group.", 2, 20)] = 5
    length_mm: Annotated[float, millimetres("Length", "Of a bar.", 0.1, 200.0)] = 12.0
    thickness_mm: Annotated[
        float, millimetres("Thickness", "Of the lead, along the beam.", 0.001, 5.0)
    ] = 0.05
    angle_deg: Annotated[
        float,
        told("Angle", "degrees", "Of the bars to the detector's columns.", ge=-90, le=90),
    ] = 0.0


def group_spans_mm(parameters: Parameters) -> list[tuple[float, float]]:
    """Return where each group begins along x, and its bar's width; the middle of all is at 0."""
    widths = [0.5 / f for f in parameters.pairs_per_mm]
    reach = [(2 * parameters.bars - 1) * width for width in widths]
    x = -(sum(reach) + _GAP_MM * (len(reach) - 1)) / 2
    spans = []
    for width, across in zip(widths, reach, strict=True):
        spans.append((x, width))
        x += across + _GAP_MM
    return spans


def build(parameters: Parameters) -> Document:
    """Return the chart about the origin, its bars along z on a thin sheet of PMMA."""
    p = parameters
    spans = group_spans_mm(p)
    bars = [
        Box(
            type="box",
            name=f"group-{group + 1:02d}-bar-{bar + 1:02d}",
            material="lead",
            center=(start + (2 * bar + 0.5) * width, 0.0, 0.0),
            size=(width, p.thickness_mm, p.length_mm),
        )
        for group, (start, width) in enumerate(spans)
        for bar in range(p.bars)
    ]
    sheet = Box(
        type="box",
        name="sheet",
        material="sheet",
        center=(0.0, 0.5 + p.thickness_mm / 2, 0.0),
        size=(2 * _GAP_MM - 2 * spans[0][0], 1.0, p.length_mm + 2 * _GAP_MM),
    )
    chart = Transformed(
        type="transformed",
        solid=Replace(type="replace", solids=(sheet, *bars)),
        rotate=Rotation(axis=(0.0, 1.0, 0.0), angle_deg=p.angle_deg),
    )
    return Document(
        format="phantom/1",
        name="line-pairs",
        title="Bar pattern",
        materials={
            "sheet": ReferenceMaterial(reference="pmma"),
            "lead": CompositionMaterial(composition={"Pb": 1.0}, density_g_cm3=LEAD_G_CM3),
        },
        solid=chart,
        landmarks={"isocentre": (0.0, 0.0, 0.0)},
        parameters=p.model_dump(mode="json"),
    )


entry = Entry(
    name="line-pairs",
    title="Bar pattern",
    summary="Groups of lead bars from coarse to fine: the finest group whose bars are seen apart is"
    " the limit of resolution.",
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=Technique(kvp=50.0),
)
