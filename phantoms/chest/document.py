"""The chest put together: outside in, each part in place of what was there before."""

from __future__ import annotations

from collections.abc import Sequence

from phantom.document import Anatomy, Document, Instance, Material, ReferenceMaterial, Solid
from phantom.library import Abnormality
from phantoms.chest import body, girdle, lungs, mediastinum, ribs, spine, vessels
from phantoms.chest.cage import Cage
from phantoms.chest.frame import Frame
from phantoms.chest.parameters import MODEL_HEIGHT_CM, Parameters, sizes
from phantoms.chest.sources import SOURCES
from phantoms.parts import layered, named, union

SUMMARY = (
    "A chest in deep breath: ribs, breastbone, spine and shoulder girdle, lungs with their vessels,"
    " heart, great vessels and airways, diaphragm, muscles, fat, skin and breasts."
)


def materials(parameters: Parameters) -> dict[str, Material]:
    """Return the materials; bone is less dense with age."""
    p = parameters
    older = max(p.age_years - 30.0, 0.0) / 50.0
    loss = 0.50 if p.sex == "male" else 0.58
    spongiosa = 1.0 + 0.18 * (1.0 - loss * min(older, 1.2))

    def like(reference: str, density: float | None = None) -> ReferenceMaterial:
        return ReferenceMaterial(reference=reference, density_g_cm3=density)

    cortical = 1.92 * (1.0 - (0.10 if p.sex == "male" else 0.14) * min(older, 1.2))
    return {
        "skin": like("skin_icru44"),
        "fat": like("adipose_icru44"),
        "gland": like("breast_gland_icru44"),
        "muscle": like("muscle_icru44"),
        "soft_tissue": like("soft_tissue_icru44"),
        "lung": like("lung_icru44", p.lung_density_g_cm3),
        "blood": like("blood_icru44"),
        "air": like("air"),
        "cartilage": like("cartilage_icru44"),
        "cortical_bone": like("cortical_bone_icru44", round(cortical, 4)),
        "spongiosa": like("spongiosa_icru44", round(spongiosa, 4)),
        "arch_bone": like("cortical_bone_icru44", round(0.60 * cortical, 4)),
        "blade_bone": like("cortical_bone_icru44", round(0.78 * cortical, 4)),
    }


def frame_of(parameters: Parameters) -> Frame:
    """Return the person's frame."""
    height = parameters.person.height_cm
    slight = 1.0 if parameters.sex == "male" else 0.95
    return Frame(sizes(parameters), height, slight * height / MODEL_HEIGHT_CM)


def build(parameters: Parameters, abnormalities: Sequence[Abnormality] = ()) -> Document:
    """Return the chest of a person."""
    frame = frame_of(parameters)
    cage = Cage(frame)
    sides = ("right", "left")
    definitions: dict[str, Solid] = {
        **ribs.definitions(cage),
        "cartilages": union(*(ribs.cartilage(cage, n) for n in range(1, 11))),
        **body.definitions(cage, parameters.sex),
        **spine.definitions(),
        "clavicle": girdle.clavicle(frame),
        "scapula": girdle.scapula(frame),
        "humerus": girdle.humerus(frame),
        **{f"{side} lung": lungs.lung(cage, side) for side in sides},
    }
    parts: list[Solid] = [
        *body.layers(cage, parameters.sex),
        union(*(Instance(type="instance", of=f"{side} lung") for side in sides)),
        union(*(vessels.tree(cage, side, parameters.vessel_seed) for side in sides)),
        union(*(lungs.dome(cage, side) for side in sides), lungs.tendon(cage)),
        lungs.stomach_bubble(cage),
        mediastinum.middle(cage),
        mediastinum.heart(frame),
        mediastinum.great_vessels(frame),
        mediastinum.bronchial_walls(frame),
        mediastinum.airways(frame),
        union(*(ribs.on_side("side", side, "cartilages") for side in sides)),
        named("sternum", ribs.breastbone(cage)),
        union(*(spine.placed(frame, name) for name in spine.LEVELS)),
        ribs.ribs({}),
        union(*(ribs.on_side(n, s, n) for n in ("clavicle", "scapula", "humerus") for s in sides)),
    ]
    return Document(
        format="phantom/1",
        name="chest",
        title="Chest",
        description=SUMMARY,
        materials=materials(parameters),
        definitions=definitions,
        solid=layered(*parts),
        landmarks=landmarks(frame),
        anatomy=Anatomy(region="chest"),
        sources=SOURCES,
        parameters={**parameters.model_dump(mode="json"), **frame.sizes._asdict()},
    )


def landmarks(frame: Frame) -> dict[str, tuple[float, float, float]]:
    """Return the points a study of the chest needs."""
    return {"isocentre": frame.at(0.0, 0.0, -18.0), "carina": frame.at(-3.0, 12.0, 50.0)}
