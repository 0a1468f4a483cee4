"""What ``/v1/documents/validate`` says of sound and of broken documents."""

from __future__ import annotations

import math

import pytest


def document(solid, **materials):
    return {"format": "phantom/1", "name": "test", "materials": materials, "solid": solid}


BALL = {"type": "sphere", "center": [1, 2, 3], "radius": 10, "material": "a", "name": "ball"}
BOX = {"type": "box", "center": [40, 0, 0], "size": [4, 5, 6], "material": "b", "name": "box"}


def test_a_sound_document_is_measured(client):
    both = document(
        {"type": "union", "solids": [BALL, BOX]},
        a={"reference": "water", "density_g_cm3": 1.5},
        b={"composition": {"Al": 1.0}, "density_g_cm3": 2.7},
    )
    response = client.post("/v1/documents/validate", json=both)
    assert response.status_code == 200
    summary = response.json()
    ball, box = 4 / 3 * math.pi * 1000, 120
    assert summary["volume_mm3"] == pytest.approx(ball + box, rel=1e-3)
    assert summary["materials"][0]["volume_mm3"] == pytest.approx(ball, rel=1e-3)
    assert summary["materials"][1]["mass_g"] == pytest.approx(0.12 * 2.7, rel=1e-3)
    assert summary["mass_g"] == pytest.approx((ball * 1.5 + box * 2.7) / 1000, rel=1e-3)
    assert summary["volume_relative_error"] <= 1e-3
    leaves = {leaf["label"]: leaf for leaf in summary["leaves"]}
    assert leaves["ball"]["material"] == "a"
    assert leaves["ball"]["bounds_mm"] == [[-9, -8, -7], [11, 12, 13]]
    assert summary["bounds_mm"] == [[-9, -8, -7], [42, 12, 13]]


def test_a_material_without_density_leaves_the_mass_unknown(client):
    fixed = document(BALL, a={"attenuation_per_mm": 0.05})
    summary = client.post("/v1/documents/validate", json=fixed).json()
    assert summary["mass_g"] is None
    assert summary["materials"][0]["mass_g"] is None
    spare = document(BALL, a={"reference": "water"}, unused={"attenuation_per_mm": 0.05})
    summary = client.post("/v1/documents/validate", json=spare).json()
    assert summary["mass_g"] == pytest.approx(4 / 3 * math.pi, rel=1e-3), "unused is not present"


def test_every_problem_is_listed_with_its_place_in_the_document(client):
    broken = document(BALL | {"radius": -1, "colour": "red"}, a={"reference": "cheese"})
    response = client.post("/v1/documents/validate", json=broken | {"extra": 1})
    assert response.status_code == 422
    paths = {p["path"] for p in response.json()["problems"]}
    assert paths == {"/extra", "/materials/a/reference", "/solid/colour", "/solid/radius"}


@pytest.mark.parametrize("body", ["[]", "3", '"text"', "null", "{}"])
def test_what_is_no_document_is_a_problem_too(client, body):
    response = client.post(
        "/v1/documents/validate", content=body, headers={"Content-Type": "application/json"}
    )
    assert response.status_code == 422
    assert response.json()["problems"]
