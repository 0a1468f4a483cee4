"""Data sets over HTTP: one job a key, how it goes, its files, its end, and a restart."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from fastapi.testclient import TestClient

from api import jobs as api_jobs
from api.app import create_app
from api.settings import Settings
from phantom.datasets import Run, make
from phantom.datasets.ledger import HaltedError

DESIGN = {
    "phantom": {"name": "sphere"},
    "people": 4,
    "splits": {"train": 1.0},
    "detector": {"columns": 32},
}


@pytest.fixture
def idle(tmp_path, monkeypatch):
    """A service that takes jobs and works at none."""
    monkeypatch.setattr(api_jobs.Jobs, "_begin_thread", lambda self: None)
    with TestClient(create_app(Settings(jobs_folder=tmp_path / "jobs"))) as client:
        yield client


def _post(client, design=None, key=None):
    headers = {} if key is None else {"Idempotency-Key": key}
    return client.post("/v1/datasets", json=DESIGN if design is None else design, headers=headers)


def _until_over(client, place, patience_s=120.0):
    until = time.monotonic() + patience_s
    while time.monotonic() < until:
        job = client.get(place).json()
        if job["state"] in ("done", "failed", "cancelled"):
            return job
        time.sleep(0.1)
    raise AssertionError(job)


def test_a_set_is_made_as_the_command_line_makes_it(tmp_path):
    folder = tmp_path / "jobs"
    with TestClient(create_app(Settings(jobs_folder=folder))) as client:
        answer = _post(client)
        assert answer.status_code == 202
        place = answer.headers["location"]
        assert place == f"/v1/jobs/{answer.json()['id']}"
        events = client.get(f"{place}/events").text
        steps = [json.loads(x[6:]) for x in events.splitlines() if x.startswith("data: ")]
        assert steps[-1]["state"] == "done"
        assert [step["done"] for step in steps] == sorted(step["done"] for step in steps)
        job = client.get(place).json()
        assert (job["state"], job["images"], job["done"], job["set_aside"]) == ("done", 4, 4, 0)
        files = client.get(f"{place}/results").json()
        make(DESIGN, tmp_path / "set", Run(workers=1))
        own = {p.relative_to(tmp_path / "set").as_posix(): p for p in (tmp_path / "set").rglob("*")}
        assert [file["name"] for file in files] == sorted(n for n, p in own.items() if p.is_file())
        for file in files:
            data = client.get(f"{place}/{file['href']}").content
            assert len(data) == file["bytes"]
            assert hashlib.sha256(data).digest() == (
                hashlib.sha256(own[file["name"]].read_bytes()).digest()
            )
        assert client.delete(place).json()["state"] == "done"
        assert client.get(place).status_code == 404
        assert not (folder / job["id"]).exists()


def test_one_key_posted_fifty_times_at_once_is_one_job(idle):
    with ThreadPoolExecutor(50) as pool:
        answers = list(pool.map(lambda _: _post(idle, key="the-key"), range(50)))
    assert {answer.status_code for answer in answers} == {202}
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert len(idle.get("/v1/jobs").json()) == 1


def test_a_key_with_another_body_is_refused(idle):
    assert _post(idle, key="k").status_code == 202
    # The same tree in another order is the same body.
    assert _post(idle, dict(reversed(DESIGN.items())), key="k").status_code == 202
    refused = _post(idle, {**DESIGN, "people": 5}, key="k")
    assert refused.status_code == 422
    assert "another body" in refused.json()["detail"]
    assert _post(idle, {**DESIGN, "people": 5}, key="l").status_code == 202
    assert _post(idle, key="a b").status_code == 422


def test_without_a_key_each_call_is_a_job(idle):
    assert _post(idle).json()["id"] != _post(idle).json()["id"]
    assert len(idle.get("/v1/jobs").json()) == 2


def test_bad_designs_are_refused_with_their_problems(idle):
    wrong = {**DESIGN, "splits": {"train": 0.5}, "twins": True}
    answer = _post(idle, wrong)
    assert answer.status_code == 422
    assert {p["path"] for p in answer.json()["problems"]} == {"/splits", "/twins"}
    answer = _post(idle, {**DESIGN, "people": 2_000_000})
    assert [p["path"] for p in answer.json()["problems"]] == ["/people"]
    assert _post(idle, {**DESIGN, "detector": {"columns": 9000}}).status_code == 422
    assert _post(idle, []).status_code == 422
    assert idle.get("/v1/jobs").json() == []


def test_a_set_for_which_there_is_no_room_is_507(tmp_path, monkeypatch):
    monkeypatch.setattr(api_jobs.Jobs, "_begin_thread", lambda self: None)
    settings = Settings(jobs_folder=tmp_path / "jobs", jobs_max_bytes=100_000)
    with TestClient(create_app(settings)) as client:
        assert _post(client).status_code == 202
        full = _post(client)
        assert full.status_code == 507
        assert "delete some of them" in full.json()["detail"]
    none = shutil.disk_usage(tmp_path)._replace(free=1000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: none)
    with TestClient(create_app(Settings(jobs_folder=tmp_path / "more"))) as client:
        assert _post(client).status_code == 507


def test_a_job_without_room_waits_and_goes_on(tmp_path, monkeypatch):
    monkeypatch.setattr(api_jobs, "ROOM_S", 0.5)
    full, real = [True], api_jobs.make

    def making(*args, **given):
        if full[0]:
            raise api_jobs.DiskFullError("no room is left: for the test")
        return real(*args, **given)

    monkeypatch.setattr(api_jobs, "make", making)
    with TestClient(create_app(Settings(jobs_folder=tmp_path / "jobs"))) as client:
        place = _post(client).headers["location"]
        until = time.monotonic() + 30
        while client.get(place).json()["state"] != "out_of_space":
            assert time.monotonic() < until
            time.sleep(0.05)
        assert client.get(f"{place}/results").status_code == 507
        full[0] = False
        assert _until_over(client, place)["state"] == "done"
        assert client.get(f"{place}/results").status_code == 200


def test_a_job_whose_drive_fails_says_so(tmp_path, monkeypatch):
    def making(*args, **given):
        raise HaltedError("the ledger cannot be written: the drive is gone")

    monkeypatch.setattr(api_jobs, "make", making)
    with TestClient(create_app(Settings(jobs_folder=tmp_path / "jobs"))) as client:
        job = _until_over(client, _post(client).headers["location"])
    assert (job["state"], job["problem"]) == (
        "failed",
        "the ledger cannot be written: the drive is gone",
    )


@pytest.fixture
def held(monkeypatch):
    """Making that stands still after three images until it is told to stop."""
    real = api_jobs.make

    def making(*args, progress, cancelled, **given):
        def told(counts):
            progress(counts)
            while counts.done >= 3 and not cancelled():
                time.sleep(0.01)

        return real(*args, progress=told, cancelled=cancelled, **given)

    with monkeypatch.context() as patch:
        patch.setattr(api_jobs, "LOOK_S", 0.0)
        patch.setattr(api_jobs, "make", making)
        yield patch


def _until_three(client, place):
    until = time.monotonic() + 120
    while client.get(place).json()["done"] < 3:
        assert time.monotonic() < until
        time.sleep(0.05)


def test_a_job_outlives_a_restart_of_the_service(tmp_path, held):
    settings = Settings(jobs_folder=tmp_path / "jobs")
    with TestClient(create_app(settings)) as client:
        place = _post(client, {**DESIGN, "people": 60}).headers["location"]
        _until_three(client, place)
    with TestClient(create_app(settings)) as client:
        _until_three(client, place)
        before = client.get(place).json()
        assert before["state"] == "running"
        assert before["done"] >= 3
    held.undo()
    with TestClient(create_app(settings)) as client:
        job = _until_over(client, place)
        assert (job["state"], job["done"]) == ("done", 60)


def test_a_cancelled_job_stops_and_another_delete_forgets_it(tmp_path, held):
    with TestClient(create_app(Settings(jobs_folder=tmp_path / "jobs"))) as client:
        place = _post(client, {**DESIGN, "people": 60}).headers["location"]
        _until_three(client, place)
        assert client.delete(place).json()["state"] == "cancelled"
        time.sleep(1.0)
        assert client.get(place).json()["state"] == "cancelled"
        assert client.delete(place).status_code == 200
        assert client.get(place).status_code == 404


def test_old_jobs_are_forgotten(idle, tmp_path, monkeypatch):
    place = _post(idle).headers["location"]
    idle.delete(place)
    now = time.time()
    monkeypatch.setattr(api_jobs.time, "time", lambda: now + 169 * 3600)
    _post(idle)
    assert idle.get(place).status_code == 404


@pytest.mark.parametrize(
    "name",
    [
        "../jobs.sqlite",
        "..%2fjobs.sqlite",
        "%2e%2e/jobs.sqlite",
        "train/../../jobs.sqlite",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "link",
        ".phantom/design.json",
        "",
        "a" * 5000,
        "%00",
    ],
)
def test_no_name_leads_out_of_a_set(idle, tmp_path, name):
    job = _post(idle).json()["id"]
    folder = tmp_path / "jobs" / job
    (folder / ".phantom").mkdir(parents=True)
    (folder / ".phantom" / "design.json").write_text("{}")
    (folder / "link").symlink_to("/etc/passwd")
    answer = idle.get(f"/v1/jobs/{job}/results/{name}")
    assert answer.status_code in (404, 200 if name == "" else 404)


def test_there_is_no_job_that_nobody_made(idle):
    for call in ("/v1/jobs/x", "/v1/jobs/x/results", "/v1/jobs/x/events", "/v1/jobs/x/results/y"):
        assert idle.get(call).status_code == 404
    assert idle.delete("/v1/jobs/x").status_code == 404
