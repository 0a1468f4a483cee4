"""``/v1/renders`` in the styles preview and wireframe."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest

import phantom

SVG = {"Accept": "image/svg+xml"}
NPY = {"Accept": "application/x-npy"}


def fan(**fields: Any) -> dict[str, Any]:
    camera = {"preset": "front", "columns": 48}
    return {"phantom": {"name": "fan"}, "camera": camera, **fields}


def test_each_style_is_what_the_library_makes(client: Any) -> None:
    shape = phantom.library.build("fan")
    camera = phantom.CameraPreset(preset="front", columns=48, rows=48)
    answers = {
        style: client.post("/v1/renders", json=fan(style=style), headers=NPY)
        for style in ("preview", "wireframe")
    }
    expected = {
        "preview": phantom.preview(shape, camera),
        "wireframe": phantom.wireframe(shape, camera),
    }
    for style, answer in answers.items():
        assert answer.status_code == 200
        found = np.load(io.BytesIO(answer.content))
        np.testing.assert_array_equal(found, expected[style].rgb.astype(np.float32))
    assert answers["preview"].headers["ETag"] != answers["wireframe"].headers["ETag"]


def test_a_wireframe_may_be_an_svg_and_nothing_else_may(client: Any) -> None:
    asked = fan(style="wireframe", hidden_lines=False, rings=6)
    answer = client.post("/v1/renders", json=asked, headers=SVG)
    assert answer.status_code == 200
    assert answer.headers["Content-Type"].startswith("image/svg+xml")
    assert answer.content.startswith(b"<?xml")
    refused = client.post("/v1/renders", json=fan(style="shaded"), headers=SVG)
    assert refused.status_code == 422
    assert [p["path"] for p in refused.json()["problems"]] == ["/quantity"]


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"style": "sketch"}, "/style"),
        ({"style": "shaded", "rings": 9}, "/rings"),
        ({"style": "wireframe", "lighting": {}}, "/lighting"),
        ({"style": "wireframe", "samples_per_pixel": 2}, "/samples_per_pixel"),
        ({"style": "preview", "lighting": {"shadows": True}}, "/lighting/shadows"),
        ({"style": "preview", "tolerance_mm": 1e-9}, "/tolerance_mm"),
        ({"tolerance_mm": 0.1}, "/tolerance_mm"),
    ],
)
def test_what_has_no_effect_in_a_style_is_refused(client: Any, fields: Any, path: str) -> None:
    answer = client.post("/v1/renders", json=fan(**fields), headers=NPY)
    assert answer.status_code == 422
    assert [p["path"] for p in answer.json()["problems"]] == [path]
