"""What ``/v1/radiographs`` gives, held against the chords of a circle."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import pytest

RADIUS_MM, SIDE, PITCH_MM = 20.0, 33, 1.5
SOURCE_DETECTOR_MM, OBJECT_DETECTOR_MM = 800.0, 150.0
NPY = {"Accept": "application/x-npy"}


def ball(**fields: Any) -> dict[str, Any]:
    """A request for a ball with μ = 0.03 per mm."""
    parameters = {"radius_mm": RADIUS_MM, "attenuation_per_mm": 0.03}
    return {
        "phantom": {"name": "sphere", "parameters": parameters},
        "view": {
            "preset": "ap",
            "source_detector_mm": SOURCE_DETECTOR_MM,
            "object_detector_mm": OBJECT_DETECTOR_MM,
        },
        "detector": {"columns": SIDE, "rows": SIDE, "pitch_mm": PITCH_MM},
    } | fields


def chords_mm() -> np.ndarray:
    """2·√(R² − d²) for the ray from the source to each pixel, d its distance from the centre."""
    along = (np.arange(SIDE) - (SIDE - 1) / 2) * PITCH_MM
    squared = along[None, :] ** 2 + along[:, None] ** 2
    to_centre = SOURCE_DETECTOR_MM - OBJECT_DETECTOR_MM
    d2 = to_centre**2 * squared / (squared + SOURCE_DETECTOR_MM**2)
    return 2 * np.sqrt(np.maximum(RADIUS_MM**2 - d2, 0.0))


ADDRESS = (
    "/v1/radiographs/sphere?view=ap&source_detector_mm=800&object_detector_mm=150"
    "&columns=33&rows=33&pitch_mm=1.5&parameters.radius_mm=20&parameters.attenuation_per_mm=0.03"
)


def test_path_lengths_are_chords(client, from_npy):
    response = client.post("/v1/radiographs", json=ball(quantity="path_lengths"), headers=NPY)
    assert response.status_code == 200
    assert response.headers["content-type"] == "application/x-npy"
    lengths = from_npy(response.content)
    assert lengths.shape == (SIDE, SIDE, 1)
    np.testing.assert_allclose(lengths[..., 0], chords_mm(), atol=1e-5)


def test_signal_is_beers_law_of_the_chords(client, from_npy):
    response = client.post("/v1/radiographs", json=ball(), headers=NPY)
    np.testing.assert_allclose(from_npy(response.content), np.exp(-0.03 * chords_mm()), rtol=1e-6)


@pytest.mark.parametrize(("bits", "tolerance"), [(8, 0.5), (16, 0.5)])
def test_the_picture_is_the_stretched_transmission(client, tmp_path: Path, bits, tolerance):
    wanted = {"mode": "stretch", "polarity": "bones_dark", "bits": bits}
    response = client.post("/v1/radiographs", json=ball(presentation=wanted))
    assert response.headers["content-type"] == "image/png"
    (tmp_path / "ball.png").write_bytes(response.content)
    picture = OpenImageIO.ImageBuf(str(tmp_path / "ball.png"))
    grey = np.squeeze(picture.get_pixels(OpenImageIO.UINT16 if bits == 16 else OpenImageIO.UINT8))
    transmission = np.exp(-0.03 * chords_mm())
    low, high = transmission.min(), transmission.max()
    expected = (transmission - low) / (high - low) * (2**bits - 1)
    np.testing.assert_allclose(grey, expected, atol=tolerance + 1e-6)


def test_the_address_bar_gives_the_same_bytes_as_a_body(client):
    posted, got = client.post("/v1/radiographs", json=ball()), client.get(ADDRESS)
    assert got.status_code == 200
    assert got.content == posted.content
    assert got.headers["etag"] == posted.headers["etag"]


def test_a_document_gives_the_same_numbers_as_the_library(client, from_npy):
    parameters = ball()["phantom"]["parameters"]
    document = client.post("/v1/phantoms/sphere/document", json=parameters).json()
    own = client.post("/v1/radiographs", json=ball(phantom={"document": document}), headers=NPY)
    named = client.post("/v1/radiographs", json=ball(), headers=NPY)
    np.testing.assert_array_equal(from_npy(own.content), from_npy(named.content))


def test_an_explicit_view_equals_the_preset_that_it_spells_out(client, from_npy):
    view = {
        "source": [0, OBJECT_DETECTOR_MM - SOURCE_DETECTOR_MM, 0],
        "detector": {"center": [0, OBJECT_DETECTOR_MM, 0], "right": [1, 0, 0], "down": [0, 0, -1]},
    }
    placed = client.post("/v1/radiographs", json=ball(view=view), headers=NPY)
    preset = client.post("/v1/radiographs", json=ball(), headers=NPY)
    np.testing.assert_allclose(from_npy(placed.content), from_npy(preset.content), rtol=1e-7)


def test_a_parallel_beam_casts_a_shadow_of_the_ball_s_own_size(client, from_npy):
    view = {
        "source": None,
        "direction": [0, 1, 0],
        "detector": {"center": [0, 300, 0], "right": [1, 0, 0], "down": [0, 0, -1]},
    }
    request = ball(view=view, quantity="path_lengths")
    lengths = from_npy(client.post("/v1/radiographs", json=request, headers=NPY).content)
    along = (np.arange(SIDE) - (SIDE - 1) / 2) * PITCH_MM
    d2 = along[None, :] ** 2 + along[:, None] ** 2
    expected = 2 * np.sqrt(np.maximum(RADIUS_MM**2 - d2, 0))
    np.testing.assert_allclose(lengths[..., 0], expected, atol=1e-5)


def test_without_a_pitch_the_detector_covers_the_phantom(client, from_npy):
    for view in (
        ball()["view"],
        {
            "source": [0, -600, 30],
            "detector": {"center": [0, 200, -10], "right": [1, 0, 0], "down": [0, 0, -1]},
        },
    ):
        request = ball(view=view, detector={"columns": 40}, quantity="path_lengths")
        response = client.post("/v1/radiographs", json=request, headers=NPY)
        lengths = from_npy(response.content)[..., 0]
        assert lengths.shape == (40, 40), "square, where only the columns are given"
        edge = np.concatenate([lengths[0], lengths[-1], lengths[:, 0], lengths[:, -1]])
        assert edge.max() == 0
        assert lengths.max() > 1.9 * RADIUS_MM


def test_the_geometry_projects_the_centre_to_where_the_shadow_is_deepest(client, from_npy):
    isocentre = [3.0, 0.0, -6.0]
    request = ball(view=ball()["view"] | {"isocentre": isocentre}, quantity="path_lengths")
    response = client.post("/v1/radiographs", json=request, headers=NPY)
    geometry = json.loads(response.headers["x-phantom-geometry"])
    u, v, w = np.array(geometry["projection_matrix"]) @ [0, 0, 0, 1]
    lengths = from_npy(response.content)[..., 0]
    row, column = np.unravel_index(lengths.argmax(), lengths.shape)
    assert abs(u / w - column) <= 1
    assert abs(v / w - row) <= 1
    magnification = SOURCE_DETECTOR_MM / (SOURCE_DETECTOR_MM - OBJECT_DETECTOR_MM)
    assert geometry["pitch_mm"] == [PITCH_MM, PITCH_MM]
    assert geometry["intrinsics"][0][0] == pytest.approx(SOURCE_DETECTOR_MM / PITCH_MM)
    assert magnification == pytest.approx(
        json.loads(client.post("/v1/radiographs", json=ball()).headers["x-phantom-geometry"])[
            "magnification"
        ]
    )


def test_the_json_answer_lists_every_stage_with_its_values(client):
    response = client.post("/v1/radiographs", json=ball(), headers={"Accept": "application/json"})
    stages = {stage["stage"]: stage for stage in response.json()["stages"]}
    assert stages["beer_lambert"]["attenuation_per_mm"] == {"ball": 0.03}


def test_a_picture_already_held_is_not_sent_again(client):
    first = client.get(ADDRESS)
    tag = first.headers["etag"]
    assert tag.startswith('"')
    assert "immutable" in first.headers["cache-control"]
    assert first.headers["vary"] == "Accept"
    for known in (tag, f'"other", {tag}', f"W/{tag}", "*"):
        again = client.get(ADDRESS, headers={"If-None-Match": known})
        assert (again.status_code, again.content) == (304, b"")
        assert again.headers["etag"] == tag
    assert client.get(ADDRESS, headers={"If-None-Match": '"other"'}).status_code == 200
    posted = client.post("/v1/radiographs", json=ball(), headers={"If-None-Match": tag})
    assert posted.status_code == 200, "304 answers GET and HEAD only"


def test_the_tag_changes_with_anything_that_changes_the_answer(client):
    tags = {
        client.head(address, headers=headers).headers["etag"]
        for address, headers in (
            (ADDRESS, {}),
            (ADDRESS, NPY),
            (ADDRESS + "&bits=16", {}),
            (ADDRESS + "&polarity=bones_dark", {}),
            (ADDRESS.replace("radius_mm=20", "radius_mm=21"), {}),
            (ADDRESS.replace("view=ap", "view=pa"), {}),
        )
    }
    assert len(tags) == 6


def test_head_has_the_headers_and_no_body(client):
    head = client.head(ADDRESS)
    assert (head.status_code, head.content) == (200, b"")
    assert head.headers["etag"] == client.get(ADDRESS).headers["etag"]


@pytest.mark.parametrize(
    ("accept", "media_type"),
    [
        ("*/*", "image/png"),
        ("image/avif,image/webp,image/*,*/*;q=0.8", "image/png"),
        ("text/html,application/xml;q=0.9,*/*;q=0.8", "image/png"),
        ("application/json;q=0.5, application/x-npy", "application/x-npy"),
        ("image/png;q=0, */*", "application/x-npy"),
        ("APPLICATION/JSON", "application/json"),
        ("image/tiff", "image/tiff"),
        ("image/tiff; dtype=float32", "image/tiff;dtype=float32"),
        ("image/tiff, image/tiff;dtype=float32;q=0.5", "image/tiff"),
        ("image/*;q=0.3, image/x-exr", "image/x-exr"),
        ("image/jpeg", "image/jpeg"),
        ('Application/DICOM; intent="processing"', "application/dicom;intent=processing"),
        ("application/dicom", "application/dicom"),
        ("application/x-npy;dtype=uint16", "application/x-npy;dtype=uint16"),
    ],
)
def test_the_caller_chooses_the_form(client, accept, media_type):
    response = client.get(ADDRESS, headers={"Accept": accept})
    assert response.headers["content-type"] == media_type


@pytest.mark.parametrize(
    "accept", ["image/gif", "image/tiff;dtype=float64", "text/*", "image/png;q=0", "image/png;q=x"]
)
def test_a_form_that_is_not_made_is_refused(client, accept):
    response = client.get(ADDRESS, headers={"Accept": accept})
    assert response.status_code == 406
    assert response.headers["content-type"] == "application/problem+json"


def test_codes_come_with_what_they_count(client, from_npy):
    accept = {"Accept": "application/x-npy;dtype=uint16"}
    response = client.post("/v1/radiographs", json=ball(quantity="line_integral"), headers=accept)
    coding = json.loads(response.headers["x-phantom-coding"])
    assert coding == {"quantity": "line_integral", "codes_per_unit": 8192, "offset": 0}
    codes = from_npy(response.content)
    assert codes.dtype == np.uint16
    np.testing.assert_allclose(codes / 8192, 0.03 * chords_mm(), atol=0.5 / 8192 + 1e-9)


@pytest.mark.parametrize("accept", ["image/png", "application/dicom", "application/json"])
def test_a_blind_answer_does_not_say_what_it_shows(client, accept):
    seen = client.get(ADDRESS, headers={"Accept": accept})
    blind = client.get(ADDRESS + "&blind=true", headers={"Accept": accept})
    assert blind.status_code == 200
    assert blind.headers["etag"] != seen.headers["etag"]
    document = (
        seen.headers["x-phantom-geometry"]
        and client.get(ADDRESS, headers={"Accept": "application/json"}).json()["phantom"][
            "document_sha256"
        ]
    )
    assert document.encode() in seen.content
    for word in (document.encode(), b"sphere", b"material_names", b"projection_matrix"):
        assert word not in blind.content
    assert "x-phantom-geometry" not in blind.headers


def test_an_energy_that_changes_nothing_is_warned_of_only_where_it_was_asked_for(client):
    as_json = {"Accept": "application/json"}
    asked = client.post("/v1/radiographs", json=ball(beam={"energy_kev": 80}), headers=as_json)
    assert any("no effect" in warning for warning in asked.json()["warnings"])
    silent = client.post("/v1/radiographs", json=ball(), headers=as_json)
    assert silent.json()["warnings"] == []
