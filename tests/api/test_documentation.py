"""The service describes itself, without any other network."""

from __future__ import annotations

import re

from fastapi.testclient import TestClient

from api.app import create_app
from api.settings import Settings
from phantom.requests.words import WORDS


def references(node):
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "$ref":
                yield value
            else:
                yield from references(value)
    elif isinstance(node, list):
        for value in node:
            yield from references(value)


def test_the_page_loads_nothing_from_elsewhere(client):
    page = client.get("/docs")
    loaded = re.findall(r'(?:src|href|data-openapi)="([^"]*)"', page.text)
    assert len(loaded) == 5
    for address in loaded:
        assert address.startswith("/"), address
        assert client.get(address).status_code == 200
    policy = page.headers["content-security-policy"]
    assert "script-src 'self';" in policy
    assert "unsafe-eval" not in policy
    assert "<script>" not in page.text


def test_behind_a_proxy_the_page_finds_its_parts():
    page = TestClient(create_app(Settings()), root_path="/xray").get("/docs")
    assert 'src="/xray/docs/start.js"' in page.text
    assert 'data-openapi="/xray/openapi.json"' in page.text


def test_every_reference_of_the_description_is_there(client):
    schema = client.get("/openapi.json").json()
    found = set(references(schema))
    assert found
    for reference in found:
        name = reference.removeprefix("#/components/schemas/")
        assert name in schema["components"]["schemas"], reference


def test_every_body_is_described(client):
    schema = client.get("/openapi.json").json()
    for path, content in schema["paths"].items():
        if "post" in content:
            assert "application/json" in content["post"]["requestBody"]["content"], path
    request = schema["components"]["schemas"]["RadiographRequest"]
    assert request["required"] == ["phantom"], "everything but the phantom has a default"
    own = schema["components"]["schemas"]["OwnPhantom"]["properties"]["document"]
    assert "#/components/schemas/Document" in set(references(own)), "not just any object"


def test_the_words_of_a_query_are_described(client):
    schema = client.get("/openapi.json").json()
    get = schema["paths"]["/v1/radiographs/{name}"]["get"]
    described = {p["name"] for p in get["parameters"]}
    assert set(WORDS) | {"name", "abnormality"} == described


def test_every_call_has_one_address(client):
    routes = set(create_app(Settings()).openapi()["paths"])
    assert routes == {
        "/healthz",
        "/v1/datasets",
        "/v1/documents/validate",
        "/v1/jobs",
        "/v1/jobs/{job}",
        "/v1/jobs/{job}/events",
        "/v1/jobs/{job}/results",
        "/v1/jobs/{job}/results/{name}",
        "/v1/path-lengths",
        "/v1/phantoms",
        "/v1/phantoms/{name}",
        "/v1/phantoms/{name}/document",
        "/v1/radiographs",
        "/v1/radiographs/{name}",
        "/v1/renders",
        "/v1/stereo-pairs",
    }
