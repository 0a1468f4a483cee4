"""Bodies that no sound client sends: always a problem document, never a fault of ours."""

from __future__ import annotations

import json

import pytest

CALLS = (
    "/v1/radiographs",
    "/v1/renders",
    "/v1/path-lengths",
    "/v1/documents/validate",
    "/v1/phantoms/sphere/document",
)
JSON = {"Content-Type": "application/json"}

HOSTILE = {
    "empty": b"",
    "not JSON": b"{",
    "not UTF-8": b'{"phantom": "\xff"}',
    "NaN": b'{"phantom": NaN, "solid": {"radius": NaN}, "radius_mm": NaN}',
    "Infinity": b'{"phantom": Infinity, "solid": -Infinity, "radius_mm": Infinity}',
    "1e999": b'{"phantom": 1e999, "solid": [1e999], "radius_mm": -1e999}',
    "lone surrogates": b'{"phantom": {"name": "\\ud800"}, "solid": "\\udc00", "\\ud83d": 1}',
    "an unclosed depth": b"[" * 100_000,
    "depth 1,000": b'{"phantom":' * 1000 + b"0" + b"}" * 1000,
    "depth 250": b'{"solid":' * 250 + b"0" + b"}" * 250,
    "an integer of 5,000 digits": b'{"phantom": %(n)s, "radius_mm": %(n)s}' % {b"n": b"9" * 5000},
    "a repeated key": b'{"phantom": {"name": "sphere"}, "phantom": {}, "a": 1, "a": 2}',
    "a NUL": b'{"phantom": {"name": "\\u0000"}, "a\\u0000": 1}',
    "a list": b"[1, 2, 3]",
    "a number": b"12",
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("body", HOSTILE.values(), ids=HOSTILE.keys())
def test_a_hostile_body_is_a_problem(client, call, body):
    response = client.post(call, content=body, headers=JSON)
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    answer = response.json()
    assert answer["status"] == 422
    assert answer["problems"]
    assert len(response.content) < 20_000, "the input is not echoed"


@pytest.mark.parametrize(
    ("number", "kind"),
    [("NaN", "not_finite"), ("1e999", "not_finite"), ("9" * 5000, "out_of_range")],
)
def test_a_number_that_is_none_is_told_at_its_place(client, number, kind):
    body = f'{{"phantom": {{"name": "sphere"}}, "beam": {{"energy_kev": {number}}}, "x": 1}}'
    response = client.post("/v1/radiographs", content=body, headers=JSON)
    found = [(p["path"], p["kind"]) for p in response.json()["problems"]]
    assert found == [("/beam/energy_kev", kind), ("/x", "unknown_field")]


def test_a_body_over_the_limit_is_refused_declared_or_not(service):
    client = service(max_json_bytes=10_000)
    body = b'{"phantom": {"name": "sphere"}' + b" " * 10_000 + b"}"
    declared = client.post("/v1/radiographs", content=body, headers=JSON)
    chunks = (body[i : i + 1000] for i in range(0, len(body), 1000))
    chunked = client.post("/v1/radiographs", content=chunks, headers=JSON)
    for response in (declared, chunked):
        assert response.status_code == 413
        assert response.headers["content-type"] == "application/problem+json"


def test_a_body_over_the_limit_is_not_read_to_its_end(service):
    read = 0

    def endless():
        nonlocal read
        while read < 1000:
            read += 1
            yield b" " * 1000

    response = service(max_json_bytes=1024).post("/v1/radiographs", content=endless(), headers=JSON)
    assert response.status_code == 413


@pytest.mark.parametrize(
    "headers",
    [
        {"Content-Type": "text/plain"},
        {"Content-Type": "application/x-www-form-urlencoded"},
        {"Content-Type": "application/json", "Content-Encoding": "gzip"},
    ],
)
@pytest.mark.parametrize("call", CALLS)
def test_other_forms_of_body_are_not_taken(client, call, headers):
    response = client.post(call, content=json.dumps({}), headers=headers)
    assert response.status_code == 415
    assert response.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize(
    ("method", "address", "status"),
    [
        ("GET", "/nowhere", 404),
        ("GET", "/v1/radiographs", 405),
        ("DELETE", "/v1/phantoms", 405),
        ("GET", "/v1/radiographs/sphere?columns=99999", 422),
        ("GET", "/v1/radiographs/sphere?view=sideways", 422),
        ("GET", "/v1/radiographs/sphere?colour=red", 422),
        ("GET", "/v1/radiographs/sphere?columns=8&columns=9", 422),
        ("GET", "/v1/radiographs/sphere?columns=NaN", 422),
        ("GET", "/v1/radiographs/sphere?columns=1e999", 422),
        ("GET", "/v1/radiographs/sphere?columns=" + "9" * 5000, 422),
        ("GET", "/v1/radiographs/sphere?view=" + "{" * 5000, 422),
        ("GET", "/v1/radiographs/sphere?view={}", 200),
        ("GET", "/v1/radiographs/sphere?parameters.radius_mm=%ED%A0%80", 422),
        ("GET", "/v1/radiographs/sphere?phantom=fan", 422),
        ("GET", "/v1/radiographs/%00", 404),
        ("GET", "/v1/phantoms/..%2F..%2Fetc%2Fpasswd", 404),
    ],
)
def test_every_refusal_is_a_problem_document(client, method, address, status):
    if status == 200:
        address += "&columns=8"
    response = client.request(method, address)
    assert response.status_code == status
    if status != 200:
        assert response.headers["content-type"] == "application/problem+json"
        assert response.json()["status"] == status
        assert response.json()["title"]


def test_all_problems_of_a_query_are_told_at_once(client):
    response = client.get(
        "/v1/radiographs/sphere?colour=red&columns=0&parameters.radius_mm=-1&energy_kev=0.5"
    )
    paths = {p["path"] for p in response.json()["problems"]}
    assert paths == {
        "/colour",
        "/detector/columns",
        "/phantom/parameters/radius_mm",
        "/beam/energy_kev",
    }


def test_too_many_pixels_are_refused_before_anything_is_allocated(service):
    client = service(max_pixels=100 * 100, max_result_bytes=2**20)
    request = {"phantom": {"name": "sphere"}, "detector": {"columns": 101, "rows": 100}}
    response = client.post("/v1/radiographs", json=request)
    assert [(p["path"], p["kind"]) for p in response.json()["problems"]] == [
        ("/detector", "too_large")
    ]


def test_a_fault_of_ours_is_logged_and_not_echoed(client, monkeypatch, caplog):
    def fail(*_, **__):
        raise RuntimeError("secret of the engine")

    monkeypatch.setattr("api.routes.radiographs.plan", fail)
    response = client.post("/v1/radiographs", json={"phantom": {"name": "sphere"}})
    assert response.status_code == 500
    assert response.headers["content-type"] == "application/problem+json"
    assert "secret" not in response.text
    assert "secret of the engine" in caplog.text
