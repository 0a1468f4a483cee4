"""Presets placed around a phantom: distances, coverage, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging import PRESETS, DetectorGrid, Preset, place, preset_view, projection
from phantom.scene import Phantom

Ball = Callable[..., Phantom]


@pytest.mark.parametrize("word", PRESETS)
def test_the_central_ray_runs_through_the_isocentre_to_the_middle(
    balls: Phantom, word: str
) -> None:
    view = preset_view(balls, word, isocentre=[10, -20, 5], object_detector_mm=150)
    source, center = np.array(view.source), np.array(view.detector.center)
    assert np.linalg.norm(center - source) == pytest.approx(1150)
    assert np.linalg.norm(center - [10, -20, 5]) == pytest.approx(150)
    camera = projection(view)
    np.testing.assert_allclose(camera.project(np.array([[10.0, -20, 5]])), [[511.5, 511.5]])
    assert camera.magnification(np.array([10.0, -20, 5])) == pytest.approx(1150 / 1000)


@pytest.mark.parametrize("word", PRESETS)
def test_the_default_detector_covers_the_phantom_and_wastes_little(
    ball_at: Ball, word: str
) -> None:
    view = preset_view(ball_at((40, 10, -30), 25), word, columns=200, rows=100)
    camera = projection(view)
    radius = 25 * np.sqrt(3)  # of the ball about the bounding box
    rim = np.array([40.0, 10, -30]) + 25 * np.vstack([np.eye(3), -np.eye(3)])
    image = camera.project(rim)
    assert (image > -0.5).all()
    assert (image < [199.5, 99.5]).all()
    magnified = 2 * radius * 1150 / (1150 - 100 - radius)
    assert view.detector.pitch_xy_mm[1] * 100 < magnified * 1.06


def test_the_isocentre_is_the_documents_landmark_or_the_middle_of_the_box(ball_at: Ball) -> None:
    middle = preset_view(ball_at((40, 10, -30), 25), "ap")
    assert middle.source == pytest.approx((40, 10 - 1050, -30))
    landmark = ball_at((40, 10, -30), 25, landmarks={"isocentre": [41, 12, -28]})
    assert preset_view(landmark, "ap").source == pytest.approx((41, 12 - 1050, -28))


def test_either_distance_to_the_object_may_be_given(balls: Phantom) -> None:
    near = preset_view(balls, "pa", source_detector_mm=1800, source_object_mm=1650)
    same = preset_view(balls, "pa", source_detector_mm=1800, object_detector_mm=150)
    assert near == same


def test_a_default_detector_stands_clear_of_a_thick_phantom(ball_at: Ball) -> None:
    view = preset_view(ball_at((0, 0, 0), 180), "ap")
    assert view.detector.center == pytest.approx((0, 190, 0))
    assert view.source == pytest.approx((0, 190 - 1150, 0))


def test_the_side_of_a_limb_comes_from_the_document_unless_given(ball_at: Ball) -> None:
    left = ball_at((0, 0, 0), 20, anatomy={"region": "knee", "laterality": "left"})
    assert preset_view(left, "mediolateral").source == pytest.approx((-1050, 0, 0))
    turned = preset_view(left, "mediolateral", laterality="right")
    assert turned.source == pytest.approx((1050, 0, 0))
    unsaid = ball_at((0, 0, 0), 20)
    assert preset_view(unsaid, "mediolateral").source == pytest.approx((1050, 0, 0))


def test_a_given_pitch_is_kept(balls: Phantom) -> None:
    view = preset_view(balls, "ap", columns=300, rows=200, pitch_mm=(0.1, 0.2))
    assert view.detector.pitch_xy_mm == (0.1, 0.2)
    assert (view.detector.columns, view.detector.rows) == (300, 200)
    placed = place(
        balls, Preset(preset="ap"), DetectorGrid(columns=300, rows=200, pitch_mm=(0.1, 0.2))
    )
    assert placed == view


REFUSED: list[tuple[dict[str, Any], str, str]] = [
    ({"preset": "frontal"}, "/view/preset", "unknown_value"),
    ({"source_detector_mm": 0}, "/view/source_detector_mm", "out_of_range"),
    ({"source_object_mm": 1150}, "/view/source_object_mm", "too_far"),
    ({"object_detector_mm": 2000}, "/view/object_detector_mm", "too_far"),
    ({"angle_deg": 20}, "/view/angle_deg", "no_effect"),
    ({"preset": "lao", "angle_deg": 91}, "/view/angle_deg", "out_of_range"),
    ({"primary_angle_deg": 20}, "/view/primary_angle_deg", "no_effect"),
    ({"preset": "c_arm", "secondary_angle_deg": 95}, "/view/secondary_angle_deg", "out_of_range"),
    ({"laterality": "left"}, "/view/laterality", "no_effect"),
    ({"preset": "cc", "laterality": "both"}, "/view/laterality", "unknown_value"),
    ({"tilt": 3}, "/view/tilt", "unknown_field"),
    ({"columns": 0}, "/detector/columns", "out_of_range"),
    ({"pitch_mm": 0}, "/detector/pitch_mm", "out_of_range"),
    ({"source_detector_mm": 105}, "/detector/pitch_mm", "missing"),
    ({"source_detector_mm": 1e7, "isocentre": [0, 1e7, 0]}, "/view", "out_of_range"),
    ({"isocentre": [1e6, 0, 0]}, "/detector/pitch_mm", "out_of_range"),
    ({"source_detector_mm": 90}, "/view/source_detector_mm", "too_near"),
]


@pytest.mark.parametrize(("asked", "path", "kind"), REFUSED)
def test_a_preset_that_cannot_be_is_refused(
    balls: Phantom, asked: dict[str, Any], path: str, kind: str
) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        preset_view(balls, **{"preset": "ap", **asked})
    assert [(p.path, p.kind) for p in refusal.value.problems] == [(path, kind)]


def test_both_distances_to_the_object_contradict_each_other(balls: Phantom) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        preset_view(balls, "ap", source_object_mm=1000, object_detector_mm=150)
    assert [p.kind for p in refusal.value.problems] == ["contradiction"]


def test_problems_of_view_and_detector_are_told_together(balls: Phantom) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        preset_view(balls, "frontal", rows=0)
    assert [p.path for p in refusal.value.problems] == ["/view/preset", "/detector/rows"]
