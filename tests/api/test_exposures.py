"""A detector over HTTP: what it counts, that its noise is the seed's, and what is told of it."""

from __future__ import annotations

import json

import numpy as np
import pytest

ASKED = {
    "phantom": {"name": "sphere", "parameters": {"radius_mm": 20}},
    "detector": {"columns": 101, "rows": 51, "pitch_mm": 1.0},
    "beam": {"energy_kev": 60},
    "acquisition": {
        "detector_air_kerma_ugy": 0.1,
        "detector": {"response": "photon_counting"},
    },
    "noise": {"seed": 8},
}
NUMBERS = {"Accept": "application/x-npy"}


def test_the_signal_counts_the_photons_of_the_dose(client, from_npy):
    found = from_npy(client.post("/v1/radiographs", json=ASKED, headers=NUMBERS).content)
    # NIST: mu_en/rho of dry air is 0.03041 cm2/g at 60 keV; 1 keV/g = 1.602177e-7 uGy.
    photons = 0.1 / (60 * 0.03041 * 1.602177e-7) / 100
    beside = found[:, :15]
    assert beside.mean() == pytest.approx(photons, abs=5 * np.sqrt(photons / beside.size), rel=2e-3)
    assert beside.var() == pytest.approx(photons, rel=5 * np.sqrt(2 / beside.size))
    again = from_npy(client.post("/v1/radiographs", json=ASKED, headers=NUMBERS).content)
    np.testing.assert_array_equal(found, again)
    other = {**ASKED, "noise": {"seed": 9}}
    found_otherwise = from_npy(client.post("/v1/radiographs", json=other, headers=NUMBERS).content)
    assert (found_otherwise != found).mean() > 0.9


def test_an_address_bar_asks_for_the_same(client):
    words = "dose_ugy=1.5&scatter=true&grid=0.7,0.1&focal_spot_mm=0.6&samples=2&seed=9&kvp=60"
    got = client.get(f"/v1/radiographs/sphere?columns=24&{words}")
    body = {
        "phantom": {"name": "sphere"},
        "detector": {"columns": 24},
        "beam": {"kvp": 60},
        "acquisition": {
            "detector_air_kerma_ugy": 1.5,
            "scatter": {},
            "grid": {"primary_transmission": 0.7, "scatter_transmission": 0.1},
            "focal_spot": {"size_mm": [0.6, 0.6]},
            "samples_per_pixel": [2, 2],
        },
        "noise": {"seed": 9},
    }
    posted = client.post("/v1/radiographs", json=body)
    assert got.status_code == posted.status_code == 200
    assert got.headers["etag"] == posted.headers["etag"]
    assert got.content == posted.content


def test_the_answer_tells_dose_and_detector(client):
    headers = {"Accept": "application/json"}
    told = json.loads(client.post("/v1/radiographs", json=ASKED, headers=headers).content)
    assert told["units"]["signal"] == "photons"
    assert told["exposure"]["exposure_index"] == pytest.approx(10.0)
    assert told["noise"]["seed"] == 8
    assert [s["stage"] for s in told["stages"]][-3:] == ["exposure", "quantum_noise", "detector"]
