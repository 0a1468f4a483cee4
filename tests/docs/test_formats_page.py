"""docs/formats.md: its tables are the registry's, its commands and programs run."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pydicom
import pytest
from typer.testing import CliRunner

from phantom.cli import app
from phantom.encode import FORMATS

PAGE = (Path(__file__).parents[2] / "docs" / "formats.md").read_text(encoding="utf-8")
OF_ONE, OF_PAIRS = PAGE.split("## Pairs")
RADIUS_MM, ATTENUATION_PER_MM = 25.0, 0.03


def test_every_format_is_listed_with_its_words():
    rows = re.findall(r"^\| `([\w-]+)` \| (.*?) \| `(.*?)` \| .*? \| (.*?) \|$", PAGE, re.M)
    assert rows == [
        (f.name, " ".join(f"`{e}`" for e in f.extensions), f.media_type, ", ".join(f.quantities))
        for f in FORMATS
    ]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    commands = re.findall(r"^phantom (radiograph .*)$", PAGE, re.M)
    assert len(commands) == 8
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for command in commands:
            result = CliRunner().invoke(app, command.split(), catch_exceptions=False)
            assert result.exit_code == 0, result.output
    return folder


def test_each_program_finds_the_ball_that_was_xrayed(folder, monkeypatch):
    """Twice the radius along the central ray; the nearest pixel of 64 misses it by a hair."""
    monkeypatch.chdir(folder)
    programs = re.findall(r"^```python\n(.*?)^```", OF_ONE, re.M | re.S)
    assert len(programs) == 4
    found = []
    for program in programs:
        scope: dict = {}
        exec(program, scope)
        found.append(scope)
    line_integral = 2 * RADIUS_MM * ATTENUATION_PER_MM
    codes, tiff, exr, dicom = found
    for scope in (codes, tiff, dicom):
        assert scope["line_integral"].max() == pytest.approx(line_integral, rel=2e-3)
    assert exr["thickness_mm"].max() == pytest.approx(2 * RADIUS_MM, rel=2e-3)
    for scope in (tiff, exr):
        assert scope["metadata"]["phantom"]["name"] == "sphere"
    assert dicom["grey"].dtype == np.uint16
    assert len(dicom["pitch_mm"]) == 2


def test_each_element_that_is_listed_is_there(folder):
    listed = {
        word
        for row in re.findall(r"^\| ([A-Z]\w+.*?) \| .* \|$", PAGE.split("| element |")[1], re.M)
        for word in re.findall(r"\b[A-Z][a-z]\w+|\bKVP\b", row.split(" (")[0])
    }
    found = pydicom.dcmread(folder / "ball.dcm")
    of_a_tube = {"KVP", "AnodeTargetMaterial", "FilterMaterial", "ExposureInuAs"}
    absent = {word for word in listed if word not in found}
    assert absent == of_a_tube | {"FilterThicknessMinimum"}


def test_the_files_of_a_pair_are_what_the_page_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for command in re.findall(r"^phantom (stereo .*)$", OF_PAIRS, re.M):
        result = CliRunner().invoke(app, command.split(), catch_exceptions=False)
        assert result.exit_code == 0, result.output
    exr, relation = re.findall(r"^```python\n(.*?)^```", OF_PAIRS, re.M | re.S)
    found: dict = {}
    exec(exr, found)
    assert found["names"] == ("left", "right")
    assert found["transmission"].shape == (64, 64)
    exec(relation, found)
    for eye in ("left", "right"):
        image = pydicom.dcmread(tmp_path / f"pair-{eye}.dcm")
        assert found[f"{eye}_uid"] == image.SOPInstanceUID
    assert found["baseline_mm"] > 0
