"""The document of a knee."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from phantom.document import Anatomy, Document, Finding, Point, ReferenceMaterial
from phantoms.knee import condyles, trabeculae
from phantoms.knee.abnormalities import Wrong
from phantoms.knee.parameters import SOURCES, Parameters, resolved, sizes_of
from phantoms.knee.placing import placed
from phantoms.knee.plan import Plan
from phantoms.knee.poses import Pose
from phantoms.knee.sites import in_bone
from phantoms.knee.sizes import Sizes
from phantoms.knee.wrong import applied
from phantoms.parts import sided, sided_point

SUMMARY: Final = (
    "A knee of a person: femur with condyles, trochlea and notch, tibia with its plateau and"
    " spines, fibula and patella, each a cortical shell around spongiosa and marrow, with"
    " cartilage, tendons, fat pads, muscle, fat and skin."
)


def build(parameters: Parameters, abnormalities: Sequence[Wrong] = ()) -> Document:
    """Return the knee, the middle of its joint space at the origin.

    Raises
    ------
    InvalidInputError
        With every abnormality that does not fit, under ``/abnormalities``.
    """
    full = resolved(parameters)
    sizes = sizes_of(full)
    at = placed(sizes)
    plan = Plan(sizes, at, Pose((0.0, 0.0, at.plateau_z)))
    points = _landmarks(plan)
    plan = applied(plan, abnormalities)
    return Document(
        format="phantom/1",
        name="knee",
        title="Knee",
        description=SUMMARY,
        materials={**_materials(sizes), **plan.materials},
        definitions=condyles.definitions(sizes),
        solid=sided(plan.solid(), full.side),
        landmarks={name: sided_point(point, full.side) for name, point in points.items()},
        anatomy=Anatomy(region="knee", laterality=full.side),
        sources=SOURCES,
        parameters=full.model_dump(mode="json"),
        findings=tuple(_on(finding, full) for finding in plan.findings),
    )


def _on(finding: Finding, full: Parameters) -> Finding:
    """Return a finding of a right knee, on the side that the knee is of."""
    center = finding.center
    moved = None if center is None else sided_point(center, full.side)
    return finding.model_copy(update={"center": moved})


def _materials(sizes: Sizes) -> dict[str, ReferenceMaterial]:
    """Return the materials of every knee, in their order."""
    return {
        "skin": ReferenceMaterial(reference="skin_icru44"),
        "fat": ReferenceMaterial(reference="adipose_icru44"),
        "muscle": ReferenceMaterial(reference="muscle_icru44"),
        "tendon": ReferenceMaterial(reference="muscle_icru44", density_g_cm3=1.12),
        "cartilage": ReferenceMaterial(reference="cartilage_icru44"),
        "cortical bone": ReferenceMaterial(
            reference="cortical_bone_icru44", density_g_cm3=round(sizes.cortical_density, 4)
        ),
        "spongiosa": ReferenceMaterial(
            reference="spongiosa_icru44", density_g_cm3=round(sizes.spongiosa_density, 4)
        ),
        "marrow": ReferenceMaterial(reference="yellow_marrow_icru44"),
        trabeculae.MATERIAL: ReferenceMaterial(
            reference="cortical_bone_icru44",
            density_g_cm3=round(trabeculae.OVER_SPONGIOSA * sizes.spongiosa_density, 4),
        ),
    }


def _landmarks(plan: Plan) -> dict[str, Point]:
    """Return named points of a right knee; presets aim at the isocentre, in the joint's middle."""
    x, y, z = plan.at.ridge
    spines = plan.shin.point((0.4, 14.0, 4.0))
    return {
        "isocentre": (0.0, 5.0, 4.0),
        "patella": (x, y - plan.sizes.patella_thickness / 2.0, z),
        "medial_condyle": in_bone(plan, "medial_femoral_condyle").middle,
        "lateral_condyle": in_bone(plan, "lateral_femoral_condyle").middle,
        "tibial_spines": spines,
    }
