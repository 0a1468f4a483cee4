"""A pair's files, read by programs of other houses."""

from __future__ import annotations

import io
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pydicom
import pytest
import tifffile
from PIL import Image

import phantom
from phantom.encode import LAYOUTS, encode_pair
from phantom.encode.stereo import pair_sidecar
from phantom.errors import InvalidInputError
from phantom.imaging import Acquisition, Presentation, StereoPair, stereo_pair
from tests.encode.test_dicom import NEWER_THAN_THE_PROGRAM

STEREOMETRIC = "1.2.840.10008.5.1.4.1.1.77.1.5.3"
COLUMNS, ROWS = 64, 48


@pytest.fixture(scope="module")
def made():
    """Pairs of the knee, by what was asked."""
    knee = phantom.library.build("knee-1993")
    view = phantom.preset_view(knee, "ap", columns=COLUMNS, rows=ROWS)
    known: dict[str, StereoPair] = {}

    def pair(**fields: Any) -> StereoPair:
        chosen = {"baseline_mm": 120.0, **fields}
        if chosen.get("method") == "rotate":
            del chosen["baseline_mm"]
        return known.setdefault(
            str(chosen), stereo_pair(knee, view, acquisition=Acquisition(), **chosen)
        )

    return pair


def image(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(data)))


def test_two_files_are_the_two_images(made) -> None:
    pair = made()
    files = encode_pair(pair, layout="files")
    levels = pair.presented()
    assert list(files) == ["left.png", "right.png"]
    for eye in ("left", "right"):
        np.testing.assert_array_equal(image(files[f"{eye}.png"].data), levels[eye])
    assert not np.array_equal(levels["left"], levels["right"])


@pytest.mark.parametrize(
    ("layout", "first", "second"),
    [("side_by_side", "left", "right"), ("cross_eyed", "right", "left")],
)
def test_side_by_side_has_the_left_image_left_and_cross_eyed_right(
    made, layout, first, second
) -> None:
    pair = made()
    for bits in (8, 16):
        asked = Presentation(bits=bits)
        ((name, file),) = encode_pair(pair, "signal", asked, layout=layout).items()
        assert name == f"{layout.replace('_', '-')}.png"
        found = image(file.data)
        assert found.shape == (ROWS, 2 * COLUMNS)
        levels = pair.presented("signal", asked)
        np.testing.assert_array_equal(found[:, :COLUMNS], levels[first])
        np.testing.assert_array_equal(found[:, COLUMNS:], levels[second])


@pytest.mark.parametrize("bits", [8, 16])
def test_the_channels_of_an_anaglyph_are_the_two_images(made, read_png, bits) -> None:
    pair = made()
    asked = Presentation(bits=bits)
    levels = pair.presented("line_integral", asked)
    png = encode_pair(pair, "line_integral", asked, layout="anaglyph")["anaglyph.png"].data
    tiff = encode_pair(pair, "line_integral", asked, "tiff", layout="anaglyph")["anaglyph.tif"].data
    for colours in (tifffile.imread(io.BytesIO(tiff)), read_png(png).pixels):
        assert colours.shape == (ROWS, COLUMNS, 3)
        np.testing.assert_array_equal(colours[..., 0], levels["left"])
        np.testing.assert_array_equal(colours[..., 1], levels["right"])
        np.testing.assert_array_equal(colours[..., 2], levels["right"])


def test_a_jpeg_anaglyph_keeps_the_eyes_apart(made) -> None:
    pair = made()
    data = encode_pair(pair, format="jpeg", layout="anaglyph")["anaglyph.jpg"].data
    assert Image.open(io.BytesIO(data)).mode == "RGB"
    found, levels = image(data).astype(int), pair.presented()
    for channel, eye in enumerate(("left", "right", "right")):
        assert np.abs(found[..., channel] - levels[eye]).mean() < 4


def test_the_two_view_exr_reads_back_with_views_named_left_and_right(made, tmp_path) -> None:
    pair = made()
    data = encode_pair(pair, format="exr")["pair.exr"].data
    path = tmp_path / "pair.exr"
    path.write_bytes(data)
    file = OpenEXR.File(str(path), separate_channels=True)
    assert [part.header["view"] for part in file.parts] == ["left", "right"]
    assert [part.header["name"] for part in file.parts] == ["left", "right"]
    for part, picture in zip(file.parts, (pair.left, pair.right), strict=True):
        for name in ("signal", "transmission", "line_integral"):
            expected = picture.quantity(name).astype(np.float32)
            np.testing.assert_array_equal(part.channels[name].pixels, expected)
        thickness = picture.path_lengths[..., 0].astype(np.float32)
        np.testing.assert_array_equal(part.channels["thickness.bone"].pixels, thickness)
    told = json.loads(file.parts[0].header["phantom:metadata"])
    assert told["stereo"]["baseline_mm"] == 120
    assert encode_pair(pair, format="exr")["pair.exr"].data == data, "no time is in it"


def judged(folder: Path, program: str, *names: str) -> list[str]:
    found = shutil.which(program)
    assert found, "Debian's package dicom3tools is needed for this test"
    done = subprocess.run([found, *names], cwd=folder, capture_output=True, text=True, check=False)
    return (done.stdout + done.stderr).splitlines()


@pytest.mark.parametrize("blind", [False, True])
@pytest.mark.parametrize("form", ["dicom", "dicom-processing"])
@pytest.mark.parametrize("asked", [{}, {"method": "rotate"}, {"mono": "same_image"}])
def test_dciodvfy_and_dcentvfy_find_no_error_in_a_pair(made, tmp_path, asked, form, blind) -> None:
    files = encode_pair(made(**asked), format=form, layout="files", blind=blind)
    assert len(files) == 3
    for name, file in files.items():
        (tmp_path / name).write_bytes(file.data)
    for name in files:
        lines = judged(tmp_path, "dciodvfy", name)
        known = "StereometricRelationship" if name.startswith("stereo") else "DXImageFor"
        assert any(line.startswith(known) for line in lines), lines
        errors = [line.rstrip(" ?") for line in lines if line.startswith("Error")]
        assert errors == [NEWER_THAN_THE_PROGRAM]
    assert judged(tmp_path, "dcentvfy", *files) == []


def test_dcentvfy_does_find_errors(made, tmp_path) -> None:
    """What is true of a sound set alone would prove nothing."""
    files = encode_pair(made(), format="dicom", layout="files")
    for name, file in files.items():
        (tmp_path / name).write_bytes(file.data)
    other = pydicom.dcmread(tmp_path / "stereo.dcm")
    other.PatientID = "PHX-000000000000"
    other.save_as(tmp_path / "stereo.dcm")
    assert judged(tmp_path, "dcentvfy", *files)


def test_the_relationship_says_which_image_is_which_eyes(made) -> None:
    files = encode_pair(made(), format="dicom", layout="files")
    left, right, stereo = (pydicom.dcmread(io.BytesIO(file.data)) for file in files.values())
    assert list(files) == ["left.dcm", "right.dcm", "stereo.dcm"]
    assert stereo.SOPClassUID == stereo.file_meta.MediaStorageSOPClassUID == STEREOMETRIC
    (pair,) = stereo.StereoPairsSequence
    for image_of, sequence in ((left, pair.LeftImageSequence), (right, pair.RightImageSequence)):
        assert sequence[0].ReferencedSOPInstanceUID == image_of.SOPInstanceUID
        assert sequence[0].ReferencedSOPClassUID == image_of.SOPClassUID
    assert pair.StereoBaselineDisplacement == 120
    assert left.SOPInstanceUID != right.SOPInstanceUID
    assert {d.StudyInstanceUID for d in (left, right, stereo)} == {left.StudyInstanceUID}
    assert {d.PatientID for d in (left, right, stereo)} == {left.PatientID}
    assert stereo.SyntheticData == "YES"
    assert "NOT FOR DIAGNOSTIC USE" in stereo.PatientComments
    again = encode_pair(made(), format="dicom", layout="files")
    assert [f.data for f in again.values()] == [f.data for f in files.values()]


def test_both_images_have_the_view_between_the_eyes(made) -> None:
    """Neither eye of an AP pair is an oblique view; the angles are those of each tube."""
    files = encode_pair(made(), format="dicom", layout="files")
    left, right = (
        pydicom.dcmread(io.BytesIO(files[f"{eye}.dcm"].data)) for eye in ("left", "right")
    )
    assert left.ViewPosition == right.ViewPosition == "AP"
    assert float(left.PositionerPrimaryAngle) == pytest.approx(-float(right.PositionerPrimaryAngle))
    assert abs(float(left.PositionerPrimaryAngle)) < 179


def test_a_blind_pair_says_nothing_of_itself(made) -> None:
    files = encode_pair(made(), layout="all", blind=True)
    text = b"".join(file.data for file in files.values()) + pair_sidecar(made(), files, blind=True)
    for word in (b"knee", b"baseline_mm", b"disparit", b"femur", b"StereoBaseline"):
        assert word not in text
    stereo = pydicom.dcmread(io.BytesIO(files["stereo.dcm"].data))
    assert "StereoBaselineDisplacement" not in stereo.StereoPairsSequence[0]


def test_all_of_it(made) -> None:
    files = encode_pair(made(), layout="all")
    assert list(files) == [
        "left.png", "right.png", "side-by-side.png", "cross-eyed.png", "anaglyph.png", "pair.exr",
        "left.dcm", "right.dcm", "stereo.dcm",
    ]  # fmt: skip
    told = json.loads(pair_sidecar(made(), files, blind=False))
    assert set(told["files"]) == set(files)
    assert told["stereo"]["comfort"]["level"] == "comfortable"
    single = encode_pair(made(mono="single"), layout="all")
    assert list(single) == ["mono.png", "mono.exr", "mono.dcm"]


def test_every_file_tells_of_the_pair(made) -> None:
    for layout in LAYOUTS:
        form = "exr" if layout == "two_view" else "png"
        for name, file in encode_pair(made(), format=form, layout=layout).items():
            if not name.startswith("stereo."):
                assert dict(file.beside)["stereo"]["baseline_mm"] == 120, name
    both = json.loads(encode_pair(made(), format="json")["pair.json"].data)
    assert both["disparities"][0]["name"] == "femur"


@pytest.mark.parametrize(
    ("format", "layout", "asked", "path"),
    [
        ("npy", "anaglyph", {}, "/stereo/layout"),
        ("dicom", "side_by_side", {}, "/stereo/layout"),
        ("png", "two_view", {}, "/stereo/layout"),
        ("exr", "cross_eyed", {}, "/stereo/layout"),
        ("png", "anaglyph", {"mono": "single"}, "/stereo/layout"),
        ("exr", "two_view", {"mono": "single"}, "/stereo/layout"),
    ],
)
def test_a_layout_that_a_format_does_not_have_is_refused(made, format, layout, asked, path) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        encode_pair(made(**asked), format=format, layout=layout)
    assert [p.path for p in refusal.value.problems] == [path]


def test_path_lengths_are_no_picture(made) -> None:
    for layout in ("files", "anaglyph", "all"):
        with pytest.raises(InvalidInputError) as refusal:
            encode_pair(made(), "path_lengths", layout=layout)
        assert [p.path for p in refusal.value.problems] == ["/quantity"]
    found = encode_pair(made(), "path_lengths", format="npy")
    assert np.load(io.BytesIO(found["left.npy"].data)).shape == (ROWS, COLUMNS, 1)
