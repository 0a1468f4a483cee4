"""Ground truth over HTTP: an archive with the picture, where the request asks for any."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import numpy as np
from PIL import Image

ZIP = {"Accept": "application/zip"}
TREE = {
    "format": "phantom/1",
    "materials": {"m": {"attenuation_per_mm": 0.03}},
    "solid": {"type": "sphere", "name": "ball", "center": [0, 0, 0], "radius": 20, "material": "m"},
}


def ball(**fields: Any) -> dict[str, Any]:
    """A request for a ball of 20 mm in a parallel beam, 33 pixels of 1.5 mm a side."""
    detector = {"center": [0, 100, 0], "right": [1, 0, 0], "down": [0, 0, -1]}
    return {
        "phantom": {"document": TREE},
        "view": {"source": None, "direction": [0, 1, 0], "detector": detector},
        "detector": {"columns": 33, "rows": 33, "pitch_mm": 1.5},
    } | fields


def disc() -> Any:
    along = (np.arange(33) - 16) * 1.5
    return along[None, :] ** 2 + along[:, None] ** 2 < 400


def unpacked(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as whole:
        return {name: whole.read(name) for name in whole.namelist()}


def test_the_archive_has_the_picture_and_what_was_asked_for(client):
    response = client.post("/v1/radiographs", json=ball(truth=["masks", "boxes"]), headers=ZIP)
    assert response.status_code == 200
    assert response.headers["content-type"] == "application/zip"
    files = unpacked(response.content)
    assert list(files) == ["image.png", "image.json", "truth.json", "coco.json", "masks/000.png"]
    np.testing.assert_array_equal(
        np.array(Image.open(io.BytesIO(files["masks/000.png"]))) > 0, disc()
    )
    assert json.loads(files["truth.json"])["leaves"][0]["name"] == "ball"
    assert json.loads(files["coco.json"])["images"][0]["file_name"] == "image.png"
    picture = client.post("/v1/radiographs", json=ball(), headers={"Accept": "image/png"})
    assert files["image.png"] == picture.content


def test_ground_truth_needs_no_accept_and_is_the_same_bytes_again(client):
    asked = ball(truth=["thickness"])
    one, two = (client.post("/v1/radiographs", json=asked) for _ in range(2))
    assert one.headers["content-type"] == "application/zip"
    assert one.content == two.content
    assert one.headers["etag"] == two.headers["etag"]
    thickness = np.load(io.BytesIO(unpacked(one.content)["thickness/000.npy"]))
    np.testing.assert_array_equal(thickness > 0, disc())
    assert thickness.max() == 40


def test_path_lengths_come_as_npy_in_the_archive(client):
    response = client.post("/v1/radiographs", json=ball(truth=["boxes"], quantity="path_lengths"))
    files = unpacked(response.content)
    assert np.load(io.BytesIO(files["image.npy"])).shape == (33, 33, 1)


def test_a_query_string_can_ask_for_it(client):
    response = client.get("/v1/radiographs/knee-1993?columns=16&truth=boxes,landmarks")
    assert response.status_code == 200
    told = json.loads(unpacked(response.content)["truth.json"])
    assert told["kinds"] == ["boxes", "landmarks"]
    assert "femur" in [leaf["name"] for leaf in told["leaves"]]


def test_no_picture_holds_it_and_no_archive_is_without(client):
    refused = client.post(
        "/v1/radiographs", json=ball(truth=["masks"]), headers={"Accept": "image/png"}
    )
    assert refused.status_code == 406
    assert "application/zip" in refused.json()["detail"]
    empty = client.post("/v1/radiographs", json=ball(), headers=ZIP)
    assert empty.status_code == 422
    assert [p["path"] for p in empty.json()["problems"]] == ["/truth"]
