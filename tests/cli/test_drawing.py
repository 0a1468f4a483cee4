"""``phantom preview``, ``wireframe`` and ``export``: the files they write and what they say."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
import trimesh

import phantom


def test_a_preview_is_what_the_library_makes(run, tmp_path):
    path = tmp_path / "knee.npy"
    result = run("preview", "knee-1993", "--view", "front", "--columns", "48", "--tolerance-mm",
                 "0.5", "-o", str(path))  # fmt: skip
    assert result.exit_code == 0
    assert "samples_per_pixel=1" in result.stderr
    camera = phantom.CameraPreset(preset="front", columns=48, rows=48)
    knee = phantom.library.build("knee-1993")
    expected = phantom.preview(knee, camera, tolerance_mm=0.5)
    np.testing.assert_array_equal(np.load(path), expected.rgb.astype(np.float32))


def test_a_wireframe_is_lines_or_pixels(run, tmp_path):
    drawing, pixels = tmp_path / "fan.svg", tmp_path / "fan.npy"
    for path in (drawing, pixels):
        result = run("wireframe", "fan", "--view", "front", "--columns", "64", "--rings", "5",
                     "--no-hidden-lines", "-o", str(path), "--json")  # fmt: skip
        assert result.exit_code == 0
        assert json.loads(result.stdout)["output"] == str(path)
    camera = phantom.CameraPreset(preset="front", columns=64, rows=64)
    fan = phantom.library.build("fan")
    expected = phantom.wireframe(fan, camera, rings=5, hidden_lines=False)
    assert drawing.read_bytes() == expected.svg()
    assert ElementTree.fromstring(drawing.read_bytes()).get("width") == "64"
    np.testing.assert_array_equal(np.load(pixels), expected.rgb.astype(np.float32))


def test_an_export_writes_the_file_and_its_table(run, tmp_path):
    path, table = tmp_path / "knee.glb", tmp_path / "bones.csv"
    result = run("export", "knee-1993", "-o", str(path), "--what", "result", "--table", str(table),
                 "--json")  # fmt: skip
    assert result.exit_code == 0
    told = json.loads(result.stdout)
    assert [part["name"] for part in told["parts"]] == ["bone"]
    assert trimesh.load(path).geometry["bone"].is_watertight
    assert table.read_text().splitlines()[2].startswith("1,bone,")
    volume = run("export", "knee-1993", "-o", str(tmp_path / "k.mha"), "--spacing-mm", "[4,4,6]")
    assert volume.exit_code == 0
    assert "energy_kev=60" in volume.stderr
    assert (tmp_path / "k.materials.json").exists()


@pytest.mark.parametrize(
    ("words", "path", "kind"),
    [
        (("render", "sphere", "-o", "x.svg"), "/quantity", "not_in_format"),
        (("preview", "sphere", "-o", "x.svg"), "/quantity", "not_in_format"),
        (("preview", "sphere", "--tolerance-mm", "0", "-o", "x.png"), "/tolerance_mm", None),
        (("wireframe", "sphere", "--lines", "1", "-o", "x.png"), "/lines", None),
        (("wireframe", "sphere", "--hide", "it", "-o", "x.png"), "/hide/0", "unknown_name"),
        (("export", "sphere", "-o", "x.png"), "/output", "unknown_format"),
        (("export", "sphere", "-o", "x.mha", "--what", "result"), "/what", "no_effect"),
        (("export", "sphere", "-o", "x.stl", "--spacing-mm", "1"), "/spacing_mm", "no_effect"),
        (("export", "sphere", "-o", "x.stl", "--what", "all"), "/what", None),
        (("export", "sphere", "-o", "x.mha", "--spacing-mm", "0"), "/spacing_mm", None),
        (("export", "sphere", "-o", "x.mha", "--energy-kev", "9999"), "/energy_kev", None),
    ],
)
def test_what_cannot_be_is_refused_as_everywhere(run, words, path, kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*words, "--json")
    assert result.exit_code == 2
    (problem,) = json.loads(result.stderr)["problems"]
    assert problem["path"] == path
    assert kind in (None, problem["kind"])
    assert list(tmp_path.iterdir()) == []
