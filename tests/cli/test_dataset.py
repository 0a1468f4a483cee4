"""``phantom dataset``: one word or none before the design, parts, and the problems HTTP lists."""

from __future__ import annotations

import json

import pytest
from fastapi.testclient import TestClient
from typer.testing import CliRunner

from api.app import create_app
from api.settings import Settings
from phantom.cli import app

DESIGN = {
    "phantom": {"name": "sphere"},
    "people": 4,
    "splits": {"train": 1.0},
    "detector": {"columns": 24},
}


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "design.json").write_text(json.dumps(DESIGN))
    return lambda *words: CliRunner().invoke(app, ["dataset", *words], catch_exceptions=False)


def test_a_design_needs_no_word_before_it_and_is_made_once(run, tmp_path):
    made = run("design.json", "set", "--workers", "1", "--json")
    assert made.exit_code == 0, made.output
    assert json.loads(made.stdout) == {
        "output": "set",
        "images": 4,
        "bytes": sum(p.stat().st_size for p in (tmp_path / "set").rglob("*") if p.is_file())
        - (tmp_path / "set" / "manifest.sha256").stat().st_size,
        "set_aside": [],
    }
    again = run("make", "design.json", "set")
    assert again.exit_code == 0
    assert "made 4 images" in again.stderr


def test_parts_of_a_job_array_are_merged(run, monkeypatch):
    for number in range(2):
        for name, value in (("ID", number + 3), ("MIN", 3), ("COUNT", 2)):
            monkeypatch.setenv(f"SLURM_ARRAY_TASK_{name}", str(value))
        part = run("design.json", "set", "--shard", "slurm", "--workers", "1")
        assert part.exit_code == 0, part.output
        assert f"made part {number} of 2: 2 images" in part.stderr
    assert run("merge", "set").exit_code == 0


@pytest.mark.parametrize("shard", ["4/4", "-1/4", "1", "a/b", "slurm"])
def test_a_part_that_cannot_be_is_refused(run, shard):
    refused = run("design.json", "set", "--shard", shard)
    assert refused.exit_code == 2
    assert refused.stderr.startswith("/shard: ")


def test_a_design_has_the_same_problems_as_over_http(run, tmp_path):
    wrong = {**DESIGN, "splits": {"train": 0.5}, "twins": True, "vary": {"kvp": 900}}
    (tmp_path / "wrong.json").write_text(json.dumps(wrong))
    refused = run("wrong.json", "set", "--json")
    assert refused.exit_code == 2
    with TestClient(create_app(Settings(jobs_folder=tmp_path / "jobs"))) as client:
        answer = client.post("/v1/datasets", json=wrong)
    assert json.loads(refused.stderr)["problems"] == answer.json()["problems"]
    assert not (tmp_path / "set").exists()


def test_a_cluster_that_is_not_there_is_told(run, monkeypatch):
    from phantom.datasets import cluster

    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    refused = run("design.json", "set", "--scheduler", "tcp://127.0.0.1:9")
    assert refused.exit_code == 2
    assert refused.stderr.startswith("/scheduler: ")


def test_quick_says_what_it_chose(run):
    planned = run("quick", "knee-1993", "--count", "20", "-o", "set", "--dry-run", "--side", "24")
    assert planned.exit_code == 0
    assert planned.stderr.startswith("chosen: side=24 seed=0 splits=train,validation,test drawn=")
    assert planned.stdout.startswith("20 images of 20 people, 24 × 24 pixels")
