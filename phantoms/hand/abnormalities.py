"""What can be wrong with the hand, as a person asks for it."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from phantom.document import told
from phantom.document.base import Number
from phantom.library import Abnormality

CARTILAGE, DENSE, GLASS, STEEL = "cartilage", "dense bone", "glass", "steel"

Bone = Literal[
    "thumb metacarpal",
    "thumb proximal phalanx",
    "thumb distal phalanx",
    "index metacarpal",
    "index proximal phalanx",
    "index middle phalanx",
    "index distal phalanx",
    "middle metacarpal",
    "middle proximal phalanx",
    "middle middle phalanx",
    "middle distal phalanx",
    "ring metacarpal",
    "ring proximal phalanx",
    "ring middle phalanx",
    "ring distal phalanx",
    "little metacarpal",
    "little proximal phalanx",
    "little middle phalanx",
    "little distal phalanx",
]
Joint = Literal[
    "thumb metacarpophalangeal",
    "thumb interphalangeal",
    "index metacarpophalangeal",
    "index proximal interphalangeal",
    "index distal interphalangeal",
    "middle metacarpophalangeal",
    "middle proximal interphalangeal",
    "middle distal interphalangeal",
    "ring metacarpophalangeal",
    "ring proximal interphalangeal",
    "ring distal interphalangeal",
    "little metacarpophalangeal",
    "little proximal interphalangeal",
    "little distal interphalangeal",
]
_At = Annotated[
    Number,
    told("Place", "1", "Share of the bone's length, from its base.", ge=0.1, le=0.9),
]


class Fracture(Abnormality):
    """A break through a tubular bone; the outer part and all beyond it step aside."""

    type: Literal["fracture"] = "fracture"
    bone: Annotated[Bone, told("Bone", "none", "Which one.")] = "little metacarpal"
    at: _At = 0.72
    angle_deg: Annotated[
        Number,
        told("Angle", "degree", "Between the plane and a section of the bone.", ge=-60.0, le=60.0),
    ] = 25.0
    gap_mm: Annotated[Number, told("Gap", "mm", "Across the plane.", ge=0.2, le=3.0)] = 0.8
    step_mm: Annotated[
        Number, told("Step", "mm", "Of the outer part, toward the thumb.", ge=-3.0, le=3.0)
    ] = 1.5


class LyticLesion(Abnormality):
    """Cartilage in place of bone and marrow, as in an enchondroma."""

    type: Literal["lytic_lesion"] = "lytic_lesion"
    bone: Annotated[Bone, told("Bone", "none", "Which one.")] = "ring proximal phalanx"
    at: _At = 0.35
    width_mm: Annotated[Number, told("Width", "mm", "Across the bone.", ge=1.0, le=12.0)] = 7.0
    length_mm: Annotated[Number, told("Length", "mm", "Along the bone.", ge=1.0, le=25.0)] = 12.0


class BlasticLesion(Abnormality):
    """Dense bone in place of spongiosa and marrow."""

    type: Literal["blastic_lesion"] = "blastic_lesion"
    bone: Annotated[Bone, told("Bone", "none", "Which one.")] = "middle metacarpal"
    at: _At = 0.8
    width_mm: Annotated[Number, told("Width", "mm", "Across the bone.", ge=1.0, le=12.0)] = 4.0
    length_mm: Annotated[Number, told("Length", "mm", "Along the bone.", ge=1.0, le=25.0)] = 5.0


class Osteoarthritis(Abnormality):
    """A worn joint: less space, spurs beside it, denser bone under it.

    The grades are those of Kellgren and Lawrence; what they mean here in mm is an estimate.
    """

    type: Literal["osteoarthritis"] = "osteoarthritis"
    joint: Annotated[Joint, told("Joint", "none", "Which one.")] = "index distal interphalangeal"
    grade: Annotated[int, told("Grade", "none", "Kellgren and Lawrence.", ge=1, le=4, strict=True)]
    space: Annotated[
        Number | None,
        told("Space", "1", "Left of the joint space; null by grade.", ge=0.1, le=1.0),
    ] = None
    spur_mm: Annotated[
        Number | None, told("Spurs", "mm", "Their length; null by grade.", ge=0.3, le=3.0)
    ] = None
    sclerosis_mm: Annotated[
        Number | None,
        told("Sclerosis", "mm", "Dense bone under the joint; null by grade.", ge=0.0, le=2.0),
    ] = None


class Erosion(Abnormality):
    """A bite out of the edge of a joint, at the base of its outer bone."""

    type: Literal["erosion"] = "erosion"
    joint: Annotated[Joint, told("Joint", "none", "Which one.")] = "index metacarpophalangeal"
    edge: Annotated[Literal["radial", "ulnar"], told("Edge", "none", "Thumb's side or other.")] = (
        "radial"
    )
    diameter_mm: Annotated[Number, told("Diameter", "mm", "Of the bite.", ge=1.0, le=5.0)] = 3.0


class ForeignBody(Abnormality):
    """A splinter in the soft tissue on the palm's side of a bone."""

    type: Literal["foreign_body"] = "foreign_body"
    substance: Annotated[Literal["glass", "steel"], told("Substance", "none", "Of it.")] = "glass"
    bone: Annotated[Bone, told("Bone", "none", "Beside which.")] = "index proximal phalanx"
    at: _At = 0.5
    aside_mm: Annotated[
        Number, told("Aside", "mm", "From the bone's axis toward the thumb.", ge=-15.0, le=15.0)
    ] = 5.0
    deep_mm: Annotated[
        Number, told("Deep", "mm", "From the bone's axis toward the palm.", ge=0.0, le=18.0)
    ] = 5.5
    length_mm: Annotated[Number, told("Length", "mm", "Of the splinter.", ge=0.5, le=12.0)] = 5.0
    width_mm: Annotated[Number, told("Width", "mm", "Of the splinter.", ge=0.2, le=3.0)] = 1.6


ABNORMALITIES: Final[dict[str, type[Abnormality]]] = {
    "fracture": Fracture,
    "lytic_lesion": LyticLesion,
    "blastic_lesion": BlasticLesion,
    "osteoarthritis": Osteoarthritis,
    "erosion": Erosion,
    "foreign_body": ForeignBody,
}
