"""DICOM held against dciodvfy, against pydicom, and pixels against a reader of another house."""

from __future__ import annotations

import io
import itertools
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pydicom
import pytest

from phantom.encode import encode

FORMS = ("dicom", "dicom-processing")
PRESENTATION, PROCESSING = "1.2.840.10008.5.1.4.1.1.1.{}", "1.2.840.10008.5.1.4.1.1.1.{}.1"

# The dciodvfy of Debian 12 is of June 2022 and does not know Synthetic Data (0008,001C), which the
# present PS3.6 has, and PS3.3 in the SOP Common module of every object.
NEWER_THAN_THE_PROGRAM = (
    "Error - Attribute with an even group number is not a recognized standard attribute"
    " - (0x0008,0x001c)"
)

BREAST_VIEW = {
    "source": [0.0, 0.0, 600.0],
    "direction": None,
    "detector": {
        "center": [0.0, 0.0, -50.0],
        "right": [0.0, -1.0, 0.0],
        "down": [-1.0, 0.0, 0.0],
        "columns": 34,
        "rows": 21,
        "pitch_mm": [0.085, 0.085],
    },
}
TUBE = {"kvp": 28.0, "anode": "rhodium", "filtration_mm": {"rhodium": 0.025, "aluminium": 0.1}}
PARALLEL = {
    "source": None,
    "direction": [3.0, 1.0, 0.5],
    "detector": {
        "center": [90.0, 0.0, 0.0],
        "right": [0.0, 1.0, 0.0],
        "down": [0.0, 0.0, -1.0],
        "columns": 34,
        "rows": 21,
        "pitch_mm": [1 / 3, 1e-3 / 7],
    },
}
TEMPORAL = {"value": "60911003", "scheme": "SCT", "meaning": "Temporal bone"}
SUBJECTS: dict[str, dict[str, Any]] = {
    "knee": {},
    "knee of a tube": {"beam": {"kvp": 65.0, "anode": "tungsten", "filtration_mm": {}}},
    "test object in a parallel beam": {"region": None, "laterality": None, "view": PARALLEL},
    "part with a code": {"region": "left antenna", "codes": {"AnatomicRegionSequence": TEMPORAL}},
    "unknown part": {"region": "left antenna", "laterality": "upper"},
    "breast": {"region": "breast", "view": BREAST_VIEW, "beam": TUBE},
    "breast from the front": {"region": "breast"},
}


def read(data: bytes) -> pydicom.Dataset:
    return pydicom.dcmread(io.BytesIO(data))


def errors(data: bytes, folder: Path) -> list[str]:
    """Return what dciodvfy finds wrong; it has to know the object as one of the standard's."""
    path = folder / "image.dcm"
    path.write_bytes(data)
    program = shutil.which("dciodvfy")
    assert program, "Debian's package dicom3tools is needed for this test"
    done = subprocess.run([program, path], capture_output=True, text=True, check=False)
    lines = (done.stdout + done.stderr).splitlines()
    assert any(re.fullmatch(r"(DX|Mammography)ImageFor\w+", line) for line in lines), lines
    return [line.rstrip(" ?") for line in lines if line.startswith("Error")]


@pytest.mark.parametrize("subject", SUBJECTS.values(), ids=SUBJECTS.keys())
@pytest.mark.parametrize("form", FORMS)
def test_dciodvfy_finds_no_error(shot, tmp_path, form, subject) -> None:
    for quantity, blind in (("signal", False), ("line_integral", True)):
        data = encode(shot(**subject), quantity, format=form, blind=blind).data
        assert errors(data, tmp_path) == [NEWER_THAN_THE_PROGRAM]
        known = read(data)
        del known[0x0008, 0x001C]
        buffer = io.BytesIO()
        known.save_as(buffer)
        assert errors(buffer.getvalue(), tmp_path) == []


def test_dciodvfy_does_find_errors(shot, tmp_path) -> None:
    """What is true of a sound file alone would prove nothing."""
    broken = read(encode(shot(), format="dicom").data)
    del broken.WindowCenter, broken.ImagerPixelSpacing
    buffer = io.BytesIO()
    broken.save_as(buffer)
    assert len(errors(buffer.getvalue(), tmp_path)) >= 3


@pytest.mark.parametrize("quantity", ["signal", "transmission", "line_integral"])
@pytest.mark.parametrize("bits", [8, 16, -8, -16])
def test_grey_levels_come_back(shot, tmp_path, quantity, bits) -> None:
    picture = shot()
    data = encode(picture, quantity, bits, "dicom").data
    expected = picture.presented(quantity, bits)
    found = read(data)
    assert found.pixel_array.dtype == expected.dtype
    np.testing.assert_array_equal(found.pixel_array, expected)
    np.testing.assert_array_equal(by_dctopnm(data, tmp_path, expected.dtype), expected)


@pytest.mark.parametrize(
    ("quantity", "per_unit"), [("transmission", 65535), ("line_integral", 8192)]
)
def test_numbers_come_back_as_codes(shot, tmp_path, quantity, per_unit) -> None:
    picture = shot()
    data = encode(picture, quantity, format="dicom-processing").data
    found = read(data).pixel_array
    np.testing.assert_array_equal(by_dctopnm(data, tmp_path, found.dtype), found)
    assert np.abs(found / per_unit - picture.quantity(quantity)).max() <= 0.5 / per_unit


def by_dctopnm(data: bytes, folder: Path, dtype: np.dtype[Any]) -> np.ndarray:
    """Return the pixels as dicom3tools reads them."""
    (folder / "in.dcm").write_bytes(data)
    command = ["dctopnm", "-output-endian", "little", "in.dcm", "out.pgm"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    written = (folder / "out.pgm").read_bytes()
    header, pixels = written[: -21 * 34 * dtype.itemsize], written[-21 * 34 * dtype.itemsize :]
    assert header.split()[:3] == [b"P5", b"34", b"21"]
    return np.frombuffer(pixels, dtype).reshape(21, 34)


def test_an_odd_number_of_bytes_is_padded(shot) -> None:
    class Odd(shot):
        def presented(self, name: str, presentation: Any) -> Any:
            return super().presented(name, presentation)[:, :33]

        def quantity(self, name: str) -> Any:
            return super().quantity(name)[:, :33]

    found = read(encode(Odd(), format="dicom").data)
    assert len(found.PixelData) == 21 * 33 + 1
    np.testing.assert_array_equal(found.pixel_array, Odd().presented("signal", None))


@pytest.mark.parametrize(
    ("form", "subject", "uid"),
    [
        ("dicom", "knee", PRESENTATION.format(1)),
        ("dicom-processing", "knee", PROCESSING.format(1)),
        ("dicom", "breast", PRESENTATION.format(2)),
        ("dicom-processing", "breast", PROCESSING.format(2)),
        ("dicom", "breast from the front", PRESENTATION.format(1)),
    ],
)
def test_the_object_is_the_one_for_body_part_and_form(shot, form, subject, uid) -> None:
    found = read(encode(shot(**SUBJECTS[subject]), format=form).data)
    assert found.SOPClassUID == found.file_meta.MediaStorageSOPClassUID == uid
    assert found.Modality == ("MG" if subject == "breast" else "DX")
    intent = {"dicom": "FOR PRESENTATION", "dicom-processing": "FOR PROCESSING"}[form]
    assert found.PresentationIntentType == intent
    assert ("WindowCenter" in found) is (form == "dicom")


@pytest.mark.parametrize(("form", "blind"), list(itertools.product(FORMS, (True, False))))
def test_every_file_says_that_nobody_was_xrayed(shot, form, blind) -> None:
    found = read(encode(shot(), format=form, blind=blind).data)
    assert found.SyntheticData == "YES"
    assert found.QualityControlSubject == "YES"
    assert re.fullmatch(r"PHX-[0-9A-F]{12}", found.PatientID)
    assert found.PatientName.family_name == found.PatientID
    for comments in (found.PatientComments, found.ImageComments):
        assert "NOT FOR DIAGNOSTIC USE" in comments
    assert (found.PatientBirthDate, found.PatientSex, found.StudyDate) == ("", "", "")


def test_the_window_of_the_standard_leaves_every_level_what_it_is(shot) -> None:
    for bits in (8, 16):
        found = read(encode(shot(), "signal", bits, "dicom").data)
        center, width = float(found.WindowCenter), float(found.WindowWidth)
        top = 2**bits - 1
        stored = np.arange(top + 1)
        # PS3.3 C.11.2.1.2.1, equation for LINEAR.
        shown = ((stored - (center - 0.5)) / (width - 1) + 0.5) * top
        np.testing.assert_allclose(shown, stored, atol=1e-9 * top)
        assert (found.PhotometricInterpretation, found.PresentationLUTShape) == (
            "MONOCHROME2",
            "IDENTITY",
        )


@pytest.mark.parametrize(
    ("form", "quantity", "bits", "expected"),
    [
        ("dicom", "signal", 8, ("LIN", -1)),
        ("dicom", "signal", -16, ("LIN", 1)),
        ("dicom", "line_integral", 8, ("LOG", -1)),
        ("dicom", "line_integral", -8, ("LOG", 1)),
        ("dicom-processing", "signal", None, ("LIN", 1)),
        ("dicom-processing", "line_integral", None, ("LOG", -1)),
    ],
)
def test_the_sense_of_the_grey_scale_is_told(shot, form, quantity, bits, expected) -> None:
    found = read(encode(shot(), quantity, bits, form).data)
    assert (
        found.PixelIntensityRelationship,
        found.PixelIntensityRelationshipSign,
    ) == expected


def test_distances_and_pixels_are_those_of_the_view(shot) -> None:
    found = read(encode(shot(), format="dicom").data)
    assert [float(x) for x in found.ImagerPixelSpacing] == [0.3, 0.2], "rows first: down, across"
    assert float(found.DistanceSourceToDetector) == 1150
    assert float(found.DistanceSourceToPatient) == pytest.approx(1150 / 1.15, rel=1e-12)
    assert float(found.EstimatedRadiographicMagnificationFactor) == 1.15
    odd = read(encode(shot(view=PARALLEL), format="dicom").data)
    assert float(odd.ImagerPixelSpacing[0]) == pytest.approx(1e-3 / 7, rel=1e-9)
    assert "DistanceSourceToDetector" not in odd


def test_the_tube_is_told_where_there_is_one(shot) -> None:
    found = read(encode(shot(beam=TUBE), format="dicom").data)
    assert float(found.KVP) == 28
    assert found.AnodeTargetMaterial == "RHODIUM"
    assert list(found.FilterMaterial) == ["RHODIUM", "ALUMINUM"]
    assert [float(x) for x in found.FilterThicknessMaximum] == [0.025, 0.1]
    one_energy = read(encode(shot(), format="dicom").data)
    assert "KVP" not in one_energy


def test_identifiers_repeat_for_the_same_request_and_differ_for_another(shot) -> None:
    def named(**fields: Any) -> pydicom.Dataset:
        form, quantity = fields.pop("form", "dicom"), fields.pop("quantity", "signal")
        return read(encode(shot(**fields), quantity, format=form).data)

    once, again, other_beam = named(), named(), named(beam={"energy_kev": 70.0})
    processing, other_pixels = named(form="dicom-processing"), named(seed=6)
    assert once.SOPInstanceUID == again.SOPInstanceUID
    images = [once, other_beam, processing, other_pixels, named(quantity="line_integral")]
    assert len({image.SOPInstanceUID for image in images}) == len(images)
    assert len({image.StudyInstanceUID for image in images}) == 1, "one phantom, one study"
    assert len({image.SeriesInstanceUID for image in images}) == 3, "a series a view and form"
    for image in images:
        for uid in (image.SOPInstanceUID, image.StudyInstanceUID, image.SeriesInstanceUID):
            assert re.fullmatch(r"(0|[1-9]\d*)(\.(0|[1-9]\d*))+", uid)
            assert len(uid) <= 64


def test_all_metadata_travels_inside(shot) -> None:
    import json

    picture = shot()
    found = read(encode(picture, "line_integral", format="dicom-processing").data)
    told = json.loads(found.private_block(0x0099, "PHANTOM-XRAY")[0x01].value)
    assert told.pop("file")["codes_per_unit"] == 8192
    assert told == picture.metadata()


def test_a_code_of_the_document_stands_in_the_header(shot):
    found = read(encode(shot(**SUBJECTS["part with a code"]), format="dicom").data)
    (item,) = found.AnatomicRegionSequence
    assert (item.CodeValue, item.CodingSchemeDesignator) == ("60911003", "SCT")
    assert item.CodeMeaning == "Temporal bone"
