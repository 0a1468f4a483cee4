"""A set in an object store: by several workers, cut short and resumed, merged: the same bytes.

``uv run --with s3fs --with moto[server] pytest -n 0 -m compare tests/compare/test_object_store.py``

Moto answers as S3 does, over HTTP, so that workers, which are other processes, reach it.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

from phantom.datasets import Part, Run, make, merge, read_design
from phantom.errors import CancelledError, InvalidInputError

pytestmark = [
    pytest.mark.compare,
    pytest.mark.filterwarnings("ignore"),
]

s3fs = pytest.importorskip("s3fs")
server = pytest.importorskip("moto.server")

DESIGN = read_design(
    {
        "phantom": {
            "name": "sphere",
            "parameters": {"radius_mm": {"type": "uniform", "low": 5.0, "high": 20.0}},
        },
        "people": 12,
        "detector": {"columns": 32},
        "seed": 3,
    }
)


@pytest.fixture(scope="module", autouse=True)
def environment():
    """What processes need to see our own packages, and the store of the test."""
    with pytest.MonkeyPatch.context() as patch:
        root = str(Path(__file__).parents[2])
        patch.setenv("PYTHONPATH", os.pathsep.join([root, os.environ.get("PYTHONPATH", "")]))
        yield patch


@pytest.fixture(scope="module")
def store(environment):
    """Files of a store on this machine, with one bucket."""
    answering = server.ThreadedMotoServer(port=0, verbose=False)
    answering.start()
    host, port = answering.get_host_and_port()
    environment.setenv("AWS_ENDPOINT_URL", f"http://{host}:{port}")
    environment.setenv("AWS_ACCESS_KEY_ID", "of-the-test")
    environment.setenv("AWS_SECRET_ACCESS_KEY", "of-the-test")
    environment.setenv("AWS_DEFAULT_REGION", "us-east-1")
    files = s3fs.S3FileSystem()
    files.mkdir("bucket")
    yield files
    answering.stop()


@pytest.fixture(scope="module")
def wanted(tmp_path_factory):
    """The content of every file of the set, as one worker makes it in a folder."""
    return _made(tmp_path_factory, DESIGN)


def _made(tmp_path_factory, design):
    folder = tmp_path_factory.mktemp("folder") / "set"
    make(design, folder, Run(workers=1))
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def _kept(store, name):
    store.invalidate_cache()
    root = f"bucket/{name}"
    return {path.removeprefix(f"{root}/"): store.cat_file(path) for path in store.find(root)}


def test_two_workers_write_what_one_writes_in_a_folder(store, wanted, tmp_path):
    made = make(DESIGN, "s3://bucket/two", Run(workers=2, ledger=tmp_path / "ledger"))
    assert made.images == 12
    assert _kept(store, "two") == wanted
    assert not (tmp_path / "ledger").exists()


def test_a_run_that_was_cut_short_goes_on(store, wanted, tmp_path):
    run, seen = Run(workers=2, ledger=tmp_path / "ledger"), []
    with pytest.raises(CancelledError):
        make(
            DESIGN,
            "s3://bucket/cut",
            run,
            progress=lambda counts: seen.append(counts.done),
            cancelled=lambda: seen[-1] >= 4,
        )
    pictures = [name for name in _kept(store, "cut") if name.endswith(".mask.png")]
    assert len(pictures) >= 4
    store.rm_file(f"bucket/cut/{pictures[0]}")
    before = len(seen)
    make(DESIGN, "s3://bucket/cut", run, progress=lambda counts: seen.append(counts.done))
    assert seen[before] >= 3, "all but what was lost is kept"
    assert _kept(store, "cut") == wanted


def test_parts_merge_there(store, wanted, tmp_path):
    for number in (1, 0):
        ledger = tmp_path / f"ledger-{number}"
        make(DESIGN, "s3://bucket/parts", Run(Part(number, 2), workers=1, ledger=ledger))
    merge("s3://bucket/parts")
    assert _kept(store, "parts") == wanted


def test_shards_go_there(store, tmp_path, tmp_path_factory):
    sharded = read_design({**DESIGN.tree(), "outputs": {"shards": True}})
    make(sharded, "s3://bucket/shards", Run(workers=2, ledger=tmp_path / "ledger"))
    found = _kept(store, "shards")
    assert found == _made(tmp_path_factory, sharded)
    for line in found["manifest.sha256"].decode().splitlines():
        sha, _, name = line.partition("  ")
        assert hashlib.sha256(found[name]).hexdigest() == sha


def test_a_store_that_does_not_answer_is_refused(store, tmp_path, monkeypatch):
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://127.0.0.1:9")
    s3fs.S3FileSystem.clear_instance_cache()
    with pytest.raises(InvalidInputError, match="cannot be used"):
        make(DESIGN, "s3://bucket/silent", Run(workers=1, ledger=tmp_path / "ledger"))
    assert not (tmp_path / "ledger").exists()
    s3fs.S3FileSystem.clear_instance_cache()
