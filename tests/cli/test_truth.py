"""``phantom radiograph --truth --truth-output``: a folder or an archive beside the picture."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest

BALLS = {
    "format": "phantom/1",
    "name": "balls",
    "materials": {"m": {"attenuation_per_mm": 0.02}},
    "solid": {
        "type": "union",
        "solids": [
            {"type": "sphere", "name": n, "center": [x, 0, 0], "radius": 6, "material": "m"}
            for n, x in (("left", 9), ("right", -9))
        ],
    },
}


def test_an_archive_and_a_folder_have_the_same_files(run, written, tmp_path):
    words = ("radiograph", written(BALLS), "--columns", "24", "-o", str(tmp_path / "a.png"))
    kinds = ("--truth", "masks,thickness")
    assert run(*words, *kinds, "--truth-output", str(tmp_path / "truth.zip")).exit_code == 0
    assert run(*words, *kinds, "--truth-output", str(tmp_path / "truth")).exit_code == 0
    with zipfile.ZipFile(tmp_path / "truth.zip") as whole:
        files = {name: whole.read(name) for name in whole.namelist()}
    maps = [f"{kind}/{n}" for n in ("000", "001") for kind in ("masks", "thickness")]
    ends = {"masks": ".png", "thickness": ".npy"}
    assert list(files) == ["truth.json", "coco.json", *(m + ends[m.split("/")[0]] for m in maps)]
    folder = tmp_path / "truth"
    found = {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*.*")}
    assert found == files
    assert json.loads(files["coco.json"])["images"][0]["file_name"] == "a.png"
    # In an AP picture the patient's left is on the right.
    left, right = (np.load(io.BytesIO(files[f"thickness/{n}.npy"])) for n in ("000", "001"))
    assert np.nonzero(left)[1].min() > np.nonzero(right)[1].max()


def test_every_kind_is_written_where_none_is_named(run, written, tmp_path):
    result = run(
        "radiograph", written(BALLS), "--columns", "8", "-o", str(tmp_path / "a.png"),
        "--truth-output", str(tmp_path / "truth.zip"),
    )  # fmt: skip
    assert result.exit_code == 0
    with zipfile.ZipFile(tmp_path / "truth.zip") as whole:
        told = json.loads(whole.read("truth.json"))
    kinds = ["masks", "thickness", "boxes", "entry_depth", "centroids", "landmarks"]
    assert told["kinds"] == kinds


def test_an_archive_beside_the_picture_where_no_place_is_named(run, written, tmp_path):
    picture = tmp_path / "knee.f32.tif"
    words = ("--columns", "8", "-o", str(picture), "--truth", "all")
    assert run("radiograph", written(BALLS), *words).exit_code == 0
    with zipfile.ZipFile(tmp_path / "knee.f32-truth.zip") as whole:
        assert len(json.loads(whole.read("truth.json"))["kinds"]) == 6


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        (("--truth", "masks,labels"), "unknown_value"),
        (("--truth-output", "nowhere/at/all.zip"), "missing_folder"),
        (("--truth-output", "{tmp}/document.json"), "is_a_file"),
        (("--truth-output", "{tmp}/t.zip", "--truth", ""), "missing"),
    ],
)
def test_a_place_that_cannot_be_is_refused_before_anything_is_written(
    run, written, tmp_path, words, kind
):
    words = [word.replace("{tmp}", str(tmp_path)) for word in words]
    picture = tmp_path / "a.png"
    result = run("radiograph", written(BALLS), "-o", str(picture), *words, "--json")
    assert result.exit_code == 2
    assert [p["kind"] for p in json.loads(result.stderr)["problems"]] == [kind]
    assert not picture.exists()
