"""Who may call, and what an answer may do in a browser."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from api.settings import Settings
from phantom.errors import InvalidInputError

KEY = "a-key-of-sixteen-or-more"


@pytest.mark.parametrize(
    "headers",
    [{"Authorization": f"Bearer {KEY}"}, {"authorization": f"bearer {KEY}"}, {"X-API-Key": KEY}],
)
def test_with_its_key_the_service_answers(service, headers):
    assert service(api_key=KEY).get("/v1/phantoms", headers=headers).status_code == 200


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"Authorization": "Bearer"},
        {"Authorization": f"Basic {KEY}"},
        {"Authorization": f"Bearer {KEY}x"},
        {"X-API-Key": KEY[:-1]},
        {"X-API-Key": "ключ".encode()},
        {"Authorization": f"Bearer {KEY[:-1]}é".encode("latin-1")},
    ],
)
@pytest.mark.parametrize("path", ["/v1/phantoms", "/v1/radiographs/sphere", "/nowhere", "/"])
def test_without_the_key_nothing_is_told(service, headers, path):
    response = service(api_key=KEY).get(path, headers=headers)
    assert response.status_code == 401
    assert response.headers["www-authenticate"] == "Bearer"
    assert response.headers["content-type"] == "application/problem+json"


def test_health_and_documentation_need_no_key(service):
    client = service(api_key=KEY)
    for path in ("/healthz", "/docs", "/docs/start.js", "/openapi.json"):
        assert client.get(path).status_code == 200
    schema = client.get("/openapi.json").json()
    assert schema["security"] == [{"key": []}]


def test_what_a_key_protects_is_not_kept_by_shared_caches(service):
    address = "/v1/radiographs/sphere?columns=4"
    guarded = service(api_key=KEY).get(address, headers={"X-API-Key": KEY})
    assert "private" in guarded.headers["cache-control"]
    assert "public" in service().get(address).headers["cache-control"]


def test_answers_are_never_run_nor_framed(client):
    for path in ("/v1/phantoms", "/healthz", "/nowhere"):
        headers = client.get(path).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert "default-src 'none'" in headers["content-security-policy"]
        assert "frame-ancestors 'none'" in headers["content-security-policy"]


def test_a_weak_key_is_refused():
    with pytest.raises(ValidationError):
        Settings(api_key="short")


def test_settings_come_from_the_environment():
    environment = {"PHANTOM_MAX_PIXELS": "5000", "PHANTOM_API_KEY": KEY, "PATH": "/bin"}
    settings = Settings.from_environment(environment)
    assert (settings.max_pixels, settings.api_key) == (5000, KEY)
    with pytest.raises(InvalidInputError) as refusal:
        Settings.from_environment({"PHANTOM_RENDERS": "many", "PHANTOM_API_KEY": "secret"})
    assert {p.path for p in refusal.value.problems} == {"PHANTOM_RENDERS", "PHANTOM_API_KEY"}
    assert "secret" not in str(refusal.value)
