"""Where two eyes see beads at known depths, against the pinhole by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phantom.imaging import stereo_pair
from phantom.stereo import disparities, structures
from tests.imaging.stereo.conftest import (
    BEADS,
    COLUMNS,
    PITCH_MM,
    SOURCE_DETECTOR_MM,
    SOURCE_ISOCENTRE_MM,
)

POSES = ("ap", "pa")
NEAREST = {"ap": "front", "pa": "back"}
PIXELS = 0.001


def columns_by_hand(pose: str, name: str, tube_mm: float, zero_mm: float) -> float:
    """The column of a bead with the tube at ``tube_mm`` along the rows, its window slid."""
    x, y, _ = BEADS[name]
    depth = SOURCE_ISOCENTRE_MM + (y if pose == "ap" else -y)
    on_plane = tube_mm + (x - tube_mm) * SOURCE_DETECTOR_MM / depth
    slid = tube_mm * (1 - SOURCE_DETECTOR_MM / zero_mm)
    return (on_plane - slid) / PITCH_MM + (COLUMNS - 1) / 2


def columns_turned(pose: str, name: str, angle_deg: float) -> float:
    """The column of a bead after the object turned so that the tube seems to go by this angle."""
    x, y, _ = BEADS[name]
    far = y if pose == "ap" else -y
    sin, cos = math.sin(math.radians(angle_deg)), math.cos(math.radians(angle_deg))
    across, depth = x * cos + far * sin, SOURCE_ISOCENTRE_MM + far * cos - x * sin
    return across * SOURCE_DETECTOR_MM / depth / PITCH_MM + (COLUMNS - 1) / 2


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize(
    ("zero_parallax", "zero_mm"),
    [
        ("isocentre", SOURCE_ISOCENTRE_MM),
        ({"plane_mm": 920.0}, 920.0),
    ],
)
def test_a_shifted_tube_shows_beads_where_the_pinhole_does(
    beads, bead_view, seen, pose, zero_parallax, zero_mm
) -> None:
    pair = stereo_pair(beads, bead_view(pose), baseline_mm=30, zero_parallax=zero_parallax)
    for image, tube_mm in ((pair.left, -15.0), (pair.right, 15.0)):
        for name, (column, _) in seen(image).items():
            assert column == pytest.approx(
                columns_by_hand(pose, name, tube_mm, zero_mm), abs=PIXELS
            )


def test_without_a_slide_the_window_stays_where_it_is(beads, bead_view) -> None:
    view = bead_view("ap")
    pair = stereo_pair(beads, view, baseline_mm=2, zero_parallax="detector")
    for eye in (pair.eyes.left, pair.eyes.right):
        np.testing.assert_allclose(eye.detector.center, view.detector.center, atol=1e-12)
    raised = SOURCE_DETECTOR_MM / SOURCE_ISOCENTRE_MM - 1
    assert pair.disparity("isocentre").pixels == pytest.approx((2 * raised / PITCH_MM,) * 2), (
        "the isocentre stands before the detector, and so before the screen"
    )


@pytest.mark.parametrize("pose", POSES)
def test_a_turned_object_shows_beads_where_the_pinhole_does(beads, bead_view, seen, pose) -> None:
    pair = stereo_pair(beads, bead_view(pose), method="rotate", angle_deg=3)
    assert pair.eyes.angle_deg == pytest.approx(3, abs=1e-9)
    for image, angle_deg in ((pair.left, -1.5), (pair.right, 1.5)):
        for name, (column, _) in seen(image).items():
            expected = columns_turned(pose, name, angle_deg)
            assert column == pytest.approx(expected, abs=PIXELS)


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("method", [{"baseline_mm": 30}, {"method": "rotate", "angle_deg": 2}])
def test_disparities_and_epipolar_lines_are_those_of_the_pictures(
    beads, bead_view, seen, pose, method
) -> None:
    pair = stereo_pair(beads, bead_view(pose), **method)
    left, right = seen(pair.left), seen(pair.right)
    for name in BEADS:
        marks = [d for d in pair.disparities if d.name == name and d.kind == "landmark"]
        measured = left[name][0] - right[name][0]
        assert marks[0].pixels == pytest.approx((measured, measured), abs=2 * PIXELS)
        low, high = pair.disparity(name).pixels
        assert low < measured < high, "the box of the bead holds its middle"
        line = pair.epipolar_matrix @ [*left[name], 1.0]
        distance = (line @ [*right[name], 1.0]) / math.hypot(line[0], line[1])
        assert abs(distance) <= PIXELS


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("method", [{"baseline_mm": 30}, {"method": "rotate", "angle_deg": 2}])
def test_the_bead_nearer_the_tube_is_crossed(beads, bead_view, seen, pose, method) -> None:
    pair = stereo_pair(beads, bead_view(pose), **method)
    left, right = seen(pair.left), seen(pair.right)
    near, far = NEAREST[pose], NEAREST["pa" if pose == "ap" else "ap"]
    assert left[near][0] > right[near][0] + 1, "crossed: each eye sees it on the other's side"
    assert left[far][0] < right[far][0] - 1
    assert pair.disparity(near).pixels[0] > 1
    assert pair.disparity(far).pixels[1] < -1
    x = {
        eye: view.source[0] for eye, view in (("left", pair.eyes.left), ("right", pair.eyes.right))
    }
    assert x["left"] < 0 < x["right"], "the left eye is the tube against the detector's right"


def test_swapping_the_eyes_negates(beads, bead_view) -> None:
    pair = stereo_pair(beads, bead_view("ap"), baseline_mm=30)
    left, right = pair.left.projection_matrix, pair.right.projection_matrix
    wanted = structures(beads)
    for one, other in zip(
        disparities(wanted, left, right, pair.stereo.screen),
        disparities(wanted, right, left, pair.stereo.screen),
        strict=True,
    ):
        np.testing.assert_allclose(one.pixels, np.negative(other.pixels)[::-1], atol=1e-9)


def test_a_shift_has_the_epipolar_lines_of_equal_rows(beads, bead_view) -> None:
    """F of x' = x + (d, 0) is [[0, 0, 0], [0, 0, 1], [0, -1, 0]] up to scale."""
    pair = stereo_pair(beads, bead_view("ap"), baseline_mm=30)
    expected = np.array([[0, 0, 0], [0, 0, 1], [0, -1, 0]]) / math.sqrt(2)
    assert min(
        np.abs(pair.epipolar_matrix - expected).max(), np.abs(pair.epipolar_matrix + expected).max()
    ) <= 1e-9  # fmt: skip
