"""Pairs on the command line: where the files go, and what is said."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pydicom
import pytest
from PIL import Image

SMALL = ("knee-1993", "--columns", "48")


def image(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path))


def test_a_picture_has_both_eyes_side_by_side(run, tmp_path: Path) -> None:
    done = run("stereo", *SMALL, "-o", str(tmp_path / "knee.png"), "--baseline-mm", "200")
    assert done.exit_code == 0, done.stderr
    assert "eyes 200.0 mm" in done.stderr
    assert "comfortable" in done.stderr
    whole = image(tmp_path / "knee.png")
    assert whole.shape == (48, 96)
    run(
        "stereo", *SMALL, "-o", str(tmp_path / "k.png"), "--baseline-mm", "200", "--layout", "files"
    )
    left, right = (image(tmp_path / f"k-{eye}.png") for eye in ("left", "right"))
    np.testing.assert_array_equal(whole, np.concatenate([left, right], axis=1))
    assert not (tmp_path / "k.png").exists()


def test_files_have_the_eyes_names_before_their_ending(run, tmp_path: Path) -> None:
    run("stereo", *SMALL, "-o", str(tmp_path / "k.raw.dcm"), "--sidecar", "--truth", "boxes")
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "k-left.raw.dcm",
        "k-right.raw.dcm",
        "k-stereo.raw.dcm",
        "k-truth.zip",
        "k.json",
    ]
    told = json.loads((tmp_path / "k.json").read_text())
    assert set(told["files"]) == {"left.raw.dcm", "right.raw.dcm", "stereo.raw.dcm"}
    assert pydicom.dcmread(tmp_path / "k-stereo.raw.dcm").Modality == "SMR"
    with zipfile.ZipFile(tmp_path / "k-truth.zip") as truth:
        assert truth.namelist() == ["left/truth.json", "right/truth.json"]


def test_an_archive_has_everything(run, tmp_path: Path) -> None:
    run("stereo", *SMALL, "-o", str(tmp_path / "k.zip"), "--truth", "masks")
    with zipfile.ZipFile(tmp_path / "k.zip") as whole:
        names = whole.namelist()
        anaglyph = np.asarray(Image.open(io.BytesIO(whole.read("anaglyph.png"))))
    assert {"left.png", "anaglyph.png", "pair.exr", "stereo.dcm", "pair.json"} <= set(names)
    assert {"left/truth.json", "right/masks/000.png"} <= set(names)
    assert anaglyph.shape == (48, 48, 3)
    assert [p.name for p in tmp_path.iterdir()] == ["k.zip"]


def test_ground_truth_goes_where_it_is_sent(run, tmp_path: Path) -> None:
    run("stereo", *SMALL, "-o", str(tmp_path / "k.png"), "--truth-output", str(tmp_path / "labels"))
    assert (tmp_path / "labels" / "right" / "truth.json").is_file()
    refused = run(
        "stereo", *SMALL, "-o", str(tmp_path / "k.png"), "--truth-output", str(tmp_path / "a.exr")
    )
    assert refused.exit_code == 2
    assert "/truth" in refused.stderr


def test_the_chosen_values_given_again_give_the_same_pair(run, tmp_path: Path) -> None:
    ball = ("sphere", "--columns", "48")
    first = run("stereo", *ball, "-o", str(tmp_path / "a.png"))
    line = next(line for line in first.stderr.splitlines() if line.startswith("chosen: "))
    words = dict(part.split("=", 1) for part in line.removeprefix("chosen: ").split())
    assert words["baseline_mm"] == "65"
    options = [part for k, v in words.items() for part in (f"--{k.replace('_', '-')}", v)]
    again = run("stereo", *ball, "-o", str(tmp_path / "b.png"), *options)
    assert again.exit_code == 0, again.stderr
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_json_answers_with_what_is_known_of_the_pair(run, tmp_path: Path) -> None:
    done = run("stereo", *SMALL, "-o", str(tmp_path / "a.png"), "--mono", "same_image", "--json")
    told = json.loads(done.stdout)
    assert told["stereo"]["comfort"]["level"] == "flat"
    assert told["output"] == [str(tmp_path / "a.png")]


@pytest.mark.parametrize(
    ("words", "path"),
    [
        (("--layout", "all"), "/stereo/layout"),
        (("--layout", "two_view"), "/stereo/layout"),
        (("--layout", "anaglyph", "--mono", "single"), "/stereo/layout"),
        (("--format", "dicom"), "/stereo/format"),
        (("--quantity", "path_lengths"), "/quantity"),
        (("--angle-deg", "3"), "/view/angle_deg"),
        (("--truth-output", "x.zip", "--truth", "[]"), "/truth"),
    ],
)
def test_what_a_png_cannot_be_is_told_before_anything_is_traced(
    run, tmp_path: Path, words, path
) -> None:
    done = run("stereo", *SMALL, "-o", str(tmp_path / "k.png"), *words)
    assert done.exit_code == 2
    assert done.stderr.startswith(path)
    assert not list(tmp_path.iterdir())


def test_two_eyes_see_a_phantom_in_visible_light(run, tmp_path: Path) -> None:
    done = run("render-pair", *SMALL, "-o", str(tmp_path / "k.png"), "--layout", "anaglyph")
    assert done.exit_code == 0, done.stderr
    assert "eyes 65.0 mm" in done.stderr
    assert image(tmp_path / "k.png").shape == (48, 48, 3)
    run("render-pair", *SMALL, "-o", str(tmp_path / "k.zip"), "--sidecar", "--view", "left")
    told = json.loads((tmp_path / "k.json").read_text())
    assert told["camera"]["columns"] == 48
    assert "dose" not in told["stereo"]
    line = next(line for line in done.stderr.splitlines() if line.startswith("chosen: "))
    words = dict(part.split("=", 1) for part in line.removeprefix("chosen: ").split())
    flags = {"parallel", "shadows"}
    options = [part for k, v in words.items() if k not in flags
               for part in (f"--{k.replace('_', '-')}", v)]  # fmt: skip
    again = run(
        "render-pair", *SMALL, "-o", str(tmp_path / "b.png"), "--layout", "anaglyph", *options
    )
    assert again.exit_code == 0, again.stderr
    assert (tmp_path / "k.png").read_bytes() == (tmp_path / "b.png").read_bytes()
