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
    Union,
)
from phantom.library import Abnormality, Entry, Technique
from phantoms.breast.lesions import KINDS, lesions
from phantoms.breast.parameters import SOURCES, Parameters, Sizes, of_person, sizes
from phantoms.breast.tissue import Body, lobule_solid, lobules, strands
from phantoms.draws import generator_of
from phantoms.parts import ellipsoid, sided, sided_point

MLO_DEG: Final = 45.0
_BULGE: Final = 0.55  # half the thickness over the ellipsoid's semi-axis through it


def _body(parameters: Parameters, size: Sizes, inset_mm: float) -> Body:
    """Return the breast's outside, or what lies so far inside it."""
    width, depth = size.width_mm / 2 - inset_mm, size.depth_mm - inset_mm
    if parameters.compression == "none":
        upright = 0.9 * size.width_mm / 2 - inset_mm
        return Body((width, depth, upright), upright)
    half = size.thickness_mm / 2
    return Body((width, depth, half / _BULGE - inset_mm), half - inset_mm)


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
    return Ellipsoid(
        type="ellipsoid",
        name="pectoral-muscle",
        material="muscle",
        center=(-half, 0.12 * size.depth_mm, 0.0),
        semi_axes=(1.25 * half, 0.52 * size.depth_mm, 0.3 * size.thickness_mm),
        cuts=(Cut(point=(0.25 * half, 0.0, 0.0), normal=(1.0, 0.0, 0.0)),),
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
    gland = [
        lobule_solid(f"lobule-{k + 1:03d}", lobule)
        for k, lobule in enumerate(lobules(inner, parameters.lobules, size.glandular, generator))
    ]
    gland += strands(inner, parameters.strands, generator)
    bound = _solid(inner)
    nipple = ellipsoid("nipple", (0.0, 0.5 - size.depth_mm, 0.0), (5.5, 7.0, 5.5), "skin")
    layers: list[Solid] = [
        nipple,
        _solid(outer, "skin", "skin"),
        _solid(inner, "fat", "fat"),
        Intersection(type="intersection", solids=(Union(type="union", solids=tuple(gland)), bound)),
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
    middle = _place(parameters, (0.0, -size.depth_mm / 2, 0.0))
    return Document(
        format="phantom/1",
        name="breast",
        title="Breast",
        description="Compressed for a mammogram." if parameters.compression != "none" else "",
        materials=materials,
        solid=_standing(parameters, Replace(type="replace", solids=tuple(layers))),
        landmarks={
            "isocentre": middle,
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
    source_detector_mm=650.0,
    window=(3.05, 1.9),
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
)
