"""A woman's breast, compressed as for a mammogram or not: skin, fat, gland, ducts and ligaments.

Compressed it is an ellipsoid cut by the plates and the chest wall, its edge bulging between them;
uncompressed, half an ellipsoid. The gland is a cloud of ellipsoids that point to the nipple and
fill the share of the volume that is asked for, drawn from ``seed``. In an ``mlo`` compression the
pectoral muscle reaches in from the axilla. Outlines are estimates; `parameters.SOURCES` says where
the sizes come from.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from phantom.document import (
    Anatomy,
    Cut,
    Document,
    Ellipsoid,
    Intersection,
    Point,
    ReferenceMaterial,
    Replace,
    Rotation,
    Solid,
    Transformed,
)
from phantom.library import Abnormality, Entry, Population, Technique
from phantoms.breast.lesions import KINDS, lesions
from phantoms.breast.parameters import (
    MEAN_THICKNESS_MM,
    SOURCES,
    Parameters,
    Sizes,
    of_person,
    sizes,
)
from phantoms.breast.strands import strands
from phantoms.breast.tissue import Body, lobes, lobule_solid, lobules
from phantoms.draws import generator_of
from phantoms.parts import ellipsoid, layered, sided, sided_point, union

MLO_DEG: Final = 45.0
_BULGE: Final = 0.36
"""Half the thickness over the ellipsoid's semi-axis through it: the edge is fuller than a breast's,
so that the skin is seen; systems in clinics even the edge out instead."""

_SOURCE_DETECTOR_MM, _OBJECT_DETECTOR_MM, _FIELD_MM = 650.0, 100.0, 240.0
_MISSED_MM: Final = 8.0
"""What the detector's edge leaves out before the chest wall."""


def _body(parameters: Parameters, size: Sizes, inset_mm: float) -> Body:
    """Return the breast's outside, or what lies so far inside it."""
    width, depth = size.width_mm / 2 - inset_mm, size.depth_mm - inset_mm
    if parameters.compression == "none":
        upright = 0.9 * size.width_mm / 2 - inset_mm
        return Body((width, depth, upright), upright)
    half = size.thickness_mm / 2
    lean = 0.42 if parameters.compression == "mlo" else 0.0
    return Body((width, depth, half / _BULGE - inset_mm), half - inset_mm, lean)


def _solid(body: Body, name: str | None = None, material: str | None = None) -> Ellipsoid:
    cuts = [Cut(point=(0.0, 0.0, 0.0), normal=(0.0, 1.0, 0.0))]
    if body.half_mm < body.semi_axes[2]:
        cuts += [Cut(point=(0.0, 0.0, s * body.half_mm), normal=(0.0, 0.0, s)) for s in (-1.0, 1.0)]
    return Ellipsoid(
        type="ellipsoid",
        name=name,
        material=material,
        center=(0.0, 0.0, 0.0),
        semi_axes=body.semi_axes,
        cuts=tuple(cuts),
    )


def _pectoral(size: Sizes) -> Solid:
    """Return the muscle's edge: a slab aslant, thick at the axilla and gone below the middle."""
    half = size.width_mm / 2
    flat = 0.14 * size.thickness_mm
    return Ellipsoid(
        type="ellipsoid",
        name="pectoral-muscle",
        material="muscle",
        center=(-1.15 * half, 0.25 * size.depth_mm, 0.0),
        semi_axes=(1.35 * half, 0.78 * size.depth_mm, 2.0 * flat),
        cuts=tuple(Cut(point=(0.0, 0.0, s * flat), normal=(0.0, 0.0, s)) for s in (-1.0, 1.0)),
    )


def _standing(parameters: Parameters, solid: Solid) -> Solid:
    """Return a solid drawn as in :mod:`phantoms.breast.tissue` where it is in the patient."""
    if parameters.compression == "mlo":
        turn = Rotation(axis=(0.0, 1.0, 0.0), angle_deg=MLO_DEG)
        solid = Transformed(type="transformed", solid=solid, rotate=turn)
    return sided(solid, parameters.side)


def _place(parameters: Parameters, point: Point) -> Point:
    """Return where a point drawn in that frame is in the patient."""
    x, y, z = point
    if parameters.compression == "mlo":
        turn = math.radians(MLO_DEG)
        x, z = (
            x * math.cos(turn) + z * math.sin(turn),
            z * math.cos(turn) - x * math.sin(turn),
        )
    return sided_point((x, y, z), parameters.side)


def build(parameters: Parameters, abnormalities: Sequence[Abnormality] = ()) -> Document:
    """Return the breast, the middle of its chest wall at the origin."""
    size = sizes(parameters)
    generator = generator_of(parameters.seed)
    outer, inner = _body(parameters, size, 0.0), _body(parameters, size, size.skin_mm)
    branches = lobes(inner, generator)
    thin = strands(inner, branches, parameters.strands, generator)
    share = size.glandular - (1.0 - size.glandular) * thin.volume_mm3 / inner.volume_mm3
    share = max(share, 0.25 * size.glandular)
    gland, clefts = lobules(inner, branches, parameters.lobules, share, generator)
    parts = [lobule_solid(f"lobule-{k + 1:04d}", one, "gland") for k, one in enumerate(gland)]
    gaps = [lobule_solid(f"cleft-{k + 1:03d}", one, "fat") for k, one in enumerate(clefts)]
    bound = _solid(inner)
    tip = -size.depth_mm
    mound = 0.8 * size.thickness_mm / 2 if parameters.compression != "none" else 14.0
    nipple = ellipsoid("nipple", (0.0, tip - 2.0, 0.0), (6.5, 8.0, 8.0), "skin")
    areola = (0.0, tip + 8.5, 0.0)
    within: list[Solid] = [union(*parts), union(*gaps)]
    if thin.solids:
        within.append(union(*thin.solids))
    layers: list[Solid] = [
        ellipsoid("areola", areola, (17.0, 14.5, mound), "skin"),
        _solid(outer, "skin", "skin"),
        ellipsoid("areola fat", areola, (14.0, 11.0, mound - 4.0), "fat"),
        _solid(inner, "fat", "fat"),
        Intersection(type="intersection", solids=(layered(*within), bound)),
        nipple,
    ]
    if parameters.compression == "mlo":
        layers.append(Intersection(type="intersection", solids=(_pectoral(size), bound)))
    materials = {
        "skin": ReferenceMaterial(reference="skin_icru44"),
        "fat": ReferenceMaterial(reference="adipose_icru44"),
        "gland": ReferenceMaterial(reference="breast_gland_icru44"),
        "muscle": ReferenceMaterial(reference="muscle_icru44"),
    }
    found = list(lesions(inner, abnormalities))
    for lesion in found:
        materials[lesion.material] = lesion.substance
        layers.extend(lesion.solids)
    findings = tuple(
        lesion.finding.model_copy(update={"center": _place(parameters, lesion.finding.center)})
        for lesion in found
        if lesion.finding.center is not None
    )
    aim: Point
    if parameters.compression == "none":
        aim = (0.0, -size.depth_mm / 2, 0.0)
    else:
        behind, low = _OBJECT_DETECTOR_MM, 0.0
        if parameters.compression == "mlo":
            half = size.width_mm / 2
            behind = max(behind, half * math.sqrt(1 - _BULGE**2) + size.thickness_mm / 2 + 10.0)
            low = 0.1 * half
        seen = _FIELD_MM * (1.0 - behind / _SOURCE_DETECTOR_MM)
        aim = (low, -seen / 2 - _MISSED_MM, 0.0)
    return Document(
        format="phantom/1",
        name="breast",
        title="Breast",
        description="Compressed for a mammogram." if parameters.compression != "none" else "",
        materials=materials,
        solid=_standing(parameters, Replace(type="replace", solids=tuple(layers))),
        landmarks={
            "isocentre": _place(parameters, aim),
            "nipple": _place(parameters, (0.0, -size.depth_mm, 0.0)),
        },
        anatomy=Anatomy(region="breast", laterality=parameters.side),
        sources=SOURCES,
        parameters={**parameters.model_dump(mode="json"), **size._asdict()},
        findings=findings,
    )


_TECHNIQUE: Final = Technique(
    kvp=28.0,
    anode="tungsten",
    filtration_mm={"rhodium": 0.05},
    source_detector_mm=_SOURCE_DETECTOR_MM,
    field_mm=_FIELD_MM,
    window=(3.4, 1.6),
    window_follows=("thickness_mm", MEAN_THICKNESS_MM, 0.05),
    air_kerma_ugy=100.0,
)

_UPRIGHT: Final = Technique(kvp=60.0, window=(2.0, 2.6), air_kerma_ugy=2.5)
"""From the side the uncompressed breast is too thick for 28 kV."""

entry = Entry(
    name="breast",
    title="Breast",
    summary="A woman's breast, compressed as for a mammogram or not: skin, fat, a gland of lobules,"
    " ducts and ligaments, with calcifications and masses where asked for.",
    parameters=Parameters,
    build=build,
    views=("cc", "mlo"),
    technique=_TECHNIQUE,
    techniques={"left_lateral": _UPRIGHT, "right_lateral": _UPRIGHT, "ap": _UPRIGHT},
    abnormalities=KINDS,
    of_person=of_person,
    people=Population(female=1.0),
)
