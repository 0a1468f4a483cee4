"""docs/stereo.md: its commands and its program run, its pictures are those of its commands."""

from __future__ import annotations

import re
import runpy
import shlex
import zipfile
from pathlib import Path

import numpy as np
from PIL import Image
from typer.testing import CliRunner

from phantom.cli import app
from phantom.encode import LAYOUTS
from phantom.stereo import Stereo
from phantom.stereo.comfort import Level

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "stereo.md").read_text(encoding="utf-8")


def ran(command: str) -> None:
    result = CliRunner().invoke(app, shlex.split(command), catch_exceptions=False)
    assert result.exit_code == 0, result.output


def test_the_pictures_are_made_as_the_page_says(tmp_path):
    shown = re.findall(r"^uv run (phantom (?:stereo|render-pair) .*)$", PAGE, re.M)
    making = runpy.run_path(str(ROOT / "docs" / "make_figures.py"))
    assert list(making["STEREO"]) == shown
    pictures = re.findall(r"-o docs/(images/\S+)$", PAGE, re.M)
    assert sorted(pictures) == sorted(re.findall(r"!\[.*?\]\((images/\S+?)\)", PAGE))
    of_1993 = [(line, picture) for line, picture in zip(shown, pictures, strict=True)
               if "knee-1993" in line]  # fmt: skip
    assert len(of_1993) == 2
    for line, picture in of_1993:
        made = tmp_path / Path(picture).name
        ran(re.sub(r"-o \S+$", f"-o {made}", line).removeprefix("phantom "))
        one, other = (np.asarray(Image.open(p), dtype=int) for p in (made, ROOT / "docs" / picture))
        assert np.abs(one - other).max() <= 1


def test_the_commands_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    commands = re.findall(r"^phantom (stereo .*)$", PAGE, re.M)
    assert len(commands) == 5
    for command in commands:
        ran(command.replace("--columns 256", "--columns 64"))
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "knee-auto.png", "knee-left.dcm", "knee-right.dcm", "knee-stereo.dcm", "knee.exr",
        "knee.png", "knee.zip",
    ]  # fmt: skip
    with zipfile.ZipFile("knee.zip") as whole:
        assert "left/truth.json" in whole.namelist()


def test_the_program_says_what_the_eyes_are_asked(capsys):
    programs = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
    assert len(programs) == 2
    found: dict = {}
    for program in programs:
        exec(program, found)
    assert found["patella"].pixels[0] > 0
    assert found["seen"].levels()["left"].shape == (256, 256, 3)
    assert capsys.readouterr().out.startswith("comfortable: ")


def test_every_layout_level_and_field_is_listed():
    for word in (*LAYOUTS, *Level.__args__, *Stereo.model_fields):
        assert f"`{word}`" in PAGE, word
