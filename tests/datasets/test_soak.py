"""Long runs: a set that is killed a hundred times, a cluster, a drive that fills twenty times.

``uv run pytest -n 0 -m nightly tests/datasets/test_soak.py -s`` tells figures as it goes.
"""

from __future__ import annotations

import hashlib
import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from phantom.datasets import Part, Run, make, merge
from phantom.datasets.names import MANIFEST, STATE
from phantom.errors import PhantomError

pytestmark = pytest.mark.nightly

KILLS = int(os.environ.get("SOAK_KILLS", "100"))
IMAGES = int(os.environ.get("SOAK_IMAGES", "200"))
FULL_DRIVES = 20

COMMAND = [sys.executable, "-c", "from phantom.cli import main; main()", "dataset"]


@pytest.fixture(scope="module")
def knees(design):
    """Small pictures of knees that all differ."""
    drawn = {"type": "uniform", "low": 2.0, "high": 10.0}
    return design(
        phantom={"name": "knee-1993", "parameters": {"valgus_deg": drawn}},
        people=IMAGES,
        detector={"columns": 64},
    )


@pytest.fixture(scope="module")
def undisturbed(knees, tmp_path_factory):
    """The set, made by one worker in one go."""
    folder = tmp_path_factory.mktemp("undisturbed") / "set"
    begun = time.monotonic()
    made = make(knees, folder, Run(workers=1))
    print(f"undisturbed: {made.images} images in {time.monotonic() - begun:.0f} s")
    return folder


@pytest.fixture(scope="module")
def expected(undisturbed):
    """Name to hash of every file of the set."""
    lines = (undisturbed / MANIFEST).read_text().splitlines()
    return dict(reversed(line.split("  ")) for line in lines)


def _acknowledged(folder: Path) -> set[int]:
    """Numbers of the images that the ledger says are done."""
    path = folder / STATE / "ledger-00000-of-00001.sqlite"
    if not path.exists():
        return set()
    file = sqlite3.connect(path)
    try:
        return {n for (n,) in file.execute("SELECT number FROM image WHERE state = 'done'")}
    except sqlite3.OperationalError:  # killed before it had its tables
        return set()
    finally:
        file.close()


def _check(folder: Path, expected: dict[str, str], done: set[int]) -> int:
    """Assert that what is there is as it should be, and all that was acknowledged is there."""
    there = 0
    for path in folder.rglob("*"):
        name = path.relative_to(folder)
        if path.is_file() and name.parts[0] != STATE and str(name) != MANIFEST:
            assert hashlib.sha256(path.read_bytes()).hexdigest() == expected[str(name)], name
            there += 1
    for number in done:
        assert any(
            (folder / s / f"{number:08d}.png").exists() for s in ("train", "validation", "test")
        )
    return there


def _design_file(design, folder: Path) -> Path:
    path = folder / "design.json"
    path.write_text(json.dumps(design.tree()))
    return path


def test_a_set_killed_a_hundred_times_is_the_undisturbed_one(
    knees, undisturbed, expected, tmp_path
):
    chance = random.Random(20261122)
    file = _design_file(knees, tmp_path)
    kills = finished = lost = 0
    number, done = 0, set[int]()
    folder = tmp_path / "set-0"
    begun = time.monotonic()
    while kills < KILLS or not (folder / MANIFEST).exists():
        process = subprocess.Popen(
            [*COMMAND, str(file), str(folder), "--workers", "2"],
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        if kills < KILLS:
            try:
                process.wait(timeout=chance.uniform(0.0, 12.0))
            except subprocess.TimeoutExpired:
                workers = _children(process.pid) if chance.random() < 0.5 else []
                process.kill()
                for worker in workers:
                    os.kill(worker, signal.SIGKILL)
                kills += 1
        process.wait()
        process.stderr.close()
        now = _acknowledged(folder)
        if (folder / MANIFEST).exists():
            finished += 1
            assert (folder / MANIFEST).read_bytes() == (undisturbed / MANIFEST).read_bytes()
            _check(folder, expected, set())
            if kills < KILLS:  # it was quicker than we are: another one
                number, done = number + 1, set()
                folder = tmp_path / f"set-{number}"
            continue
        lost += len(done - now)
        assert lost == 0
        done = now
        _check(folder, expected, done)
    seconds = time.monotonic() - begun
    print(f"{kills} kills in {seconds:.0f} s, {finished} sets finished, {lost} images lost")
    assert kills == KILLS


def _children(parent: int) -> list[int]:
    try:
        text = Path(f"/proc/{parent}/task/{parent}/children").read_text()
    except OSError:
        return []
    return [int(word) for word in text.split()]


def test_everyone_gives_the_same_bytes(knees, undisturbed, tmp_path, content):
    wanted = content(undisturbed)
    make(knees, tmp_path / "two", Run(workers=2))
    assert content(tmp_path / "two") == wanted
    for part in range(4):
        make(knees, tmp_path / "four", Run(Part(part, 4), workers=2))
    merge(tmp_path / "four")
    assert content(tmp_path / "four") == wanted
    with _cluster(tmp_path) as address:
        make(knees, tmp_path / "cluster", Run(scheduler=address))
    assert content(tmp_path / "cluster") == wanted
    print("2 workers, 4 shards merged, a cluster of 2 processes: the same bytes as 1 worker")


def test_a_scheduler_that_is_killed_is_survived_by_a_resume(
    knees, undisturbed, expected, tmp_path, content
):
    folder = tmp_path / "set"

    def progress(counts):
        if counts.done >= IMAGES // 4:
            _cluster.scheduler.kill()

    with _cluster(tmp_path) as address:
        run = Run(scheduler=address)
        with pytest.raises(PhantomError, match="went away"):
            make(knees, folder, run, progress=progress)
    done = _acknowledged(folder)
    assert IMAGES // 4 <= len(done) < IMAGES
    _check(folder, expected, done)
    with _cluster(tmp_path) as address:
        make(knees, folder, Run(scheduler=address))
    assert content(folder) == content(undisturbed)
    print(f"the scheduler was killed after {len(done)} images; the resume made the rest")


class _cluster:  # noqa: N801
    """A scheduler and two workers of dask.distributed, as programs."""

    scheduler: subprocess.Popen

    def __init__(self, folder: Path) -> None:
        self._file = folder / f"scheduler-{time.monotonic_ns()}.json"
        self._workers: list[subprocess.Popen] = []

    def __enter__(self) -> str:
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        common = ["--no-dashboard", "--scheduler-file", str(self._file)]
        module = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
        type(self).scheduler = subprocess.Popen([*module, "--port", "0", *common], **quiet)
        while not self._file.exists() or not self._file.read_text():
            assert self.scheduler.poll() is None
            time.sleep(0.2)
        module = [sys.executable, "-m", "distributed.cli.dask_worker"]
        alone = ["--nthreads", "1", "--no-nanny"]
        self._workers = [subprocess.Popen([*module, *alone, *common], **quiet) for _ in range(2)]
        return str(json.loads(self._file.read_text())["address"])

    def __exit__(self, *_: object) -> None:
        for process in (*self._workers, self.scheduler):
            process.kill()
            process.wait()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="mounting needs root")
def test_a_drive_that_fills_leaves_what_is_finished_and_room_lets_it_go_on(design, tmp_path):
    drawn = {"type": "uniform", "low": 5.0, "high": 20.0}
    wanted = design(
        phantom={"name": "sphere", "parameters": {"radius_mm": drawn}},
        people=20,
        detector={"columns": 128},
    )
    make(wanted, tmp_path / "plain", Run(workers=2))
    manifest = (tmp_path / "plain" / MANIFEST).read_bytes()
    lines = manifest.decode().splitlines()
    expected = dict(reversed(line.split("  ")) for line in lines)
    file, mount = _design_file(wanted, tmp_path), tmp_path / "drive"
    mount.mkdir()
    kept = []
    for step in range(FULL_DRIVES):
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", str(mount)], check=True)
        try:
            folder, command = mount / "set", [*COMMAND, str(file), str(mount / "set")]
            first = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
            ledger = folder / STATE / "ledger-00000-of-00001.sqlite"
            while first.poll() is None and (
                not ledger.exists() or len(_acknowledged(folder)) < step
            ):
                time.sleep(0.005)
            _fill(mount / "of-others")
            _, said = first.communicate()
            if first.returncode:
                assert first.returncode == 1, said
                assert "no room is left" in said
            done = _acknowledged(folder)
            _check(folder, expected, done)
            kept.append((first.returncode, len(done)))
            (mount / "of-others").unlink()
            again = subprocess.run(command, capture_output=True, text=True)
            assert again.returncode == 0, again.stderr
            assert (folder / MANIFEST).read_bytes() == manifest
            _check(folder, expected, set())
        finally:
            subprocess.run(["umount", str(mount)], check=True)
    print("status and images kept when the drive was full:", kept)
    assert sum(status == 1 for status, _ in kept) >= FULL_DRIVES - 2


def _fill(path: Path) -> None:
    """Write until nothing more fits."""
    with path.open("wb", buffering=0) as stream:
        for size in (65_536, 4096, 1):
            with suppress(OSError):
                while True:
                    stream.write(b"x" * size)
