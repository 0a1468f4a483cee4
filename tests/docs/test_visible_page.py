"""docs/visible.md: its commands and its program run, its pictures are those of its commands."""

from __future__ import annotations

import json
import re
import runpy
import shlex
from pathlib import Path

import numpy as np
from PIL import Image
from typer.testing import CliRunner

from phantom.cli import app
from phantom.visible import CAMERA_NAMES, Lighting

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "visible.md").read_text(encoding="utf-8")


def ran(command: str) -> None:
    result = CliRunner().invoke(app, shlex.split(command), catch_exceptions=False)
    assert result.exit_code == 0, result.output


def test_the_pictures_are_made_as_the_page_says(tmp_path):
    shown = re.findall(r"^uv run (phantom render .*)$", PAGE, re.M)
    making = runpy.run_path(str(ROOT / "docs" / "make_figures.py"))
    assert list(making["VISIBLE"]) == shown
    pictures = re.findall(r"-o docs/(images/\S+)$", PAGE, re.M)
    assert sorted(pictures) == sorted(re.findall(r"!\[.*?\]\((images/\S+?)\)", PAGE))
    (line,) = (line for line in shown if "knee-1993" in line)
    made = tmp_path / "made.png"
    picture = ROOT / line.split()[-1]
    ran(re.sub(r"-o \S+$", f"-o {made}", line).removeprefix("phantom "))
    one, other = (np.asarray(Image.open(path), dtype=int) for path in (made, picture))
    assert np.abs(one - other).max() <= 1


def test_the_commands_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    commands = re.findall(r"^phantom (render .*)$", PAGE, re.M)
    assert len(commands) == 3
    for command in commands:
        ran(command.replace("--columns 256", "--columns 48"))
    # Hidden by its one material, the knee is gone: the last picture is white.
    assert np.asarray(Image.open("nothing.png")).min() == 255
    assert np.asarray(Image.open("knee-behind.png")).min() == 0


def test_the_program_runs():
    (program,) = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
    scope: dict = {}
    exec(program, scope)
    assert scope["picture"].rgb.shape == (128, 128, 3)
    assert 0.01 < scope["picture"].coverage.mean() < 0.5
    assert scope["hits"].leaf_names[scope["hits"].leaf[0]] == "skin"


def test_the_lighting_is_one():
    (lighting,) = re.findall(r"^```json\n(.*?)^```", PAGE, re.M | re.S)
    assert Lighting(**json.loads(lighting)).shadows


def test_every_word_is_listed():
    (table,) = re.findall(r"\| word \|.*?\n\n", PAGE, re.S)
    rows = [row.split("|")[1] for row in table.strip().splitlines()[2:]]
    assert sorted(re.findall(r"`(\w+)`", " ".join(rows))) == sorted(CAMERA_NAMES)
