"""What can be wrong with a knee.

Sources: joint space by Kellgren and Lawrence's grade, Ratzlaff et al. 2018 (a loss of 0.25 mm at
grade 2 and 1.6 mm at 3); effusion, a suprapatellar strip over 5 mm, over 10 mm pathological. The
rest are estimates: loss at grades 1 and 4, osteophytes of 1 to 6 mm, sclerosis of 1 to 3 mm, gaps
and steps of fractures. A lytic lesion is seen from 3 to 16 % (measured) or 30 to 50 % (the classic
figure) of the mineral lost, so that its change starts at 1 %.
"""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field

from phantom.document import Point, told
from phantom.document.base import Number
from phantom.library import Abnormality

LesionSite = Literal[
    "medial_femoral_condyle",
    "lateral_femoral_condyle",
    "distal_femur",
    "medial_tibial_plateau",
    "lateral_tibial_plateau",
    "proximal_tibia",
    "patella",
]
FractureSite = Literal["lateral_tibial_plateau", "tibial_shaft", "femoral_shaft", "patella"]
LooseSite = Literal["suprapatellar_pouch", "posterior_recess", "medial_gutter", "lateral_gutter"]
ForeignSite = Literal["front_of_the_patella", "medial_side", "lateral_side", "back_of_the_knee"]

_OFFSET = told("Offset", "mm", "From the middle of the site, along x, y and z of a right knee.")


def _size(title: str, meaning: str, low: float, high: float) -> object:
    return told(title, "mm", meaning, ge=low, le=high)


class _Lesion(Abnormality):
    site: Annotated[LesionSite, told("Site", "none", "Where in the spongy bone.")] = (
        "medial_tibial_plateau"
    )
    diameter_mm: Annotated[Number, _size("Diameter", "Of a sphere.", 2.0, 30.0)] = 14.0
    offset_mm: Annotated[Point, _OFFSET] = (0.0, 0.0, 0.0)


class LyticLesion(_Lesion):
    """A sphere of spongy bone that has lost mineral."""

    type: Literal["lytic_lesion"] = "lytic_lesion"
    mineral_change: Annotated[
        Number,
        Field(ge=0.01, le=1.0),
        told("Mineral change", "1", "Share of the mineral that is lost; 1 leaves the marrow."),
    ] = 0.7


class BlasticLesion(_Lesion):
    """A sphere of spongy bone that has gained mineral."""

    type: Literal["blastic_lesion"] = "blastic_lesion"
    mineral_change: Annotated[
        Number,
        Field(ge=0.01, le=1.5),
        told("Mineral change", "1", "Gain of mineral as a share of what was there."),
    ] = 0.8


class Osteoarthritis(Abnormality):
    """Loss of joint space, osteophytes and sclerosis, by grade or each by hand."""

    type: Literal["osteoarthritis"] = "osteoarthritis"
    grade: Annotated[
        Literal[1, 2, 3, 4], told("Grade", "none", "Of Kellgren and Lawrence, 1 to 4.")
    ] = 3
    compartment: Annotated[
        Literal["medial", "lateral"],
        told("Compartment", "none", "The side that has lost its cartilage."),
    ] = "medial"
    joint_space_loss_mm: Annotated[
        Number | None,
        _size("Joint-space loss", "In that compartment; null for the grade's.", 0.0, 8.0),
    ] = None
    osteophyte_mm: Annotated[
        Number | None,
        _size("Osteophytes", "How far they stand out; null for the grade's.", 0.0, 6.0),
    ] = None
    sclerosis_mm: Annotated[
        Number | None,
        _size("Sclerosis", "Thickness under the plateau; null for the grade's.", 0.0, 4.0),
    ] = None

    @property
    def loss_mm(self) -> float:
        """Joint space lost, by hand or by grade."""
        return (
            _BY_GRADE[self.grade][0]
            if self.joint_space_loss_mm is None
            else (self.joint_space_loss_mm)
        )

    @property
    def spur_mm(self) -> float:
        """How far osteophytes stand out."""
        return _BY_GRADE[self.grade][1] if self.osteophyte_mm is None else self.osteophyte_mm

    @property
    def dense_mm(self) -> float:
        """Thickness of the sclerosis."""
        return _BY_GRADE[self.grade][2] if self.sclerosis_mm is None else self.sclerosis_mm


_BY_GRADE: Final = {
    1: (0.1, 1.2, 0.0),
    2: (0.25, 2.5, 0.0),
    3: (1.6, 3.5, 1.6),
    4: (2.8, 5.0, 2.6),
}
"""Joint space lost, osteophytes and sclerosis, in mm."""


class Fracture(Abnormality):
    """A bone broken along a plane; one piece has moved."""

    type: Literal["fracture"] = "fracture"
    site: Annotated[FractureSite, told("Site", "none", "Which bone, where.")] = (
        "lateral_tibial_plateau"
    )
    gap_mm: Annotated[Number, _size("Gap", "Between the pieces.", 0.2, 3.0)] = 1.5
    step_mm: Annotated[Number, _size("Step", "Of one piece along the plane.", 0.0, 5.0)] = 2.0
    tilt_deg: Annotated[
        Number,
        told("Tilt", "degrees", "Of the plane from the site's usual one.", ge=-25.0, le=25.0),
    ] = 0.0


class Effusion(Abnormality):
    """Fluid in the pouch above the patella, behind the tendon."""

    type: Literal["effusion"] = "effusion"
    depth_mm: Annotated[Number, _size("Depth", "From front to back.", 2.0, 18.0)] = 12.0


class LooseBody(Abnormality):
    """A ball of bone adrift in the joint."""

    type: Literal["loose_body"] = "loose_body"
    site: Annotated[LooseSite, told("Site", "none", "Where in the joint.")] = "suprapatellar_pouch"
    diameter_mm: Annotated[Number, _size("Diameter", "Of a sphere.", 1.0, 14.0)] = 7.0
    offset_mm: Annotated[Point, _OFFSET] = (0.0, 0.0, 0.0)


class ForeignBody(Abnormality):
    """A splinter under the skin, its length along the limb."""

    type: Literal["foreign_body"] = "foreign_body"
    site: Annotated[ForeignSite, told("Site", "none", "Where under the skin.")] = "medial_side"
    material: Annotated[Literal["glass", "steel"], told("Material", "none", "Of what.")] = "glass"
    thickness_mm: Annotated[Number, _size("Thickness", "Across.", 0.3, 5.0)] = 2.0
    length_mm: Annotated[Number, _size("Length", "Along the limb.", 1.0, 25.0)] = 8.0


Wrong = Osteoarthritis | Fracture | LyticLesion | BlasticLesion | Effusion | LooseBody | ForeignBody

ABNORMALITIES: Final[dict[str, type[Abnormality]]] = {
    "osteoarthritis": Osteoarthritis,
    "fracture": Fracture,
    "lytic_lesion": LyticLesion,
    "blastic_lesion": BlasticLesion,
    "effusion": Effusion,
    "loose_body": LooseBody,
    "foreign_body": ForeignBody,
}
