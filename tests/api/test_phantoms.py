"""The library as the service shows it."""

from __future__ import annotations

from phantom import library


def test_the_list_names_every_phantom(client):
    listed = client.get("/v1/phantoms").json()
    assert [item["name"] for item in listed] == list(library.names())
    assert all(item["title"] and item["summary"] for item in listed)


def test_a_phantom_tells_its_parameters_with_unit_range_and_default(client):
    shown = client.get("/v1/phantoms/sphere").json()
    radius = shown["parameters"]["properties"]["radius_mm"]
    assert (radius["minimum"], radius["default"], radius["maximum"]) == (0.1, 25.0, 200.0)
    assert radius["unit"] == "mm"
    assert shown["views"] == ["ap"]


def test_the_document_is_resolved_with_the_parameters(client):
    response = client.post("/v1/phantoms/sphere/document", json={"radius_mm": 7.5})
    assert response.status_code == 200
    document = response.json()
    assert document["format"] == "phantom/1"
    assert document["solid"]["radius"] == 7.5
    assert document["parameters"]["radius_mm"] == 7.5


def test_bad_parameters_are_listed_with_their_names(client):
    response = client.post("/v1/phantoms/sphere/document", json={"radius_mm": -1, "colour": 1})
    assert response.status_code == 422
    found = {(p["path"], p["kind"]) for p in response.json()["problems"]}
    assert found == {("/radius_mm", "out_of_range"), ("/colour", "unknown_field")}
    assert client.post("/v1/phantoms/sphere/document", json=[]).status_code == 422


def test_an_unknown_phantom_is_not_found_wherever_it_is_the_address(client):
    for response in (
        client.get("/v1/phantoms/nobody"),
        client.post("/v1/phantoms/nobody/document", json={}),
        client.get("/v1/radiographs/nobody"),
    ):
        assert response.status_code == 404
        assert "sphere" in response.json()["detail"], "the names there are"


def test_an_unknown_phantom_in_a_body_is_a_problem_of_that_body(client):
    response = client.post("/v1/radiographs", json={"phantom": {"name": "nobody"}})
    assert response.status_code == 422
    assert [p["path"] for p in response.json()["problems"]] == ["/phantom/name"]
