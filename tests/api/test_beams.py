"""A tube over HTTP: the spectrum's image, what is told of it, and what is refused."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from phantom.imaging import Beam
from phantom.materials import attenuation_curve_per_mm, reference

TUBE = {"kvp": 70, "filtration_mm": {"aluminium": 2.5, "copper": 0.1}}


def request(beam: dict[str, Any]) -> dict[str, Any]:
    """A ball of water 40 mm across, seen by three pixels: the middle one through its centre."""
    document = {
        "format": "phantom/1",
        "materials": {"water": {"reference": "water"}},
        "solid": {"type": "sphere", "center": [0, 0, 0], "radius": 20, "material": "water"},
    }
    return {
        "phantom": {"document": document},
        "detector": {"columns": 3, "rows": 1, "pitch_mm": 60},
        "beam": beam,
    }


def test_the_image_is_the_spectrums(client, from_npy):
    headers = {"Accept": "application/x-npy"}
    response = client.post("/v1/radiographs", json=request(TUBE), headers=headers)
    assert response.status_code == 200
    spectrum = Beam(**TUBE).spectrum()
    energies = spectrum.energies_kev
    mu = attenuation_curve_per_mm(reference("water").composition, 1.0, energies)
    signal = spectrum.photons_per_mm2_mas_at_1m * energies
    expected = signal @ np.exp(-mu * 40) / signal.sum()
    np.testing.assert_allclose(from_npy(response.content)[0], [1, expected, 1], rtol=1e-4)


def test_an_address_bar_asks_for_the_same(client):
    document = "/v1/radiographs/sphere?columns=8&kvp=70&filtration=aluminium%3D2.5,copper%3D0.1"
    got = client.get(document)
    body = {"phantom": {"name": "sphere"}, "detector": {"columns": 8}, "beam": TUBE}
    posted = client.post("/v1/radiographs", json=body)
    assert got.status_code == posted.status_code == 200
    assert got.headers["etag"] == posted.headers["etag"]


def test_the_answer_tells_the_half_value_layer(client):
    headers = {"Accept": "application/json"}
    told = json.loads(client.post("/v1/radiographs", json=request(TUBE), headers=headers).content)
    (spectrum,) = (s for s in told["stages"] if s["stage"] == "spectrum")
    assert spectrum["kvp"] == 70
    expected = Beam(**TUBE).spectrum().half_value_layer_mm()
    assert spectrum["half_value_layer_mm_aluminium"] == pytest.approx(expected)
    assert told["beam"] == {"anode": "tungsten", **TUBE}


@pytest.mark.parametrize(
    ("beam", "paths"),
    [
        ({"kvp": 151}, ["/beam/kvp"]),
        ({"kvp": 70, "energy_kev": 60}, ["/beam/kvp"]),
        ({"kvp": 70, "filtration_mm": {"cheese": 1}}, ["/beam/filtration_mm/cheese"]),
        ({"energy_kev": 900}, ["/beam/energy_kev"]),
        ({"kvp": "x", "anode": 3}, ["/beam/anode", "/beam/kvp"]),
    ],
)
def test_what_no_tube_can_do_is_refused(client, beam, paths):
    response = client.post("/v1/radiographs", json=request(beam))
    assert response.status_code == 422
    assert sorted(p["path"] for p in response.json()["problems"]) == paths
