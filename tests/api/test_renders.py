"""What ``/v1/renders`` gives, held against Phong's model of a sphere."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import OpenImageIO
import pytest

RADIUS_MM, SIDE, WIDTH_MM = 20.0, 41, 50.0
LOOK = {"color": [0.8, 0.6, 0.4], "ambient": 0.2, "diffuse": 0.6, "specular": 0.0}
NPY = {"Accept": "application/x-npy"}


def ball(**fields: Any) -> dict[str, Any]:
    """A request for a matt ball, lit and seen from the front."""
    solid = {"type": "sphere", "center": [0, 0, 0], "radius": RADIUS_MM, "material": "m"}
    document = {
        "format": "phantom/1",
        "materials": {"m": {"attenuation_per_mm": 0.02}},
        "solid": {**solid, "appearance": LOOK},
    }
    front = {"eye": [0, -100, 0], "target": [0, 0, 0], "parallel_width_mm": WIDTH_MM}
    return {
        "phantom": {"document": document},
        "camera": {**front, "columns": SIDE, "rows": SIDE},
        "lighting": {"lights": [{"type": "directional", "to_light": [0, -1, 0]}]},
        "samples_per_pixel": 1,
    } | fields


def expected() -> np.ndarray:
    """colour (K_a + K_d N.L), with N.L the depth of the sphere's front over its radius."""
    along = (np.arange(SIDE) - (SIDE - 1) / 2) * WIDTH_MM / SIDE
    squared = along[None, :] ** 2 + along[:, None] ** 2
    cosine = np.sqrt(np.maximum(RADIUS_MM**2 - squared, 0.0)) / RADIUS_MM
    light = np.where(squared < RADIUS_MM**2, 0.2 + 0.6 * cosine, 0.0)
    return light[..., None] * np.array([0.8, 0.6, 0.4])


def test_numbers_are_phongs(client, from_npy):
    response = client.post("/v1/renders", json=ball(), headers=NPY)
    assert response.status_code == 200
    assert response.headers["vary"] == "Accept"
    np.testing.assert_allclose(from_npy(response.content), expected(), rtol=0, atol=1e-6)
    camera = json.loads(response.headers["X-Phantom-Geometry"])
    assert camera["parallel_width_mm"] == WIDTH_MM


def test_the_tag_is_of_the_request_and_the_form(client):
    one, same = (client.post("/v1/renders", json=ball(), headers=NPY) for _ in range(2))
    assert one.headers["etag"] == same.headers["etag"]
    assert one.content == same.content
    other = client.post("/v1/renders", json=ball(background=[0, 0, 0.5]), headers=NPY)
    png = client.post("/v1/renders", json=ball())
    assert len({r.headers["etag"] for r in (one, other, png)}) == 3


@pytest.mark.parametrize(
    ("accept", "extension"), [("image/png", "png"), ("image/tiff", "tif"), ("image/jpeg", "jpg")]
)
def test_pictures_hold_the_papers_stretch(client, tmp_path, accept, extension):
    tone = {"mode": "stretch", "bits": 16 if extension != "jpg" else 8}
    response = client.post("/v1/renders", json=ball(tone=tone), headers={"Accept": accept})
    path = tmp_path / f"ball.{extension}"
    path.write_bytes(response.content)
    pixels = OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)
    share = expected() / expected().max()
    # JPEG loses most where the ball's outline is.
    off = np.abs(pixels - share)
    if extension == "jpg":
        assert off.mean() < 0.01
    else:
        assert off.max() < 1e-5 + 0.5 / 65535


def test_an_openexr_has_linear_light_in_the_layers_programs_expect(client, tmp_path):
    response = client.post("/v1/renders", json=ball(), headers={"Accept": "image/x-exr"})
    path = tmp_path / "ball.exr"
    path.write_bytes(response.content)
    image = OpenImageIO.ImageBuf(str(path))
    assert image.spec().channelnames == ("R", "G", "B")
    np.testing.assert_allclose(image.get_pixels(OpenImageIO.FLOAT), expected(), rtol=0, atol=1e-6)
    told = json.loads(image.spec().getattribute("phantom:metadata"))
    assert told["style"] == "shaded"
    assert told["lighting"]["lights"][0]["to_light"] == [0, -1, 0]


def test_json_is_what_is_known_of_the_picture(client):
    answer = client.post("/v1/renders", json=ball(), headers={"Accept": "application/json"}).json()
    assert answer["camera"]["eye"] == [0, -100, 0]
    assert answer["warnings"] == []
    assert answer["phantom"]["material_names"] == ["m"]


def test_a_picture_that_costs_too_much_is_refused_before_it_is_begun(service):
    with service(max_pixels=10_000, max_exposure_rays=20_000) as client:
        large = {"preset": "front", "columns": 200}
        answer = client.post("/v1/renders", json=ball(camera=large)).json()
        assert [(p["path"], p["kind"]) for p in answer["problems"]] == [("/camera", "too_large")]
        fine = ball(camera={"preset": "front", "columns": 90}, samples_per_pixel=2)
        answer = client.post("/v1/renders", json=fine).json()
        assert [p["path"] for p in answer["problems"]] == ["/samples_per_pixel"]


def test_a_radiograph_has_no_colours(client):
    body = {"phantom": {"name": "sphere"}, "quantity": "color"}
    assert client.post("/v1/radiographs", json=body).status_code == 422
