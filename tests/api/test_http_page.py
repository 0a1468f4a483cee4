"""The examples of docs/http.md do what the page says."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from api.settings import PREFIX, Settings

PAGE = (Path(__file__).parents[2] / "docs" / "http.md").read_text(encoding="utf-8")
CURLS = re.findall(
    r"curl -s http://127\.0\.0\.1:8000(\S+).*?-d '(\{.*?\})'(.*?)(?=```|\ncurl)", PAGE, re.S
)


def test_the_page_has_its_examples():
    assert [address for address, _, _ in CURLS] == [
        "/v1/radiographs",
        "/v1/renders",
        "/v1/stereo-pairs",
        "/v1/path-lengths",
        "/v1/phantoms/step-wedge/document",
    ]


@pytest.mark.parametrize(("address", "body", "rest"), CURLS, ids=[c[0] for c in CURLS])
def test_each_example_is_answered(client, address, body, rest):
    response = client.post(address, json=json.loads(body))
    assert response.status_code == 200
    promised = re.search(r"^# (\{.*\})$", rest, re.M)
    if promised:
        assert response.json() == json.loads(promised[1])
    if address.endswith("/document"):
        assert client.post("/v1/documents/validate", json=response.json()).status_code == 200


def test_the_address_for_a_browser_is_answered(client):
    (address,) = re.findall(r"^    http://127\.0\.0\.1:8000(\S+)$", PAGE, re.M)
    assert client.get(address).headers["content-type"] == "image/png"


def test_the_example_of_an_error_is_what_comes(client):
    (promised,) = (
        json.loads(text) for text in re.findall(r"```json\n(.*?)```", PAGE, re.S) if "type" in text
    )
    request = {
        "phantom": {"name": "sphere", "parameters": {"colour": 1}},
        "detector": {"columns": 0},
    }
    assert client.post("/v1/radiographs", json=request).json() == promised


def test_every_setting_is_listed_with_its_default():
    listed = dict(re.findall(rf"^\| `{PREFIX}(\w+)` \| (\w+) \|", PAGE, re.M))
    defaults = {
        name.upper(): str(field.default or "none") for name, field in Settings.model_fields.items()
    }
    assert listed == defaults


def test_the_python_example_runs(client, monkeypatch):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.S)

    class Answer:
        def __init__(self, request):
            path = request.full_url.removeprefix("http://127.0.0.1:8000")
            headers = dict(request.header_items())
            self.response = client.post(path, content=request.data, headers=headers)

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

        def read(self):
            assert self.response.status_code == 200
            return self.response.content

    monkeypatch.setattr("urllib.request.urlopen", Answer)
    names: dict = {}
    exec(example, names)
    lengths = names["lengths_mm"]
    assert lengths.shape == (100_000, 1)
    assert lengths.max() == pytest.approx(50, abs=1e-6)
