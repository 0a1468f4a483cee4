"""Bad input gets the same list of problems on the command line and over HTTP."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fastapi.testclient import TestClient

from api.app import create_app
from api.settings import Settings
from phantom.requests.words import RENDER_PAIR_WORDS, RENDER_WORDS, STEREO_WORDS

SPHERE = '{"type": "sphere", "center": [0, 0, 0], "radius": 5, "material": "a"}'


def document(solid: str = SPHERE, materials: str = '{"a": {"attenuation_per_mm": 1}}') -> str:
    return f'{{"format": "phantom/1", "materials": {materials}, "solid": {solid}}}'


DOCUMENTS = {
    "not JSON": "{",
    "not an object": "[]",
    "empty": "{}",
    "NaN": document(SPHERE.replace("5", "NaN")),
    "1e999 and an unknown field": document(SPHERE.replace("5", "1e999, \"colour\": 1")),
    "5,000 digits": document(SPHERE.replace("5", "9" * 5000)),
    "a lone surrogate": document(SPHERE.replace('"a"', '"\\ud800"')),
    "a lone surrogate as a key": document(materials='{"\\udc00": {"attenuation_per_mm": 1}}'),
    "depth 1,000": document('{"type": "transformed", "solid": ' * 1000 + "0" + "}" * 1000),
    "depth 65": document(
        '{"type": "transformed", "translate": [1, 0, 0], "solid": ' * 65 + SPHERE + "}" * 65
    ),
    "a circle of instances": (
        '{"format": "phantom/1", "solid": {"type": "instance", "of": "x"},'
        ' "definitions": {"x": {"type": "instance", "of": "x"}}}'
    ),
    "an unbounded solid": document(
        '{"type": "quadric", "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, 0, -1], "material": "a"}'
    ),
    "several at once": document('{"type": "sphere", "radius": -1, "material": "b"}'),
    "a repeated key": document()[:-1] + ', "name": "x", "name": "y"}',
}  # fmt: skip

WORDS: dict[str, dict[str, str]] = {
    "an unknown kind of ground truth": {"truth": "masks,labels"},
    "a window without width": {"window_center": "1", "window_width": "0"},
    "a display whose white is its black": {"gsdf": '{"l_min_cd_m2": 1, "l_max_cd_m2": 1}'},
    "a response that falls": {
        "gsdf": '{"l_min_cd_m2": 1, "l_max_cd_m2": 9, "response": [[0, 9], [255, 1]]}'
    },
    "no such view": {"view": "sideways"},
    "no pixels": {"columns": "0", "rows": "-3"},
    "too many pixels": {"columns": "16384", "rows": "16384"},
    "half a pixel": {"columns": "2.5"},
    "NaN": {"energy_kev": "NaN", "pitch_mm": "nan"},
    "1e999": {"source_detector_mm": "1e999"},
    "5,000 digits": {"columns": "9" * 5000},
    "an energy that is not tabulated": {"energy_kev": "0.1"},
    "a tube voltage beyond the tables": {"kvp": "200"},
    "a tube voltage and an energy": {"kvp": "70", "energy_kev": "60"},
    "a voltage that the anode has no table of": {"kvp": "70", "anode": "rhodium"},
    "an unknown anode": {"kvp": "70", "anode": "gold"},
    "an unknown filter": {"kvp": "70", "filtration": "cheese=1"},
    "a filter without thickness": {"kvp": "70", "filtration": "copper"},
    "a filter of negative thickness": {"kvp": "70", "filtration": "copper=-1"},
    "a filter twice": {"kvp": "70", "filtration": "copper=1,copper=2"},
    "a filter without a tube": {"filtration": "copper=1"},
    "distances that contradict": {"source_object_mm": "500", "object_detector_mm": "500"},
    "an angle without effect": {"angle_deg": "30"},
    "words for numbers": {"bits": "many", "mode": "7"},
    "JSON that is none": {"view": "{"},
    "an explicit view with nothing in it": {"view": '{"source": [0, 0]}'},
    "a source in its detector": {
        "view": '{"source": [0, 0, 0], "detector":'
        ' {"center": [0, 0, 0], "right": [1, 0, 0], "down": [0, 0, -1]}}'
    },
    "no pitch": {"pitch_mm": "0"},
    "a negative dose": {"dose_ugy": "-1"},
    "no tube load": {"kvp": "70", "mas": "0"},
    "a dose and a tube load": {"kvp": "70", "mas": "2", "dose_ugy": "2.5"},
    "a tube load without a tube": {"mas": "2"},
    "a source beyond the detector": {"source_detector_mm": "900", "source_object_mm": "1000"},
    "a detector behind the source": {
        "view": '{"source": [0, 500, 0], "detector":'
        ' {"center": [0, 900, 0], "right": [1, 0, 0], "down": [0, 0, -1]}}',
        "pitch_mm": "1",
    },
    "no samples": {"samples": "0"},
    "a focal spot of no size": {"focal_spot_mm": "-0.6"},
    "a grid that is none": {"grid": "much"},
    "a grid that gives more than it gets": {"grid": "1.5,-1"},
    "an unknown absorber": {
        "acquisition": '{"detector": {"absorber": {"material": "cheese", "thickness_mg_cm2": 1}}}'
    },
    "an acquisition in two ways": {"acquisition": '{"mas": 2}', "mas": "3"},
    "a flat field with nothing to correct": {"acquisition": '{"flat_field": true}'},
    "a seed below zero": {"seed": "-1", "case": "1.5"},
    "several parts at once": {"view": "x", "bits": "9", "columns": "0", "energy_kev": "-1"},
}


PAIRS: dict[str, dict[str, Any]] = {
    "no baseline": {"baseline_mm": 0},
    "a negative baseline": {"baseline_mm": -65},
    "a baseline that is a word": {"baseline_mm": "wide"},
    "an angle with a shift": {"stereo_angle_deg": 6},
    "a baseline with a rotation": {"method": "rotate", "baseline_mm": 65},
    "a screen at the eyes": {"screen": {"pixel_pitch_mm": 0.27, "distance_mm": 0, "ipd_mm": 63}},
    "a screen of another shape": {"screen": {"distance_mm": 600, "colour": 1}},
    "a plane of zero parallax behind the source": {"zero_parallax": {"plane_mm": -10}},
    "no such plane": {"zero_parallax": "skin"},
    "a shift of a parallel beam": {
        "view": {"source": None, "direction": [0, 1, 0], "detector": {
            "center": [0, 100, 0], "right": [1, 0, 0], "down": [0, 0, -1]}},
    },
    "an unknown layout": {"layout": "hologram"},
    "an unknown format": {"layout": "files", "format": "gif"},
    "a format of no files": {"layout": "anaglyph", "format": "dicom"},
    "one image side by side": {"mono": "single", "layout": "side_by_side"},
    "several at once": {"baseline_mm": -1, "dose": "half", "mono": "both", "columns": 0},
}  # fmt: skip


RENDERS: dict[str, dict[str, Any]] = {
    "no such side": {"view": "sideways"},
    "an eye in its target": {"view": {"eye": [1, 2, 3], "target": [1, 2, 3]}},
    "an up along the line of sight": {"view": {"eye": [0, 0, 9], "target": [0, 0, 0]}},
    "a side and an angle": {"view": "front", "azimuth_deg": 10},
    "an eye and a zoom": {"view": {"eye": [0, 0, 9], "target": [0, 0, 0]}, "zoom": 2},
    "a field of view of parallel lines": {"parallel": True, "field_of_view_deg": 10},
    "no pixels": {"columns": 0, "rows": -1},
    "too many pixels": {"columns": 16384, "rows": 16384},
    "too many samples": {"samples_per_pixel": 9},
    "an unknown name to hide": {"hide": ["bone", "ball"]},
    "a light of no kind": {"lighting": {"lights": [{"type": "lamp"}]}},
    "a light from nowhere": {
        "lighting": {"lights": [{"type": "directional", "to_light": [0, 0, 0]}]}
    },
    "a colour beyond white": {"background": [0, 0, 2]},
    "an unknown tone": {"mode": "film", "bits": 12},
}  # fmt: skip


SEEN_PAIRS: dict[str, dict[str, Any]] = {
    "no baseline": {"baseline_mm": 0},
    "a screen at the eyes": {"screen": {"pixel_pitch_mm": 0.27, "distance_mm": 0, "ipd_mm": 63}},
    "a plane behind the camera": {"zero_parallax": {"plane_mm": -10}},
    "a detector": {"zero_parallax": "detector"},
    "a shift of parallel lines of sight": {"parallel": True},
    "an unknown layout": {"layout": "hologram"},
    "several at once": {"baseline_mm": -1, "mono": "both", "columns": 0},
}


@pytest.fixture(scope="module")
def client() -> TestClient:
    return TestClient(create_app(Settings()), raise_server_exceptions=False)


def told(problems: list[dict[str, str]]) -> list[tuple[str, str, str]]:
    return [(p["path"], p["kind"], p["message"]) for p in problems]


@pytest.mark.parametrize("text", DOCUMENTS.values(), ids=DOCUMENTS.keys())
def test_of_a_document(run, client, written, text):
    there = client.post(
        "/v1/documents/validate", content=text, headers={"Content-Type": "application/json"}
    )
    here = run("validate", written(text), "--json")
    assert (there.status_code, here.exit_code) == (422, 2)
    assert told(json.loads(here.stderr)["problems"]) == told(there.json()["problems"])


@pytest.mark.parametrize("text", DOCUMENTS.values(), ids=DOCUMENTS.keys())
def test_of_a_document_to_be_xrayed(run, client, written, text):
    if text == "{":
        pytest.skip("the body as a whole would be no JSON")
    body = f'{{"phantom": {{"document": {text}}}, "detector": {{"columns": 0}}}}'
    there = client.post(
        "/v1/radiographs", content=body, headers={"Content-Type": "application/json"}
    )
    here = run("radiograph", written(text), "--columns", "0", "--json")
    assert (there.status_code, here.exit_code) == (422, 2)
    assert told(json.loads(here.stderr)["problems"]) == told(there.json()["problems"])


@pytest.mark.parametrize("words", WORDS.values(), ids=WORDS.keys())
def test_of_words(run, client, words: dict[str, Any]):
    options = [part for k, v in words.items() for part in (f"--{k.replace('_', '-')}={v}",)]
    there = client.get("/v1/radiographs/sphere", params=words)
    here = run("radiograph", "sphere", *options, "--json", "-o", "never.png")
    assert (there.status_code, here.exit_code) == (422, 2)
    problems = told(json.loads(here.stderr)["problems"])
    assert problems
    assert problems == told(there.json()["problems"])


@pytest.mark.parametrize("words", PAIRS.values(), ids=PAIRS.keys())
def test_of_a_pair(run, client, words: dict[str, Any]):
    """The command's words and the JSON of the service; PNG is the form of both."""
    body: dict[str, Any] = {"phantom": {"name": "sphere"}}
    for word, value in words.items():
        *sections, name = STEREO_WORDS[word] if word != "view" else ("view",)
        part = body
        for section in sections:
            part = part.setdefault(section, {})
        part[name] = value
    texts = {k: v if isinstance(v, str) else json.dumps(v) for k, v in words.items()}
    options = [f"--{k.replace('_', '-')}={v}" for k, v in texts.items()]
    archived = words.get("layout") == "files"
    there = client.post("/v1/stereo-pairs", json=body)
    output = "never.zip" if archived else "never.png"
    here = run("stereo", "sphere", *options, "--json", "-o", output)
    assert (there.status_code, here.exit_code) == (422, 2), here.stderr
    problems = told(json.loads(here.stderr)["problems"])
    assert problems
    assert problems == told(there.json()["problems"])


@pytest.mark.parametrize("words", RENDERS.values(), ids=RENDERS.keys())
def test_of_a_render(run, client, words: dict[str, Any]):
    """The command's words, and the JSON of the service."""
    body: dict[str, Any] = {"phantom": {"name": "sphere"}}
    for word, value in sorted(words.items(), key=lambda pair: pair[0] != "view"):
        *sections, name = RENDER_WORDS[word]
        if word == "view" and isinstance(value, dict):
            body["camera"] = dict(value)
            continue
        part = body
        for section in sections:
            part = part.setdefault(section, {})
        part[name] = value
    texts = {k: v if isinstance(v, str) else json.dumps(v) for k, v in words.items()}
    options = [f"--{k.replace('_', '-')}={v}" for k, v in texts.items() if k != "parallel"]
    options += ["--parallel"] * ("parallel" in words)
    there = client.post("/v1/renders", json=body)
    here = run("render", "sphere", *options, "--json", "-o", "never.png")
    assert (there.status_code, here.exit_code) == (422, 2), here.stderr
    problems = told(json.loads(here.stderr)["problems"])
    assert problems
    assert problems == told(there.json()["problems"])


@pytest.mark.parametrize("words", SEEN_PAIRS.values(), ids=SEEN_PAIRS.keys())
def test_of_a_pair_in_visible_light(run, client, words: dict[str, Any]):
    body: dict[str, Any] = {"phantom": {"name": "sphere"}, "camera": {}}
    for word, value in words.items():
        section, name = RENDER_PAIR_WORDS[word]
        body.setdefault(section, {})[name] = value
    options = []
    for word, value in words.items():
        text = value if isinstance(value, str) else json.dumps(value)
        options.append("--parallel" if word == "parallel" else f"--{word.replace('_', '-')}={text}")
    there = client.post("/v1/stereo-pairs", json=body)
    here = run("render-pair", "sphere", *options, "--json", "-o", "never.png")
    assert (there.status_code, here.exit_code) == (422, 2), here.stderr
    problems = told(json.loads(here.stderr)["problems"])
    assert problems
    assert problems == told(there.json()["problems"])


def test_of_parameters(run, client):
    there = client.get("/v1/radiographs/sphere?parameters.radius_mm=-1&parameters.colour=red")
    here = run("radiograph", "sphere", "--set", "radius_mm=-1", "--set", "colour=red", "--json")
    assert told(json.loads(here.stderr)["problems"]) == told(there.json()["problems"])
    assert len(there.json()["problems"]) == 2
