"""The page on phantoms of one's own: its package, installed as it says, is in the library."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "phantoms" / "your-own.md").read_text(encoding="utf-8")
SCRIPT = Path(sys.executable).with_name("phantom")


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """Install the page's package as a wheel would be: a module and its metadata on the path."""
    (module,) = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    (points,) = re.findall(
        r'^\[project\.entry-points\."phantom\.library"\]\n(.*?)^```', PAGE, re.M | re.S
    )
    (tmp_path / "screws").mkdir()
    (tmp_path / "screws" / "__init__.py").write_text(module)
    metadata = tmp_path / "screws-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: screws\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text("[phantom.library]\n" + points.replace('"', ""))
    return {**os.environ, "PYTHONPATH": str(tmp_path)}


def _phantom(environment, cwd, *words):
    done = subprocess.run(
        [SCRIPT, *words], env=environment, cwd=cwd, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_package_of_the_page_is_found_shown_and_x_rayed(installed, tmp_path):
    assert re.search(r"^screw +Screw$", _phantom(installed, tmp_path, "list"), re.M)
    shown = _phantom(installed, tmp_path, "show", "screw")
    assert "--set length_mm=30.0" in shown
    assert "--abnormality loosening" in shown
    (line,) = re.findall(r"^phantom (radiograph screw .*)$", PAGE, re.M)
    words = [*line.split(), "--columns", "64", "--json"]
    told = json.loads(_phantom(installed, tmp_path, *words))
    assert (tmp_path / told["output"]).stat().st_size > 0


def test_the_twin_differs_only_behind_the_gap(installed, tmp_path):
    check = """
import numpy as np, phantom
well = phantom.library.build("screw")
loose = phantom.library.build("screw", [{"type": "loosening", "radius_mm": 5}])
view = phantom.preset_view(well, "ap", columns=64, rows=64)
a, b = (phantom.radiograph(s, view).path_lengths for s in (well, loose))
gap = b[..., well.material_names.index("marrow")] > 0
assert gap.any()
assert (a[~gap] == b[~gap]).all()
"""
    subprocess.run([sys.executable, "-c", check], env=installed, cwd=tmp_path, check=True)
