"""docs/datasets.md: its design can be made, its table has every field, its programs run."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from phantom import datasets
from phantom.cli import app
from phantom.datasets import read_design
from phantom.datasets.checks import check
from phantom.datasets.design import Design, Outputs

PAGE = (Path(__file__).parents[2] / "docs" / "datasets.md").read_text(encoding="utf-8")
(TEXT,) = re.findall(r"```json\n(.*?)```", PAGE, re.S)


@pytest.fixture
def small(tmp_path, monkeypatch):
    """The page's design, of few people and few pixels, where its commands look for it."""
    tree = json.loads(TEXT) | {"people": 10, "detector": {"columns": 48}}
    (tmp_path / "design.json").write_text(json.dumps(tree))
    monkeypatch.chdir(tmp_path)
    return tree


def test_the_design_can_be_made():
    design = read_design(json.loads(TEXT))
    check(design)
    assert design.images == 1000


def test_every_field_is_listed():
    rows = re.findall(r"^\| (`\w+`(?:, `\w+`)*) \|", PAGE, re.M)
    listed = [name for row in rows for name in re.findall(r"\w+", row)]
    assert sorted(listed) == sorted(Design.model_fields)
    (outputs,) = re.findall(r"^\| `outputs` \| (.*) \|$", PAGE, re.M)
    assert set(Outputs.model_fields) <= set(re.findall(r"`(\w+)`", outputs))


def test_the_dry_run_of_the_page(small):
    lines = re.findall(r"^phantom (dataset design\.json OUT --dry-run)", PAGE, re.M)
    result = CliRunner().invoke(app, lines[0].split(), catch_exceptions=False)
    assert result.exit_code == 0
    assert "20 images of 10 people, 48 × 48 pixels" in result.output
    assert not Path("OUT").exists()


def test_the_stream_of_the_page(small):
    (program,) = re.findall(r"```python\n(from phantom.*?)```", PAGE, re.S)
    scope: dict = {}
    exec(program, scope)
    stream = scope["stream"]
    assert len(stream) == 16
    assert stream[3]["image"].shape == (48, 48)
    assert isinstance(stream, datasets.Stream)


def test_the_quick_set_of_the_page_is_planned(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (line,) = re.findall(r"^phantom (dataset quick \S+ --count 1000 -o knees)", PAGE, re.M)
    words = [*line.split(), "--dry-run", "--side", "32", "--json"]
    result = CliRunner().invoke(app, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["images"] == told["people"] == 1000
    assert 350 < sum(told["abnormal"].values()) < 650
