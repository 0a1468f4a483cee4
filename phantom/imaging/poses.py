"""Clinical words for where the tube and the detector stand around a patient.

Every word becomes the direction of the central ray and the picture's ``right`` and ``down``. World
axes are the patient's: +x to the left, +y to the back, +z to the head.

Around the body the words are DICOM positioner angles (PS3.3 C.8.7.5.1.2), which say where the
*detector* is: at 0° before the chest, the primary angle rising toward the patient's left, the
secondary toward the head. AP is 180°, PA 0°, left lateral 90° (detector at the patient's left, tube
at the right), LAO 45° (detector left and front), LPO 135°, and the same to the right with a minus.

The picture is what stands on the light box: the head up, and the patient's right on the image's
left in AP and PA alike. So views with the detector at the back half are seen from the tube, and the
others from the detector: a left lateral faces the image's left, a right lateral its right.
"""

from __future__ import annotations

from typing import Final, Literal, NamedTuple, get_args

import numpy as np

from phantom.geometry.vectors import sine_cosine
from phantom.imaging.view import FloatArray

Laterality = Literal["left", "right"]

PresetName = Literal[
    "ap",
    "pa",
    "left_lateral",
    "right_lateral",
    "mediolateral",
    "lateromedial",
    "cc",
    "mlo",
    "lao",
    "rao",
    "lpo",
    "rpo",
    "c_arm",
]
PRESETS: Final[tuple[str, ...]] = get_args(PresetName)
"""Every preset, in the order in which they are listed to people."""

WITH_ANGLE: Final = frozenset({"lao", "rao", "lpo", "rpo", "mlo"})
"""Presets that are turned by ``angle_deg``."""

WITH_LATERALITY: Final = frozenset({"mediolateral", "lateromedial", "cc", "mlo"})
"""Presets that mean another pose for a left limb or breast than for a right one."""

DEFAULT_ANGLE_DEG: Final = 45.0
DEFAULT_LATERALITY: Final[Laterality] = "right"


class Pose(NamedTuple):
    """Unit vectors of a view.

    Attributes
    ----------
    beam
        From the source through the isocentre to the detector.
    right, down
        Along the picture's rows and columns.
    """

    beam: FloatArray
    right: FloatArray
    down: FloatArray


def c_arm(primary_deg: float, secondary_deg: float) -> Pose:
    """Return the pose of a C-arm whose detector is at these DICOM positioner angles."""
    sin_p, cos_p = sine_cosine(primary_deg)
    sin_s, cos_s = sine_cosine(secondary_deg)
    outward = np.array([sin_p, -cos_p, 0.0])
    head = np.array([0.0, 0.0, 1.0])
    side = -1.0 if cos_p < 0 else 1.0
    return Pose(
        beam=cos_s * outward + sin_s * head,
        right=side * np.array([cos_p, sin_p, 0.0]),
        down=sin_s * outward - cos_s * head,
    )


def mammogram(angle_deg: float, laterality: Laterality) -> Pose:
    """Return the pose of a breast view whose tube is turned by this angle from overhead.

    At 0 (CC) the beam runs from head to feet, at 90 from the middle outward; MLO lies between. The
    chest wall is at the image's left for a left breast and at its right for a right one; the
    axilla, or the lateral side, is at the top.
    """
    sin_a, cos_a = sine_cosine(angle_deg)
    outward = 1.0 if laterality == "left" else -1.0
    return Pose(
        beam=np.array([sin_a * outward, 0.0, -cos_a]),
        right=np.array([0.0, -outward, 0.0]),
        down=np.array([-cos_a * outward, 0.0, -sin_a]),
    )


def pose(
    preset: PresetName,
    *,
    laterality: Laterality = DEFAULT_LATERALITY,
    angle_deg: float = DEFAULT_ANGLE_DEG,
    primary_angle_deg: float = 0.0,
    secondary_angle_deg: float = 0.0,
) -> Pose:
    """Return the pose that a clinical word names.

    ``mediolateral`` sends the beam from the middle outward, so its detector is at the side named by
    ``laterality``; ``lateromedial`` the other way round. An oblique's angle is measured from PA for
    ``lao`` and ``rao`` and from AP for ``lpo`` and ``rpo``.
    """
    if preset == "c_arm":
        return c_arm(primary_angle_deg, secondary_angle_deg)
    if preset in ("cc", "mlo"):
        return mammogram(0.0 if preset == "cc" else angle_deg, laterality)
    outer = 90.0 if laterality == "left" else -90.0
    primary_deg = {
        "ap": 180.0,
        "pa": 0.0,
        "left_lateral": 90.0,
        "right_lateral": -90.0,
        "mediolateral": outer,
        "lateromedial": -outer,
        "lao": angle_deg,
        "rao": -angle_deg,
        "lpo": 180.0 - angle_deg,
        "rpo": angle_deg - 180.0,
    }[preset]
    return c_arm(primary_deg, 0.0)
