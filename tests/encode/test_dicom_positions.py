"""Presets as DICOM tells them: orientation, view and angles, as a radiographer would say them."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pydicom
import pytest

from phantom.encode import encode
from phantom.imaging import pose

AP, PA, LL, RL = "399348003", "272479007", "399173006", "399198007"
ML, LM, CC, MLO = "399260004", "399352003", "399162004", "399368009"
LAO, RAO, LPO, RPO = "399135007", "399356000", "399006002", "399038007"
"""SNOMED CT codes of PS3.16, CID 4010 and CID 4014."""


def taken(shot: Any, preset: Any, region: str, side: str | None, **angles: float) -> Any:
    """Return the header of a picture taken in this pose, 1 m from a detector at the origin."""
    turned = pose(preset, laterality=side or "right", **angles)
    view = {
        "source": (-1000 * turned.beam).tolist(),
        "direction": None,
        "detector": {
            "center": [0.0, 0.0, 0.0],
            "right": turned.right.tolist(),
            "down": turned.down.tolist(),
            "columns": 34,
            "rows": 21,
            "pitch_mm": [0.1, 0.1],
        },
    }
    picture = shot(region=region, laterality=side, view=view)
    return pydicom.dcmread(io.BytesIO(encode(picture, format="dicom").data))


@pytest.mark.parametrize(
    ("preset", "side", "orientation", "view", "position", "primary_deg"),
    [
        ("ap", None, ["L", "F"], AP, "AP", 180),
        ("pa", None, ["L", "F"], PA, "PA", 0),
        ("left_lateral", None, ["P", "F"], LL, "LL", 90),
        ("right_lateral", None, ["A", "F"], RL, "RL", -90),
        ("mediolateral", "left", ["P", "F"], ML, None, 90),
        ("mediolateral", "right", ["A", "F"], ML, None, -90),
        ("lateromedial", "left", ["A", "F"], LM, None, -90),
        ("lao", None, ["LP", "F"], LAO, None, 45),
        ("rao", None, ["LA", "F"], RAO, None, -45),
        ("lpo", None, ["LA", "F"], LPO, None, 135),
        ("rpo", None, ["LP", "F"], RPO, None, -135),
    ],
)
def test_of_the_body(shot, preset, side, orientation, view, position, primary_deg) -> None:
    found = taken(shot, preset, "knee", side)
    first, second = found.PatientOrientation
    assert (set(first), second) == (set(orientation[0]), orientation[1])
    assert found.ViewCodeSequence[0].CodeValue == view
    assert found.get("ViewPosition") == position
    assert found.ImageLaterality == {"left": "L", "right": "R", None: "U"}[side]
    assert float(found.PositionerPrimaryAngle) == pytest.approx(primary_deg, abs=1e-9)
    assert float(found.PositionerSecondaryAngle) == pytest.approx(0, abs=1e-9)
    assert found.AnatomicRegionSequence[0].CodeValue == "72696002", "knee"


@pytest.mark.parametrize(("primary", "secondary"), [(30, 20), (-120, -40), (180, 15), (0, -60)])
def test_a_c_arm_has_the_angles_that_were_set(shot, primary, secondary) -> None:
    angles = {"primary_angle_deg": primary, "secondary_angle_deg": secondary}
    found = taken(shot, "c_arm", "chest", None, **angles)
    assert float(found.PositionerPrimaryAngle) == pytest.approx(primary, abs=1e-9)
    assert float(found.PositionerSecondaryAngle) == pytest.approx(secondary, abs=1e-9)
    assert "ViewCodeSequence" not in found


@pytest.mark.parametrize(
    ("preset", "side", "orientation", "view", "angle_deg"),
    [
        ("cc", "left", ["A", "R"], CC, 0),
        ("cc", "right", ["P", "L"], CC, 0),
        ("mlo", "left", ["A", "FR"], MLO, -45),
        ("mlo", "right", ["P", "FL"], MLO, 45),
    ],
)
def test_of_the_breast(shot, preset, side, orientation, view, angle_deg) -> None:
    """The orientations that the mammography profile of IHE lists for these four views."""
    found = taken(shot, preset, "breast", side)
    assert list(found.PatientOrientation) == orientation
    assert found.ViewCodeSequence[0].CodeValue == view
    assert found.ImageLaterality == side[0].upper()
    assert float(found.PositionerPrimaryAngle) == pytest.approx(angle_deg, abs=1e-9)
    assert found.AnatomicRegionSequence[0].CodeValue == "76752008", "breast"


def test_a_breast_of_no_stated_side_is_told_from_the_picture(shot) -> None:
    stated = taken(shot, "cc", "breast", "left")
    picture = shot(region="breast", laterality=None)
    picture.view = {
        "source": [0.0, 0.0, 650.0],
        "direction": None,
        "detector": {**picture.view["detector"], "right": [0.0, -1.0, 0.0], "center": [0, 0, 0]},
    }
    picture.view["detector"]["down"] = [-1.0, 0.0, 0.0]
    found = pydicom.dcmread(io.BytesIO(encode(picture, format="dicom").data))
    assert found.ImageLaterality == stated.ImageLaterality == "L"


def test_a_stereo_pair_of_a_breast_is_two_cranio_caudal_views(shot) -> None:
    for tilt in (-3.0, 3.0):
        turned = np.radians(tilt)
        picture = shot(region="breast")
        picture.view["source"] = [650 * np.sin(turned), 0.0, 650 * np.cos(turned)]
        picture.view["detector"].update(center=[0, 0, 0], right=[0, -1, 0], down=[-1, 0, 0])
        found = pydicom.dcmread(io.BytesIO(encode(picture, format="dicom").data))
        assert found.ViewCodeSequence[0].CodeValue == CC
        assert float(found.PositionerPrimaryAngle) == pytest.approx(tilt)


def test_an_eye_of_a_pair_is_named_by_the_view_between_the_eyes(shot) -> None:
    """A tube moved forward over a breast is no longer a mammogram's by itself."""

    class Eye(shot):
        def metadata(self) -> dict[str, Any]:
            told = super().metadata()
            middle = {**self.view, "source": [0.0, 0.0, 600.0]}
            return {**told, "stereo": {"eye": "left", "view": middle}}

    for kind, modality in ((Eye, "MG"), (shot, "DX")):
        picture = kind(region="breast")
        picture.view["source"] = [0.0, -32.5, 600.0]
        picture.view["detector"].update(center=[0, 0, 0], right=[0, -1, 0], down=[-1, 0, 0])
        found = pydicom.dcmread(io.BytesIO(encode(picture, format="dicom").data))
        assert found.Modality == modality
        assert (kind is shot) or found.ViewCodeSequence[0].CodeValue == CC
