"""The chest put together: outside in, each part in place of what was there before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from phantom.document import Anatomy, Document, Instance, Material, Point, ReferenceMaterial, Solid
from phantom.library import Abnormality
from phantoms.chest import body, fissures, girdle, lungs, mediastinum, ribs, spine, vessels
from phantoms.chest.cage import Cage
from phantoms.chest.frame import Frame
from phantoms.chest.parameters import MODEL_HEIGHT_CM, Parameters, sizes
from phantoms.chest.sides import SIDES, Sides
from phantoms.chest.sources import SOURCES
from phantoms.chest.wrong import SITES, Fits, changes
from phantoms.parts import layered, named, union
from phantoms.people import cortical_density_g_cm3, spongiosa_density_g_cm3

SUMMARY = (
    "A chest in deep breath: ribs, breastbone, spine and shoulder girdle, lungs with their vessels,"
    " heart, great vessels and airways, diaphragm, muscles, fat, skin and breasts."
)


def materials(parameters: Parameters) -> dict[str, Material]:
    """Return the materials; bone is less dense with age."""
    person = parameters.person

    def like(reference: str, density: float | None = None) -> ReferenceMaterial:
        return ReferenceMaterial(reference=reference, density_g_cm3=density)

    cortical = cortical_density_g_cm3(person)
    spongiosa = spongiosa_density_g_cm3(person, central=True)
    return {
        "skin": like("skin_icru44"),
        "fat": like("adipose_icru44"),
        "gland": like("breast_gland_icru44"),
        "muscle": like("muscle_icru44"),
        "soft_tissue": like("soft_tissue_icru44"),
        "lung": like("lung_icru44", parameters.lung_density_g_cm3),
        "blood": like("blood_icru44"),
        "air": like("air"),
        "cartilage": like("cartilage_icru44"),
        "cortical_bone": like("cortical_bone_icru44", round(cortical, 4)),
        "spongiosa": like("spongiosa_icru44", round(spongiosa, 4)),
        "arch_bone": like("cortical_bone_icru44", round(0.60 * cortical, 4)),
        "blade_bone": like("cortical_bone_icru44", round(0.78 * cortical, 4)),
        "pleura": like("soft_tissue_icru44", 0.55),
    }


def frame_of(parameters: Parameters) -> Frame:
    """Return the person's frame."""
    height = parameters.person.height_cm
    slight = 1.0 if parameters.sex == "male" else 0.95
    return Frame(sizes(parameters), height, slight * height / MODEL_HEIGHT_CM, parameters.arms)


def build(parameters: Parameters, abnormalities: Sequence[Abnormality] = ()) -> Document:
    """Return the chest of a person, with what is wrong with it.

    Raises
    ------
    InvalidInputError
        An abnormality does not fit, with paths under ``/abnormalities/i``.
    """
    frame = frame_of(parameters)
    cage = Cage(frame, Sides.drawn(parameters.asymmetry, parameters.asymmetry_seed))
    organs = _organs(cage)
    lung_definitions: dict[str, Solid] = {f"{side} lung": lungs.lung(cage, side) for side in SIDES}
    wrong = changes(cage, abnormalities, lambda: _in_lungs(organs, lung_definitions))
    both = tuple(Instance(type="instance", of=name) for name in lung_definitions)
    trees = union(*(vessels.tree(cage, side, parameters.vessel_seed) for side in SIDES))
    parts: list[Solid] = [
        *body.layers(cage, parameters.sex),
        union(*both),
        fissures.fissures(frame),
        trees,
        *wrong.in_lungs,
        *organs,
        union(*(ribs.cartilages(cage, side) for side in SIDES)),
        named("sternum", ribs.breastbone(cage)),
        union(*(spine.placed(frame, name) for name in spine.LEVELS)),
        ribs.ribs(cage, wrong.ribs),
        union(*(girdle.bone(cage, name) for name in ("clavicle", "scapula"))),
        girdle.kept(frame, girdle.bone(cage, "humerus"), "humeri"),
        *wrong.at_last,
    ]
    return Document(
        format="phantom/1",
        name="chest",
        title="Chest",
        description=SUMMARY,
        materials={**materials(parameters), **wrong.materials},
        definitions={
            **ribs.definitions(cage),
            **body.definitions(cage, parameters.sex),
            **spine.definitions(),
            "clavicle": girdle.clavicle(frame),
            "scapula": girdle.scapula(frame),
            "humerus": girdle.humerus(frame),
            **lung_definitions,
        },
        solid=layered(*parts),
        landmarks=landmarks(frame),
        anatomy=Anatomy(region="chest"),
        sources=SOURCES,
        parameters={**parameters.model_dump(mode="json"), **frame.sizes._asdict()},
        findings=tuple(wrong.findings),
    )


def _organs(cage: Cage) -> list[Solid]:
    """Return what takes its place in the lungs: diaphragm, heart, vessels and airways."""
    frame = cage.frame
    return [
        union(*(lungs.dome(cage, side) for side in SIDES), lungs.tendon(cage)),
        lungs.stomach_bubble(cage),
        mediastinum.middle(cage),
        mediastinum.heart(frame),
        mediastinum.great_vessels(frame),
        mediastinum.bronchial_walls(frame),
        mediastinum.airways(frame),
    ]


def _in_lungs(organs: Sequence[Solid], own: Mapping[str, Solid]) -> Fits:
    """Return a function that tells which points are in a lung and in none of its neighbours."""
    from phantom.scene import load
    from phantom.tracing import materials_at

    instances = [Instance(type="instance", of=name) for name in own]
    words = ("lung", "soft_tissue", "air", "muscle", "blood")
    scene = load(
        Document(
            format="phantom/1",
            materials={name: ReferenceMaterial(reference="water") for name in words},
            definitions=dict(own),
            solid=layered(union(*instances), *organs),
        ).model_dump(mode="json")
    )
    return lambda points: materials_at(scene, points)[:, 0] > 0


def landmarks(frame: Frame) -> dict[str, Point]:
    """Return the points a study of the chest needs."""
    return {
        "isocentre": frame.at(0.0, 0.0, -18.0),
        "carina": frame.at(-3.0, 12.0, 50.0),
        **{name.replace(" ", "_"): frame.at(*place) for name, place in SITES.items()},
    }
