"""``phantom render``: the files it writes and what it says."""

from __future__ import annotations

import json

import numpy as np
import OpenImageIO

import phantom


def test_a_picture_is_what_the_library_makes(run, tmp_path):
    path = tmp_path / "knee.npy"
    result = run("render", "knee-1993", "--view", "left_lateral", "--columns", "48", "--hide",
                 "femur", "--shadows", "--samples-per-pixel", "1", "-o", str(path))  # fmt: skip
    assert result.exit_code == 0
    assert "rows=48" in result.stderr
    assert "shadows" not in result.stderr
    camera = phantom.CameraPreset(preset="left_lateral", columns=48, rows=48)
    expected = phantom.render(
        phantom.library.build("knee-1993"),
        camera,
        hide=["femur"],
        lighting=phantom.Lighting(shadows=True),
        samples_per_pixel=1,
    )
    np.testing.assert_array_equal(np.load(path), expected.rgb.astype(np.float32))


def test_the_extension_says_the_form(run, tmp_path):
    for name in ("ball.png", "ball.jpg", "ball.tif", "ball.exr"):
        path = tmp_path / name
        result = run("render", "sphere", "--columns", "24", "-o", str(path), "--sidecar", "--json")
        assert result.exit_code == 0
        told = json.loads(result.stdout)
        beside = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
        assert told == {"output": str(path), **beside}
        image = OpenImageIO.ImageBuf(str(path))
        assert (image.spec().width, image.spec().height, image.spec().nchannels) == (24, 24, 3)
    dicom = run("render", "sphere", "-o", str(tmp_path / "ball.dcm"), "--json")
    assert dicom.exit_code == 2
    assert json.loads(dicom.stderr)["problems"][0]["kind"] == "not_in_format"


def test_words_for_colours_and_lights(run, tmp_path):
    light = {"lights": [], "ambient": [0, 0, 0]}
    lighting = tmp_path / "dark.json"
    lighting.write_text(json.dumps(light), encoding="utf-8")
    for given in (str(lighting), json.dumps(light)):
        path = tmp_path / "dark.npy"
        result = run("render", "sphere", "--columns", "16", "--lighting", given, "--background",
                     "white", "-o", str(path))  # fmt: skip
        assert result.exit_code == 0
        values = np.load(path)
        assert values[0, 0].tolist() == [1, 1, 1]
        assert values[8, 8].tolist() == [0, 0, 0]
