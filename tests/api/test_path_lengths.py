"""What ``/v1/path-lengths`` gives for rays through a ball of radius 10 mm."""

from __future__ import annotations

import numpy as np
import pytest

BALL = {"name": "sphere", "parameters": {"radius_mm": 10}}
ADDRESS = "/v1/path-lengths?phantom=sphere&parameters.radius_mm=10"
NPY = {"Content-Type": "application/x-npy", "Accept": "application/x-npy"}


def test_json_rays(client):
    rays = {"origins": [[-50, 0, 0], [-50, 8, 0], [0, 0, 0], [-50, 11, 0]]}
    directions = [[3, 0, 0], [0.001, 0, 0], [0, 0, -1], [1, 0, 0]]
    response = client.post(
        "/v1/path-lengths", json={"phantom": BALL, "directions": directions, **rays}
    )
    assert response.status_code == 200
    answer = response.json()
    assert answer["material_names"] == ["ball"]
    assert np.array(answer["path_lengths_mm"])[:, 0] == pytest.approx([20, 12, 10, 0])


def test_npy_rays_are_answered_as_npy(client, to_npy, from_npy):
    offset = np.linspace(-12, 12, 2001)
    rays = np.zeros((len(offset), 2, 3))
    rays[:, 0] = np.stack([np.full_like(offset, -40), offset, 0 * offset], axis=1)
    rays[:, 1, 0] = 2.5
    response = client.post(ADDRESS, content=to_npy(rays), headers=NPY)
    lengths = from_npy(response.content)
    assert lengths.dtype == np.float64
    expected = 2 * np.sqrt(np.maximum(100 - offset**2, 0))
    np.testing.assert_allclose(lengths[:, 0], expected, atol=1e-9)
    as_json = client.post(ADDRESS, content=to_npy(rays), headers={**NPY, "Accept": "*/*"}).json()
    np.testing.assert_array_equal(as_json["path_lengths_mm"], lengths)


def test_no_rays_have_no_lengths(client):
    response = client.post(
        "/v1/path-lengths", json={"phantom": BALL, "origins": [], "directions": []}
    )
    assert response.json() == {"material_names": ["ball"], "path_lengths_mm": []}


def test_origins_and_directions_come_in_pairs(client):
    request = {"phantom": BALL, "origins": [[0, 0, 0]], "directions": []}
    response = client.post("/v1/path-lengths", json=request)
    assert response.status_code == 422
    assert [p["path"] for p in response.json()["problems"]] == ["/directions"]


def test_a_ray_needs_a_direction(client):
    request = {"phantom": BALL, "origins": [[0, 0, 0]], "directions": [[0, 0, 0]]}
    response = client.post("/v1/path-lengths", json=request)
    assert response.status_code == 422
    assert response.json()["problems"][0]["path"].startswith("/directions")


def test_npy_files_that_do_not_hold_rays_are_refused(client, to_npy):
    sound = to_npy(np.zeros((3, 2, 3)))
    for content in (
        b"",
        b"\x93NUMPY",
        b"\x93NUMPY\x09\x00" + bytes(64),
        sound[:-1],
        sound + b"0",
        to_npy(np.zeros((3, 2, 3), dtype=np.float32)),
        to_npy(np.zeros((3, 6))),
        to_npy(np.zeros((3, 2, 3), order="F")),
        to_npy(np.array([[[object()] * 3] * 2])),
        sound.replace(b"(3, 2, 3)", b"(-3,2, 3)"),
        sound.replace(b"(3, 2, 3)", b"(9**9,2,3"),
        to_npy(np.full((1, 2, 3), np.nan)),
    ):
        response = client.post(ADDRESS, content=content, headers=NPY)
        assert response.status_code == 422, content[:80]
        assert response.json()["problems"]


def test_more_rays_than_the_limit_are_refused_before_they_are_traced(service, to_npy):
    client = service(max_rays=10)
    response = client.post(ADDRESS, content=to_npy(np.ones((11, 2, 3))), headers=NPY)
    assert response.status_code == 422
    assert response.json()["problems"][0]["kind"] == "too_large"


@pytest.mark.parametrize("query", ["", "?phantom=sphere&phantom=fan", "?phantom=sphere&x=1"])
def test_npy_rays_need_one_phantom_in_the_query(client, to_npy, query):
    content = to_npy(np.ones((1, 2, 3)))
    response = client.post(f"/v1/path-lengths{query}", content=content, headers=NPY)
    assert response.status_code == 422
    assert response.json()["problems"][0]["path"] == "/phantom"
