"""docs/imaging.md: its pictures are there, its window and its knee are what it says."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

import phantom
from phantom.imaging import Acquisition

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "imaging.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def making():
    return runpy.run_path(str(ROOT / "docs" / "make_imaging_page.py"))


def test_every_picture_is_there_and_shows_three_knees(making):
    pictures = re.findall(r"!\[.*?\]\((\S+?)\)", PAGE)
    assert len(pictures) == 4
    for picture in pictures:
        header = (ROOT / "docs" / picture).read_bytes()[16:24]
        width, height = np.frombuffer(header, dtype=">u4")
        assert (width, height) == (3 * making["COLUMNS"] + 2 * 4, making["ROWS"])


def test_the_window_is_the_one_that_is_told(making):
    low, high = map(float, re.search(r"from ([\d.]+) to ([\d.]+)", PAGE).groups())
    center, width = making["USUAL"].window
    assert (low, high) == pytest.approx((center - width / 2, center + width / 2))


def test_the_exposure_is_the_one_that_is_told(making):
    asked = making["exposure"]()
    assert asked.detector_air_kerma_ugy == 12.5
    assert asked.focal_spot.size_mm == (0.6, 0.6)
    assert asked.samples_per_pixel == (2, 2)
    assert asked.scatter is None
    assert asked.detector.absorber.material == "cesium_iodide"
    assert Acquisition(grid=making["GRID"]).grid.primary_transmission == 0.72


def test_a_ray_through_the_shafts_meets_cortex_spongiosa_and_cortex(making):
    body = making["knee"]()
    across = phantom.intervals(body, [[-200.0, 2.0, 90.0]], [[1.0, 0.0, 0.0]])
    names = [across.leaf_names[leaf] for leaf in across.leaf]
    femur = ["femur cortex", "femur inside", "femur cortex"]
    assert names == ["fat", "muscle", *femur, "muscle", "fat"]
    lengths = across.exit_mm - across.entry_mm
    assert lengths[2] == pytest.approx(lengths[4], abs=0.5)
    assert lengths[2] == pytest.approx(0.07 * lengths[2:5].sum(), rel=0.05)
