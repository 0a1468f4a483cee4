"""Where the patient is in the picture, and where the tube stands, in DICOM's words."""

from __future__ import annotations

import math
from typing import Final

from phantom.encode.dicom.facts import Facts, Vector

LEAST_COMPONENT: Final = 0.02
"""A direction less than about 1° off a plane of the body is in it."""

SAME_ANGLE_DEG: Final = 0.5
"""Two angles this near are one pose."""

MAMMOGRAM_TILT_DEG: Final = 5.0
"""A tube this near to overhead (a stereo pair's is 3° off) still makes a cranio-caudal view."""

_LETTERS: Final = (("R", "L"), ("A", "P"), ("F", "H"))


def patient_orientation(facts: Facts) -> list[str]:
    """Return (0020,0020): where in the patient the rows and the columns run to.

    PS3.3 C.7.6.1.1.1; world axes are +x left, +y back (posterior), +z head.
    """
    return [_toward(facts.right), _toward(facts.down)]


def _toward(direction: Vector) -> str:
    # The largest first; of equal ones, head or feet.
    order = sorted((2, 1, 0), key=lambda axis: -round(abs(direction[axis]), 6))
    kept = [axis for axis in order if abs(direction[axis]) > LEAST_COMPONENT]
    return "".join(_LETTERS[axis][direction[axis] > 0] for axis in kept)


def positioner_angles_deg(facts: Facts) -> tuple[float, float]:
    """Return the primary and secondary angle of the detector (PS3.3 C.8.7.5.1.2).

    0 is before the chest; the primary angle rises toward the patient's left, up to 180, and the
    secondary toward the head.
    """
    return _body_angles_deg(facts.beam)


def _body_angles_deg(beam: Vector) -> tuple[float, float]:
    x, y, z = beam
    secondary = math.degrees(math.asin(max(-1.0, min(1.0, z))))
    if math.hypot(x, y) < 1e-9:
        return 0.0, secondary
    primary = math.degrees(math.atan2(x, -y))
    return (180.0 if primary == -180.0 else primary), secondary


def mammogram_angle_deg(facts: Facts) -> float:
    """Return the primary angle of a mammography unit: 0 overhead, rising toward the left.

    PS3.3 C.8.11.7, Positioner Primary Angle: the movement of the source from right to vertical is
    positive.
    """
    return _breast_angle_deg(facts.beam)


def _breast_angle_deg(beam: Vector) -> float:
    x, _, z = beam
    return math.degrees(math.atan2(-x, -z)) + 0.0


def mammogram_laterality(facts: Facts) -> str:
    """Return the breast that is seen: as the document says, else as the picture shows it.

    The chest wall is at the image's left for a left breast, so its rows run forward.
    """
    return facts.laterality or ("L" if facts.right[1] < 0 else "R")


def mammogram_view(facts: Facts) -> str:
    """Return the name of the view in CID 4014 (pydicom's spelling)."""
    outward = 1.0 if mammogram_laterality(facts) == "L" else -1.0
    angle = -outward * _breast_angle_deg(facts.named_beam)  # of the detector, toward the outer side
    if abs(angle) <= MAMMOGRAM_TILT_DEG:
        return "CranioCaudal"
    if abs(abs(angle) - 90) <= SAME_ANGLE_DEG:
        return "MedioLateralProjection" if angle > 0 else "LateroMedial"
    return "MedioLateralObliqueProjection" if angle > 0 else "LateroMedialOblique"


def projection_view(facts: Facts) -> str | None:
    """Return the name of the view in CID 4010 (pydicom's spelling); None for a pose without one."""
    primary, secondary = _body_angles_deg(facts.named_beam)
    if abs(secondary) > SAME_ANGLE_DEG:
        return None
    if abs(primary) <= SAME_ANGLE_DEG:
        return "PosteroAnterior"
    if 180 - abs(primary) <= SAME_ANGLE_DEG:
        return "AnteroPosterior"
    if abs(abs(primary) - 90) <= SAME_ANGLE_DEG:
        if facts.laterality is None:
            return "LeftLateral" if primary > 0 else "RightLateral"
        outer = (primary > 0) == (facts.laterality == "L")
        return "MedioLateralProjection" if outer else "LateralMedial"
    side = "Left" if primary > 0 else "Right"
    return f"{side}{'Anterior' if abs(primary) < 90 else 'Posterior'}Oblique"
