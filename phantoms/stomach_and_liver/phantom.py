"""Stomach and liver as a document of the library."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from phantom.document import Anatomy, CompositionMaterial, Document, ReferenceMaterial
from phantom.document.substances import Material
from phantom.errors import InvalidInputError, Problem
from phantom.library import Abnormality, Entry, Technique
from phantoms.parts import layered, named, union
from phantoms.people import cortical_density_g_cm3, muscle_scale, spongiosa_density_g_cm3
from phantoms.stomach_and_liver.abnormalities import ABNORMALITIES, Surroundings, add
from phantoms.stomach_and_liver.belly import pelvis, viscera
from phantoms.stomach_and_liver.mucosa import duodenum, folds
from phantoms.stomach_and_liver.organs import AIR, BARIUM, LIVER, WALL, Stomach, liver, reaches
from phantoms.stomach_and_liver.parameters import Parameters, of_person
from phantoms.stomach_and_liver.spine import CORTEX, SPONGIOSA, psoas, ribs, spine
from phantoms.stomach_and_liver.trunk import (
    FAT,
    LUNG,
    MIDDLE_MM,
    MUSCLE,
    SKIN,
    VISCERA,
    envelope,
    lungs,
    trunk_of,
)

SOURCES: Final = (
    "Feng et al., World J. Gastroenterol. 23 (2017) 4968: liver volume 758.259 BSA - 124.272 cm³.",
    "Du Bois, Du Bois, Arch. Intern. Med. 17 (1916) 863: body surface.",
    "Pickhardt, Asher, AJR 181 (2003) 973: gastric wall 5.1 ± 1.6 mm in the antrum, 2.0 ± 0.4 mm"
    " in the body.",
    "Int. J. Spine Surg., table 6, measurements at L5: heights and pedicles.",
    "Riggs et al., J. Bone Miner. Res. 19 (2004) 1945: bone density by age.",
    "Estimates: the stomach's axis, 250 to 300 mm, and lumen; shapes and places of all organs; the"
    " folds; the rest of the spine, ribs, hips, muscles, cavity and fat.",
)
_TITLE: Final = "Stomach and liver"
_SUMMARY: Final = (
    "The upper belly of a person who stands and has drunk barium: the stomach as one generalized"
    " cylinder along a J, air over barium between its folds; duodenum, liver, kidneys, spine, hips,"
    " lower ribs, psoas, heart and lung bases, in muscle, fat and skin."
)
_BARIUM_SULPHATE_G_CM3: Final = 4.5
_MOST_LUMEN: Final = 0.4


def build(parameters: Parameters, abnormalities: Sequence[Abnormality] = ()) -> Document:
    """Return the phantom, the middle of the third lumbar vertebra near the origin.

    Raises
    ------
    InvalidInputError
        An abnormality that does not fit, with a path under ``/abnormalities``.
    """
    chosen = parameters.resolved()
    person = chosen.person
    scale = person.height_cm / 168.5
    organ, sections = liver(scale, chosen.value("liver_volume_cm3"))
    axis, lumen = chosen.value("stomach_axis_mm"), chosen.value("stomach_lumen_mm")
    if lumen > _MOST_LUMEN * axis:
        message = f"found {lumen:g} mm; expected at most {_MOST_LUMEN * axis:.4g}, for the axis"
        raise InvalidInputError([Problem("/parameters/stomach_lumen_mm", "out_of_range", message)])
    stomach = Stomach(scale, axis, lumen, chosen.stomach_wall_mm)
    highest = max(row.at[2] + row.x[1] for row in sections)
    trunk = trunk_of(
        person,
        scale,
        chosen.value("fat_mm"),
        reached=[*stomach.reaches, *reaches(sections)],
        highest_mm=highest,
    )
    low, high = stomach.heights_mm
    level = low + chosen.filling * (high - low)
    wrong, findings = add(stomach, level, abnormalities, Surroundings(trunk, sections, scale))
    solid = layered(
        envelope(trunk),
        *lungs(trunk, scale, highest),
        *viscera(trunk, scale),
        union(*psoas(scale, muscle_scale(person), trunk)),
        organ,
        union(*spine(scale), *pelvis(trunk, scale), *(ribs(scale, trunk) if chosen.ribs else [])),
        named(
            "duodenum",
            layered(duodenum(stomach, scale), stomach.bulb(scale, chosen.stomach_wall_mm)),
        ),
        named(
            "stomach",
            layered(*stomach.solids(level, chosen.coating_mm), *folds(stomach, chosen.coating_mm)),
        ),
        *wrong,
    )
    return Document(
        format="phantom/1",
        name="stomach-and-liver",
        title=_TITLE,
        description=_SUMMARY,
        materials=_materials(chosen),
        solid=solid,
        landmarks={
            "isocentre": (0.0, 0.0, scale * MIDDLE_MM),
            "fundus": stomach.lumen[0].at,
            "pylorus": stomach.lumen[-1].at,
            "barium level": (*(float(v) for v in stomach.frame(0.3)[0][:2]), level),
        },
        anatomy=Anatomy(region="abdomen"),
        sources=SOURCES,
        parameters=chosen.model_dump(mode="json"),
        findings=tuple(findings),
    )


def _materials(chosen: Parameters) -> dict[str, Material]:
    person = chosen.person
    dense = round(cortical_density_g_cm3(person), 4)
    light = round(spongiosa_density_g_cm3(person, central=True), 4)
    return {
        SKIN: ReferenceMaterial(reference="skin_icru44"),
        FAT: ReferenceMaterial(reference="adipose_icru44"),
        MUSCLE: ReferenceMaterial(reference="muscle_icru44"),
        # Bowel and the fat about it: more like fat than like muscle.
        VISCERA: ReferenceMaterial(reference="adipose_icru44", density_g_cm3=1.0),
        LUNG: ReferenceMaterial(reference="lung_icru44"),
        LIVER: ReferenceMaterial(reference="soft_tissue_icru44"),
        CORTEX: ReferenceMaterial(reference="cortical_bone_icru44", density_g_cm3=dense),
        SPONGIOSA: ReferenceMaterial(reference="spongiosa_icru44", density_g_cm3=light),
        WALL: ReferenceMaterial(reference="muscle_icru44"),
        AIR: CompositionMaterial(
            composition={"N": 0.755, "O": 0.232, "Ar": 0.013}, density_g_cm3=0.0012
        ),
        BARIUM: suspension(chosen.barium_g_ml),
    }


def suspension(barium_sulphate_g_ml: float) -> CompositionMaterial:
    """Return barium sulphate in water, so many grams in each millilitre of the suspension."""
    density = barium_sulphate_g_ml + (1.0 - barium_sulphate_g_ml / _BARIUM_SULPHATE_G_CM3)
    salt = barium_sulphate_g_ml / density
    water = 1.0 - salt
    return CompositionMaterial(
        composition={
            "H": round(0.1119 * water, 6),
            "O": round(0.8881 * water + 0.2742 * salt, 6),
            "S": round(0.1374 * salt, 6),
            "Ba": round(0.5884 * salt, 6),
        },
        density_g_cm3=round(density, 6),
    )


entry = Entry(
    name="stomach-and-liver",
    title=_TITLE,
    summary=_SUMMARY,
    parameters=Parameters,
    build=build,
    views=("ap",),
    technique=Technique(
        kvp=78.0,
        source_detector_mm=1150.0,
        window=(5.3, 5.8),
        air_kerma_ugy=2.5,
        field_mm=345.0,
    ),
    abnormalities=ABNORMALITIES,
    of_person=of_person,
)
