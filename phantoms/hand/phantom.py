"""The hand as a document of the library."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from phantom.document import (
    Anatomy,
    CompositionMaterial,
    Document,
    Finding,
    Point,
    ReferenceMaterial,
)
from phantom.document.substances import Material
from phantom.library import Abnormality, Entry, Technique
from phantom.library.people import Side
from phantoms.hand.abnormalities import ABNORMALITIES, CARTILAGE, DENSE, GLASS, STEEL
from phantoms.hand.afflict import Hand, afflicted
from phantoms.hand.frames import KINDS, Frame
from phantoms.hand.lengths import BONES
from phantoms.hand.parameters import Parameters, of_person
from phantoms.hand.sizes import DIGITS, DISTAL
from phantoms.hand.skeleton import Skeleton, skeleton
from phantoms.hand.soft import FAT, SKIN, SOFT, Skin, envelope
from phantoms.hand.soft import skin as skin_of
from phantoms.hand.tubular import CORTEX, MARROW, SPONGIOSA
from phantoms.parts import layered, sided, sided_point, union
from phantoms.people import cortical_density_g_cm3, spongiosa_density_g_cm3

SOURCES: Final = (
    "Buryanov, Kotiuk, Proportions of Hand Segments, Int. J. Morphol. 28 (2010) 755-758, table I:"
    " lengths of metacarpals and phalanges, soft tissue of the fingertips.",
    "Ozsoy, Oner, Oner, Medicine Science 2019: women's phalanges are 92 % as long as men's.",
    "Correlation between adult height and metacarpal length, Arch. Bone Jt. Surg. 2024, 80233:"
    " r = 0.71.",
    "Ekpo et al., J. Radiogr. Radiat. Sci. 21 (2007) 1-6: metacarpal index by sex and age.",
    "Angwin et al., J. Rheumatol. 28 (2001) 1825: finger joint space, about 1.6 mm; Pfeil et al.,"
    " Acad. Radiol. 14 (2007) 594: 15 % wider in men.",
    "Riggs et al., J. Bone Miner. Res. 19 (2004) 1945: bone density by age.",
    "Hadi, Wijiono, Med. J. Indones. 22 (2013) 173-177: inclination, tilt and height of the radius"
    " at the wrist.",
    "Fuentes et al., Cir. Cir. 74 (2006) 457-462: carpal height of men and women.",
    "Estimates: widths and outlines of all bones, the soft tissue.",
)
_TITLE: Final = "Hand and wrist"
_SUMMARY: Final = (
    "The 27 bones of a hand, the thumb's sesamoids and the ends of radius and ulna, each with"
    " cortex, spongiosa and, where it is tubular, a marrow canal, in soft tissue, fat and skin:"
    " palm down, fingers slightly spread."
)
_MIDDLE: Final = (12.0, 0.0, 54.0)
_FIELD_MM: Final = 280.0
"""Of all views: the fingertips of nearly everybody fall within, the forearm's cut end outside."""


def build(parameters: Parameters, abnormalities: Sequence[Abnormality] = ()) -> Document:
    """Return the hand, fingers up, palm to the front.

    Raises
    ------
    InvalidInputError
        An abnormality that does not fit, with a path under ``/abnormalities``.
    """
    chosen = parameters.resolved()
    healthy = skeleton(chosen)
    skin = _skin(healthy)
    hand = Hand(healthy, chosen.value("joint_space_mm"))
    hand = afflicted(hand, abnormalities, skin)
    if hand.bones is not healthy:
        skin = _skin(hand.bones)
    solid = layered(
        envelope(skin, chosen.value("fat_mm")), union(*hand.bones.solids(), *hand.splinters)
    )
    return Document(
        format="phantom/1",
        name="hand",
        title=_TITLE,
        description=_SUMMARY,
        materials=_materials(chosen),
        solid=sided(solid, chosen.side),
        landmarks=_landmarks(hand.bones, chosen.side),
        anatomy=Anatomy(region="hand", laterality=chosen.side),
        sources=SOURCES,
        parameters=chosen.model_dump(mode="json"),
        findings=tuple(_on(finding, chosen.side) for finding in hand.findings),
    )


def _skin(bones: Skeleton) -> Skin:
    frames: dict[str, list[Frame]] = {
        digit: [bones.bones[digit, kind].frame for kind in KINDS[digit]] for digit in DIGITS
    }
    ends: dict[str, float] = {digit: bones.bones[digit, DISTAL].shape.length_mm for digit in DIGITS}
    return skin_of(bones.scale, frames, ends)


def _materials(chosen: Parameters) -> dict[str, Material]:
    """Return the materials; those that only abnormalities need are the last."""
    person = chosen.person
    dense = round(cortical_density_g_cm3(person), 4)
    light = round(spongiosa_density_g_cm3(person), 4)
    return {
        SKIN: ReferenceMaterial(reference="skin_icru44"),
        FAT: ReferenceMaterial(reference="adipose_icru44"),
        SOFT: ReferenceMaterial(reference="soft_tissue_icru44"),
        CORTEX: ReferenceMaterial(reference="cortical_bone_icru44", density_g_cm3=dense),
        SPONGIOSA: ReferenceMaterial(reference="spongiosa_icru44", density_g_cm3=light),
        MARROW: ReferenceMaterial(reference="yellow_marrow_icru44"),
        CARTILAGE: ReferenceMaterial(reference="cartilage_icru44"),
        DENSE: ReferenceMaterial(reference="cortical_bone_icru44"),
        GLASS: CompositionMaterial(composition={"O": 0.533, "Si": 0.467}, density_g_cm3=2.5),
        STEEL: CompositionMaterial(
            composition={"Fe": 0.71, "Cr": 0.19, "Ni": 0.10}, density_g_cm3=7.9
        ),
    }


def _landmarks(bones: Skeleton, side: Side) -> dict[str, Point]:
    """Return the isocentre, and base and head of every tubular bone."""
    x, y, z = (bones.scale * value for value in _MIDDLE)
    marks: dict[str, Point] = {"isocentre": (x, y, z)}
    for name in BONES:
        digit, _, kind = name.partition(" ")
        placed = bones.bones[digit, kind]
        ends = (("base", 0.0), ("tip" if kind == DISTAL else "head", placed.shape.length_mm))
        for end, along in ends:
            px, py, pz = (round(float(v), 6) for v in placed.frame.point((0.0, 0.0, along)))
            marks[f"{name} {end}"] = (px, py, pz)
    return {name: sided_point(point, side) for name, point in marks.items()}


def _on(finding: Finding, side: Side) -> Finding:
    if finding.center is None:
        return finding
    return finding.model_copy(update={"center": sided_point(finding.center, side)})


def _technique(object_detector_mm: float, window: tuple[float, float]) -> Technique:
    """Return the usual technique: 50 kV, no grid."""
    return Technique(
        kvp=50.0,
        source_detector_mm=1000.0,
        object_detector_mm=object_detector_mm,
        window=window,
        air_kerma_ugy=2.5,
        field_mm=_FIELD_MM,
    )


_OBLIQUE: Final = _technique(80.0, (1.35, 2.7))

entry = Entry(
    name="hand",
    title=_TITLE,
    summary=_SUMMARY,
    parameters=Parameters,
    build=build,
    views=("pa", "rao", "mediolateral"),
    technique=_technique(45.0, (1.15, 2.3)),
    techniques={
        "rao": _OBLIQUE,
        "lao": _OBLIQUE,
        "mediolateral": _technique(75.0, (2.8, 5.6)),
    },
    abnormalities=ABNORMALITIES,
    of_person=of_person,
)
