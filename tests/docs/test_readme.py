"""The README and the docs do what they say: their commands, their example, their links."""

from __future__ import annotations

import json
import re
import runpy
import shlex
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from typer.testing import CliRunner

from phantom.cli import app

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [
    *sorted(ROOT.glob("*.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]
SCRIPT = Path(sys.executable).with_name("phantom")
PICTURES = re.findall(r"^uv run (phantom .* -o (docs/images/\S+))$", README, re.M)
PAPERS = [f"docs/images/figure-{number}.png" for number in (8, 9, 10)]
"""Made by one command, which the gallery's tests run."""
ADDRESS = "http://127.0.0.1:8000"


def pixels(path: Path) -> np.ndarray:
    """Grey levels of a picture, (rows, columns, 1)."""
    found = OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.UINT8)
    assert found is not None, f"{path} is no picture"
    return np.asarray(found, dtype=int)


def test_the_first_command_gives_the_first_picture(tmp_path: Path):
    (line,) = re.findall(r"^pip install uv && uv run phantom (radiograph .*)$", README, re.M)
    done = subprocess.run(
        [SCRIPT, *shlex.split(line)], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert pixels(tmp_path / "knee.png").std() > 20, "something is to be seen"


def test_every_picture_has_its_command():
    shown = re.findall(r"!\[.*?\]\((\S+?)\)", README)
    assert sorted(shown) == sorted([*PAPERS, *(path for _, path in PICTURES)])
    assert "\nuv run python docs/paper_pictures.py\n" in README
    making = runpy.run_path(str(ROOT / "docs" / "make_figures.py"))
    known = {*making["COMMANDS"], *making["STEREO"], *making["VISIBLE"]}
    assert {command for command, _ in PICTURES} <= known


@pytest.mark.parametrize(("command", "path"), PICTURES, ids=[path for _, path in PICTURES])
def test_each_picture_is_what_its_command_makes(
    command: str, path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    Path(path).parent.mkdir(parents=True)
    done = CliRunner().invoke(app, shlex.split(command)[1:], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    kept, made = pixels(ROOT / path), pixels(Path(path))
    assert kept.shape == made.shape
    # Another processor may round a grey level the other way.
    assert np.abs(kept - made).max() <= 1


def test_the_python_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.S)
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    exec(example, names)
    assert pixels(tmp_path / "knee.png").shape == (512, 512, 1)
    assert names["lengths_mm"] == pytest.approx(np.array([[50.0], [30.0]]), abs=1e-10)
    thickest = dict(zip(names["knee"].material_names, names["thickest_mm"], strict=True))
    assert 60 < thickest["muscle"] < 250, "a thigh is not a sheet, nor a tree"


@pytest.fixture
def served(tmp_path: Path) -> Iterator[str]:
    """The address of `phantom serve`, at a port that was free."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with (tmp_path / "log").open("wb") as log:
        process = subprocess.Popen([SCRIPT, "serve", "--port", str(port)], stderr=log, cwd=tmp_path)
    address = f"http://127.0.0.1:{port}"
    try:
        deadline = time.monotonic() + 120
        while True:
            try:
                urllib.request.urlopen(f"{address}/healthz", timeout=5).close()
                break
            except OSError:
                assert process.poll() is None, (tmp_path / "log").read_text()
                assert time.monotonic() < deadline, "the service never answered"
                time.sleep(0.1)
        yield address
    finally:
        process.terminate()
        process.wait(timeout=30)


def test_the_request_is_answered_by_a_running_service(served: str):
    ((place, kind, body),) = re.findall(
        rf"curl -s {ADDRESS}(\S+) -H 'Content-Type: (\S+)' -o knee\.png -d '(.*?)'", README, re.S
    )
    assert json.loads(body)["phantom"]["name"] == "knee"
    request = urllib.request.Request(served + place, body.encode(), {"Content-Type": kind})
    with urllib.request.urlopen(request, timeout=120) as response:
        assert response.headers["Content-Type"] == "image/png"
        picture = response.read()
    assert picture.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = np.frombuffer(picture[16:24], dtype=">u4")
    assert (width, height) == (512, 512)


def anchors(page: Path) -> set[str]:
    """What a page's headings are called in links, as on GitHub."""
    heads = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])
def test_every_link_leads_somewhere(page: Path):
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", link):
            continue
        place, _, anchor = link.partition("#")
        target = (page.parent / place).resolve() if place else page
        assert target.exists(), f"{link} leads nowhere"
        assert target.is_relative_to(ROOT), f"{link} leads out of the project"
        if anchor:
            assert anchor in anchors(target), f"{link} has no such heading"


def test_every_module_the_engine_page_names_is_there():
    text = (ROOT / "docs" / "methods" / "engine.md").read_text(encoding="utf-8")
    folders = {"geometry", "compiled", "kernels"}
    for row in re.findall(r"`([^`]*\.py)`(?:, `([^`]*\.py)`)?(?:, `([^`]*\.py)`)?", text):
        folder = ""
        for name in filter(None, row):
            folder = name.split("/")[0] if "/" in name else folder
            assert folder in folders, name
            assert (ROOT / "phantom" / folder / Path(name).name).is_file(), name
