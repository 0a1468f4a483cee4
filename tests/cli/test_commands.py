"""The commands, in this process."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import phantom
from phantom.requests.words import WORDS

BALL = {
    "format": "phantom/1",
    "name": "marble",
    "materials": {"glass": {"reference": "glass"}},
    "solid": {"type": "sphere", "center": [0, 0, 0], "radius": 6, "material": "glass"},
}


def test_list_names_the_library(run):
    result = run("list")
    assert result.exit_code == 0
    assert [line.split()[0] for line in result.stdout.splitlines()] == list(phantom.library.names())
    listed = json.loads(run("list", "--json").stdout)
    assert [item["name"] for item in listed] == list(phantom.library.names())


def test_show_tells_every_parameter_with_its_default(run):
    result = run("show", "step-wedge")
    assert result.exit_code == 0
    for line in ("--set steps=10", "--set step_height_mm=2.0", "--set material=aluminium"):
        assert line in result.stdout
    shown = json.loads(run("show", "step-wedge", "--json").stdout)
    assert shown["parameters"]["properties"]["steps"]["maximum"] == 50


def test_a_document_shown_is_a_document_to_work_with(run, written):
    shown = run("show", "sphere", "--document", "--set", "radius_mm=12")
    path = written(shown.stdout, "ball.json")
    summary = json.loads(run("validate", path, "--json").stdout)
    assert summary["volume_mm3"] == pytest.approx(4 / 3 * math.pi * 12**3, rel=1e-3)


def test_validate_measures_a_sound_document(run, written):
    result = run("validate", written(BALL))
    assert result.exit_code == 0
    assert "marble" in result.stdout
    assert "leaf" in result.stdout
    yaml = "format: phantom/1\nsolid: {type: sphere, center: [0, 0, 0], radius: 1, material: a}\n"
    result = run("validate", written(yaml + "materials: {a: {attenuation_per_mm: 1}}\n", "a.yaml"))
    assert result.exit_code == 0


def test_validate_lists_every_problem_and_leaves_with_2(run, written):
    broken = BALL | {"solid": BALL["solid"] | {"radius": -1, "colour": "red"}, "extra": 1}
    result = run("validate", written(broken))
    assert result.exit_code == 2
    assert [line.split(":")[0] for line in result.stderr.splitlines()] == [
        "/extra",
        "/solid/colour",
        "/solid/radius",
    ]
    as_json = run("validate", written(broken), "--json")
    assert as_json.exit_code == 2
    problems = json.loads(as_json.stderr)["problems"]
    assert [p["path"] for p in problems] == ["/extra", "/solid/colour", "/solid/radius"]
    assert as_json.stdout == ""


def test_a_radiograph_of_a_ball_has_its_chords(run, tmp_path: Path):
    out = tmp_path / "ball.npy"
    result = run(
        *("radiograph", "sphere", "--set", "radius_mm=15", "--quantity", "path_lengths"),
        *("--columns", "21", "--pitch-mm", "2", "--source-detector-mm", "900"),
        *("--object-detector-mm", "60", "-o", str(out)),
    )
    assert result.exit_code == 0
    along = (np.arange(21) - 10) * 2.0
    squared = along[None, :] ** 2 + along[:, None] ** 2
    d2 = 840**2 * squared / (squared + 900**2)
    chords = 2 * np.sqrt(np.maximum(225 - d2, 0))
    np.testing.assert_allclose(np.load(out)[..., 0], chords, atol=1e-5)


def test_a_step_wedge_seen_in_a_parallel_beam_is_a_staircase(run, tmp_path: Path):
    out = tmp_path / "wedge.npy"
    view = {
        "source": None,
        "direction": [0, 1, 0],
        "detector": {"center": [0, 200, 0], "right": [1, 0, 0], "down": [0, 0, -1]},
    }
    result = run(
        *("radiograph", "step-wedge", "--set", "steps=4", "--set", "step_height_mm=1.5"),
        *("--view", json.dumps(view), "--columns", "8", "--rows", "1", "--pitch-mm", "5"),
        *("--quantity", "path_lengths", "-o", str(out)),
    )
    assert result.exit_code == 0
    np.testing.assert_allclose(np.load(out)[0, :, 0], [1.5, 1.5, 3, 3, 4.5, 4.5, 6, 6], rtol=1e-6)


def test_every_default_is_told_in_one_line(run, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("radiograph", "sphere", "--columns", "16", "--energy-kev", "70")
    assert result.exit_code == 0
    (chosen,) = [line for line in result.stderr.splitlines() if line.startswith("chosen:")]
    words = {word.split("=")[0] for word in chosen.removeprefix("chosen: ").split(" ")}
    assert words == {
        "view", "source_detector_mm", "object_detector_mm", "rows", "pitch_mm",
        "quantity", "mode", "scope", "polarity", "bits", "output",
    }  # fmt: skip
    assert "rows=16" in chosen
    assert (tmp_path / "sphere-ap.png").read_bytes().startswith(b"\x89PNG")
    assert result.stdout == ""


def test_the_chosen_values_given_again_give_the_same_picture(run, tmp_path: Path, written):
    first, again = tmp_path / "first.png", tmp_path / "again.png"
    result = run("radiograph", written(BALL), "--columns", "16", "-o", str(first))
    (chosen,) = [line for line in result.stderr.splitlines() if line.startswith("chosen:")]
    words = dict(word.split("=") for word in chosen.removeprefix("chosen: ").split(" "))
    assert set(words) <= set(WORDS)
    options = [part for k, v in words.items() for part in (f"--{k.replace('_', '-')}", v)]
    run("radiograph", written(BALL), "--columns", "16", *options, "-o", str(again))
    assert again.read_bytes() == first.read_bytes()


def test_json_gives_the_metadata_and_a_sidecar_keeps_it(run, tmp_path: Path):
    out = tmp_path / "ball.npy"
    result = run("radiograph", "sphere", "--columns", "8", "-o", str(out), "--sidecar", "--json")
    told, kept = json.loads(result.stdout), json.loads((tmp_path / "ball.json").read_text())
    assert told.pop("output") == str(out)
    assert told == kept
    assert np.array(told["projection_matrix"]).shape == (3, 4)


@pytest.mark.parametrize(
    ("name", "start"),
    [
        ("ball.tif", b"II*\0"),
        ("ball.f32.tiff", b"II*\0"),
        ("ball.exr", b"v/1\x01"),
        ("ball.JPG", b"\xff\xd8\xff"),
        ("ball.u16.npy", b"\x93NUMPY"),
        ("ball.dcm", b"\0" * 128 + b"DICM"),
        ("ball.raw.dcm", b"\0" * 128 + b"DICM"),
        ("ball.json", b"{"),
    ],
)
def test_the_extension_says_the_format(run, tmp_path: Path, name, start):
    result = run("radiograph", "sphere", "--columns", "8", "-o", str(tmp_path / name))
    assert result.exit_code == 0
    assert (tmp_path / name).read_bytes().startswith(start)


def test_a_blind_file_and_its_sidecar_do_not_say_what_they_show(run, tmp_path: Path):
    out = tmp_path / "case-7.png"
    run("radiograph", "sphere", "--columns", "8", "-o", str(out), "--blind", "--sidecar")
    kept = out.read_bytes() + (tmp_path / "case-7.json").read_bytes()
    assert b"sphere" not in kept
    assert b"material" not in kept
    assert json.loads((tmp_path / "case-7.json").read_text())["file"]["quantity"] == "signal"


@pytest.mark.parametrize(
    ("words", "path"),
    [
        (["-o", "picture.gif"], "/output"),
        (["-o", "no/such/folder/picture.png"], "/output"),
        (["-o", "picture.png", "--quantity", "path_lengths"], "/quantity"),
        (["-o", "picture.png", "--set", "radius_mm"], "/phantom/parameters"),
        (["-o", "picture.png", "--set", "radius_mm=1", "--set", "radius_mm=2"],
         "/phantom/parameters/radius_mm"),
    ],
)  # fmt: skip
def test_nothing_is_written_for_bad_input(run, tmp_path: Path, monkeypatch, words, path):
    monkeypatch.chdir(tmp_path)
    result = run("radiograph", "sphere", "--columns", "8", *words)
    assert result.exit_code == 2
    assert path in [line.split(":")[0] for line in result.stderr.splitlines()]
    assert list(tmp_path.iterdir()) == []


def test_a_fault_of_ours_leaves_with_1(run, monkeypatch):
    def fail():
        raise RuntimeError("broken")

    monkeypatch.setattr("phantom.library.catalogue", fail)
    result = run("list")
    assert result.exit_code == 1
    assert "fault of ours" in result.stderr


@pytest.mark.parametrize(
    ("host", "alone"),
    [("127.0.0.1", True), ("localhost", True), ("::1", True), ("127.8.9.1", True),
     ("0.0.0.0", False), ("::", False), ("192.168.1.4", False), ("example.org", False)],
)  # fmt: skip
def test_only_loopback_is_served_without_a_key(run, monkeypatch, host, alone):
    served = {}

    def no_server(application, **settings):
        served.update(settings, application=application)

    monkeypatch.setattr("uvicorn.run", no_server)
    monkeypatch.delenv("PHANTOM_API_KEY", raising=False)
    result = run("serve", "--host", host, "--port", "8123")
    assert result.exit_code == 0
    assert (served["host"], served["port"]) == (host, 8123)
    assert ("key for every call" in result.stderr) is not alone
    guards = [m.cls.__name__ for m in served["application"].user_middleware]
    assert ("KeyRequired" in guards) is not alone


def test_an_acquisition_in_a_file_and_in_words_are_one(run, tmp_path: Path):
    asked = tmp_path / "knee.json"
    asked.write_text(
        '{"detector_air_kerma_ugy": 1.5, "scatter": {}, "focal_spot": {"size_mm": [0.6, 0.6]},'
        ' "samples_per_pixel": [2, 2], "grid": {"primary_transmission": 0.7,'
        ' "scatter_transmission": 0.1}}'
    )
    words = [
        "--dose-ugy=1.5",
        "--scatter",
        "--focal-spot-mm=0.6",
        "--samples=2",
        "--grid=0.7,0.1",
        "--seed=9",
    ]
    films = [tmp_path / name for name in ("file.npy", "words.npy", "other.npy")]
    common = ["--columns", "24", "--kvp", "60"]
    for film, options in zip(
        films,
        (["--acquisition", str(asked), "--seed", "9"], words, [*words, "--no-scatter"]),
        strict=True,
    ):
        result = run("radiograph", "sphere", *common, *options, "-o", str(film))
        assert result.exit_code == 0, result.stderr
    assert "dose_ugy" not in result.stderr.split("chosen:")[1].split("wrote")[0]
    assert "quantum_noise=compound" in result.stderr
    assert films[0].read_bytes() == films[1].read_bytes()
    assert films[0].read_bytes() != films[2].read_bytes()


def test_an_acquisition_whose_file_is_not_there_is_told(run, tmp_path: Path):
    result = run("radiograph", "sphere", "--acquisition", str(tmp_path / "none.json"), "--json")
    assert result.exit_code == 2
    (problem,) = json.loads(result.stderr)["problems"]
    assert (problem["path"], problem["kind"]) == ("/acquisition", "unreadable")
