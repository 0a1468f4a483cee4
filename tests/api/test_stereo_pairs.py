"""Pairs over HTTP: every form, and the same numbers as from Python."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pydicom
import pytest
from PIL import Image

import phantom
from phantom.imaging import Presentation

URL = "/v1/stereo-pairs"
BODY = {
    "phantom": {"name": "knee-1993"},
    "view": {"preset": "pa"},
    "detector": {"columns": 48, "rows": 40},
    "beam": {"energy_kev": 60},
}


def asked(**stereo: object) -> dict[str, object]:
    return {**BODY, "stereo": stereo}


@pytest.fixture(scope="module")
def pair():
    knee = phantom.library.build("knee-1993")
    view = phantom.preset_view(knee, "pa", columns=48, rows=40)
    return phantom.stereo_pair(knee, view, baseline_mm=90)


def image(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(data)))


def test_by_default_both_images_come_side_by_side(client, pair) -> None:
    answer = client.post(URL, json=asked(baseline_mm=90))
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "image/png"
    levels = pair.presented("signal", Presentation())
    expected = np.concatenate([levels["left"], levels["right"]], axis=1)
    np.testing.assert_array_equal(image(answer.content), expected)


def test_without_a_word_of_stereo_it_is_a_pair(client) -> None:
    answer = client.post(URL, json=BODY)
    told = json.loads(answer.headers["x-phantom-geometry"])
    assert told["baseline_mm"] == pytest.approx(65)
    assert told["comfort"]["level"] == "comfortable"
    np.testing.assert_array_equal(np.shape(told["epipolar_matrix"]), (3, 3))
    assert np.shape(told["left"]["projection_matrix"]) == (3, 4)
    assert told["left"]["projection_matrix"] != told["right"]["projection_matrix"]


@pytest.mark.parametrize(
    ("accept", "layout", "kind"),
    [
        ("image/tiff", "anaglyph", "image/tiff"),
        ("image/jpeg", None, "image/jpeg"),
        ("image/x-exr", None, "image/x-exr"),
        ("*/*", "two_view", "image/x-exr"),
        ("*/*", "files", "application/zip"),
        ("*/*", "all", "application/zip"),
        ("application/json", "cross_eyed", "application/json"),
        ("application/zip", None, "application/zip"),
    ],
)
def test_the_form_is_what_accept_and_layout_say(client, accept, layout, kind) -> None:
    body = asked(layout=layout) if layout else BODY
    answer = client.post(URL, json=body, headers={"Accept": accept})
    assert answer.status_code == 200
    assert answer.headers["content-type"] == kind
    assert answer.headers["vary"] == "Accept"


@pytest.mark.parametrize(
    ("accept", "layout"),
    [
        ("application/x-npy", None),
        ("image/png", "files"),
        ("image/png", "two_view"),
        ("application/dicom", "all"),
    ],
)
def test_a_form_that_the_layout_does_not_have_is_not_acceptable(client, accept, layout) -> None:
    body = asked(layout=layout) if layout else BODY
    assert client.post(URL, json=body, headers={"Accept": accept}).status_code == 406


def test_an_archive_of_dicom_files_has_their_relationship(client) -> None:
    answer = client.post(URL, json=asked(layout="files", format="dicom"))
    with zipfile.ZipFile(io.BytesIO(answer.content)) as whole:
        assert whole.namelist() == ["left.dcm", "right.dcm", "stereo.dcm", "pair.json"]
        stereo = pydicom.dcmread(io.BytesIO(whole.read("stereo.dcm")))
        left = pydicom.dcmread(io.BytesIO(whole.read("left.dcm")))
    (found,) = stereo.StereoPairsSequence
    assert found.LeftImageSequence[0].ReferencedSOPInstanceUID == left.SOPInstanceUID


def test_ground_truth_comes_for_each_eye(client, pair) -> None:
    body = {**asked(baseline_mm=90, layout="anaglyph"), "truth": ["masks", "centroids"]}
    answer = client.post(URL, json=body)
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as whole:
        names = whole.namelist()
        told = {eye: json.loads(whole.read(f"{eye}/truth.json")) for eye in ("left", "right")}
        pair_told = json.loads(whole.read("pair.json"))
    assert names[:2] == ["anaglyph.png", "pair.json"]
    for index, leaf in enumerate(told["left"]["leaves"]):
        apart = leaf["centroid_px"][0] - told["right"]["leaves"][index]["centroid_px"][0]
        low, high = pair.disparity(leaf["name"]).pixels
        assert low - 0.1 < apart < high + 0.1, "within its range, but for pixels of 7 mm"
        shown = next(d for d in pair_told["disparities"] if d["name"] == leaf["name"])
        assert shown["pixels"] == pytest.approx([low, high])


def test_the_single_image_is_one_file_of_any_kind(client) -> None:
    answer = client.post(URL, json=asked(mono="single"), headers={"Accept": "application/dicom"})
    assert answer.status_code == 200
    assert pydicom.dcmread(io.BytesIO(answer.content)).Rows == 40


def test_equal_requests_have_one_tag_and_others_another(client) -> None:
    tags = [
        client.post(URL, json=body).headers["etag"]
        for body in (BODY, asked(baseline_mm=65), asked(baseline_mm=66), asked(layout="anaglyph"))
    ]
    assert len(set(tags)) == 4
    assert client.post(URL, json=BODY).headers["etag"] == tags[0]


def test_a_blind_pair_has_no_geometry(client) -> None:
    answer = client.post(URL, json={**asked(layout="all"), "blind": True})
    assert "x-phantom-geometry" not in answer.headers
    assert b"femur" not in answer.content
    assert b"knee" not in answer.content


def test_two_images_count_twice(service) -> None:
    small = service(max_pixels=48 * 40)
    assert small.post("/v1/radiographs", json=BODY).status_code == 200
    refused = small.post(URL, json=BODY)
    assert refused.status_code == 422
    assert [p["path"] for p in refused.json()["problems"]] == ["/detector"]
    assert "2 × 48 × 40" in refused.json()["problems"][0]["message"]
    assert small.post(URL, json=asked(mono="same_image")).status_code == 200


def test_the_description_has_the_call(client) -> None:
    told = client.get("/openapi.json").json()
    content = told["paths"][URL]["post"]["requestBody"]["content"]["application/json"]
    bodies = [one["$ref"].split("/")[-1] for one in content["schema"]["anyOf"]]
    assert bodies == ["StereoRequest", "RenderPairRequest"]
    assert set(bodies) <= set(told["components"]["schemas"])
    assert "baseline_mm" in told["components"]["schemas"]["StereoWish"]["properties"]


SEEN = {"phantom": {"name": "knee-1993"}, "camera": {"preset": "front", "columns": 40}}


def test_a_body_with_a_camera_is_a_pair_in_visible_light(client) -> None:
    answer = client.post(URL, json={**SEEN, "stereo": {"baseline_mm": 90, "layout": "cross_eyed"}})
    assert answer.status_code == 200, answer.text
    knee = phantom.library.build("knee-1993")
    small = phantom.CameraPreset(preset="front", columns=40, rows=40)
    levels = phantom.render_pair(knee, small, baseline_mm=90).levels()
    expected = np.concatenate([levels["right"], levels["left"]], axis=1)
    np.testing.assert_array_equal(image(answer.content), expected)
    told = json.loads(answer.headers["x-phantom-geometry"])
    assert told["baseline_mm"] == pytest.approx(90)
    assert told["left"]["camera"]["eye"] != told["right"]["camera"]["eye"]


def test_all_of_a_pair_in_visible_light_has_no_dicom(client) -> None:
    answer = client.post(URL, json=SEEN, headers={"Accept": "application/zip"})
    with zipfile.ZipFile(io.BytesIO(answer.content)) as whole:
        names = whole.namelist()
    assert "pair.exr" in names
    assert not [name for name in names if name.endswith(".dcm")]
    refused = client.post(
        URL,
        json={**SEEN, "stereo": {"layout": "files", "format": "dicom"}},
        headers={"Accept": "application/zip"},
    )
    assert [p["path"] for p in refused.json()["problems"]] == ["/quantity"]
