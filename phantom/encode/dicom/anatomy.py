"""Body parts and views as SNOMED CT codes, from pydicom's copy of the context groups of PS3.16."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from pydicom import Dataset


class BodyPart(NamedTuple):
    """A body part in DICOM.

    Attributes
    ----------
    concept
        Its name in CID 4009 or CID 4031 (pydicom's spelling).
    examined
        Body Part Examined (0018,0015), a term of PS3.16 annex L.
    """

    concept: str
    examined: str


BODY_PARTS: Final = {
    "abdomen": BodyPart("Abdomen", "ABDOMEN"),
    "ankle": BodyPart("AnkleJoint", "ANKLE"),
    "breast": BodyPart("Breast", "BREAST"),
    "cervical spine": BodyPart("CervicalSpine", "CSPINE"),
    "chest": BodyPart("Chest", "CHEST"),
    "elbow": BodyPart("ElbowJoint", "ELBOW"),
    "femur": BodyPart("Femur", "FEMUR"),
    "foot": BodyPart("Foot", "FOOT"),
    "hand": BodyPart("Hand", "HAND"),
    "head": BodyPart("Head", "HEAD"),
    "hip": BodyPart("Hip", "HIP"),
    "knee": BodyPart("Knee", "KNEE"),
    "lumbar": BodyPart("LumbarSpine", "LSPINE"),
    "lumbar spine": BodyPart("LumbarSpine", "LSPINE"),
    "pelvis": BodyPart("Pelvis", "PELVIS"),
    "shoulder": BodyPart("Shoulder", "SHOULDER"),
    "skull": BodyPart("Skull", "SKULL"),
    "thoracic spine": BodyPart("ThoracicSpine", "TSPINE"),
    "wrist": BodyPart("WristJoint", "WRIST"),
}
"""By ``anatomy.region`` of a document, in lower case."""

TEST_OBJECT: Final = BodyPart("Phantom", "PHANTOM")

VIEW_POSITIONS: Final = {
    "AnteroPosterior": "AP",
    "PosteroAnterior": "PA",
    "LeftLateral": "LL",
    "RightLateral": "RL",
}
"""View Position (0018,5101) of a view, where there is a word for it."""

DX_ANATOMY, DX_VIEW, MAMMOGRAPHY_VIEW = 4009, 4010, 4014


def body_part(region: str | None) -> BodyPart | None:
    """Return the body part; a test object where there is no region, None where it is unknown."""
    return TEST_OBJECT if region is None else BODY_PARTS.get(region)


def coded(group: int, concept: str) -> Dataset:
    """Return the item of a code sequence for a concept of a context group."""
    from pydicom.sr.codedict import codes

    code = getattr(getattr(codes, f"cid{group}"), concept)
    return code_item(code.value, code.scheme_designator, code.meaning)


def code_item(value: str, scheme: str, meaning: str) -> Dataset:
    """Return the item of a code sequence; Code Value and Scheme have 16 characters at most."""
    from pydicom import Dataset

    item = Dataset()
    if len(value) > 16:
        item.LongCodeValue = value
    else:
        item.CodeValue = value
    item.CodingSchemeDesignator = scheme[:16]
    item.CodeMeaning = meaning[:64]
    return item
