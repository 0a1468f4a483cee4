"""What a person waits for before anything is traced, and what is said meanwhile."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import phantom.tracing
from phantom.cli import engine
from phantom.kernels import compiling

COMMAND = "import sys; from phantom.cli import main; sys.argv[0] = 'phantom'; main()"
LOADED = f"""
import atexit, sys
atexit.register(lambda: print(*sorted(sys.modules), file=sys.stderr))
{COMMAND}
"""


@pytest.fixture
def warmed(monkeypatch) -> list[str]:
    """Count the times that kernels are compiled, without compiling any."""
    times: list[str] = []
    monkeypatch.setattr(phantom.tracing, "warm", lambda light: times.append("warm"))
    return times


def told(monkeypatch, capsys, *, complete: bool, **words: bool) -> str:
    monkeypatch.setattr(compiling, "complete", lambda light: complete)
    engine.ready(**words)
    out, err = capsys.readouterr()
    assert out == ""
    return err


def test_compiling_is_told_in_one_line(monkeypatch, capsys, warmed):
    assert told(monkeypatch, capsys, complete=False) == "compiling kernels, once\n"
    assert warmed == ["warm"]


def test_nothing_is_told_beside_json(monkeypatch, capsys, warmed):
    assert told(monkeypatch, capsys, complete=False, quiet=True) == ""
    assert warmed == ["warm"]


def test_kernels_once_compiled_are_not_loaded_before_they_are_used(monkeypatch, capsys, warmed):
    assert told(monkeypatch, capsys, complete=True) == ""
    assert warmed == []


def test_a_service_has_them_loaded(monkeypatch, capsys, warmed):
    assert told(monkeypatch, capsys, complete=True, load=True) == ""
    assert warmed == ["warm"]


def radiograph(folder: Path, *words: str, program: str = COMMAND, **variables: str) -> str:
    """Run ``phantom radiograph`` in a process of its own and return what it told."""
    argv = ["radiograph", "knee-1993", "--columns", "8", "-o", str(folder / "k.png"), *words]
    done = subprocess.run(
        [sys.executable, "-c", program, *argv],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, **variables},
    )
    return done.stderr


def test_a_radiograph_loads_only_what_it_needs(tmp_path: Path):
    phantom.tracing.warm()
    loaded = radiograph(tmp_path, program=LOADED).splitlines()[-1].split()
    heavy = {"scipy.linalg", "scipy.interpolate", "scipy.spatial", "pydicom", "fastapi"}
    assert "numba" in loaded
    assert not heavy.intersection(loaded)


@pytest.mark.nightly
def test_only_the_first_run_compiles(tmp_path: Path):
    """Every kernel that a radiograph may need lies on disk after the first run."""
    first = radiograph(tmp_path, NUMBA_CACHE_DIR=str(tmp_path))
    assert first.count("compiling kernels, once") == 1
    kept = {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*.nb?")}
    assert (
        len({p.name for p in kept if p.suffix == ".nbi"})
        == compiling.compiled_so_far(light=False)[1]
    )
    assert "compiling" not in radiograph(tmp_path, NUMBA_CACHE_DIR=str(tmp_path))
    assert {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*.nb?")} == kept
