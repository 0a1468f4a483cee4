"""Degrees on a screen, and what is said of them."""

from __future__ import annotations

import math

import pytest

from phantom.errors import InvalidInputError
from phantom.stereo import Disparity, Screen, Stereo, comfort

SCREEN = Screen(pixel_pitch_mm=0.25, distance_mm=600, ipd_mm=64)


def eye_angle_deg(eye_mm: float, at_mm: float) -> float:
    return math.degrees(math.atan2(at_mm - eye_mm, 600))


@pytest.mark.parametrize("pixels", [-40.0, -1.0, 0.0, 1.0, 37.5, 400.0])
def test_a_disparity_is_how_much_more_the_eyes_converge(pixels: float) -> None:
    """Drawn by hand: two eyes at ±32 mm, the two images of a point at ±half the disparity."""
    half = pixels * 0.25 / 2
    on_point = eye_angle_deg(-32, half) - eye_angle_deg(32, -half)
    on_screen = eye_angle_deg(-32, 0) - eye_angle_deg(32, 0)
    assert float(SCREEN.degrees(pixels)) == pytest.approx(on_point - on_screen, abs=1e-12)


def test_a_knee_at_one_and_a_half_without_a_slide_is_three_degrees_off() -> None:
    """65 mm of baseline, half of it again on the detector, seen at its own size from 600 mm."""
    screen = Screen(pixel_pitch_mm=0.1, distance_mm=600, ipd_mm=63)
    assert float(screen.degrees(65 * 0.5 / 0.1)) == pytest.approx(3.1, abs=0.02)


def judged(low_deg: float, high_deg: float, vertical_px: float = 0.0):
    px = tuple(600 * math.tan(math.radians(d)) / 0.25 for d in (low_deg, high_deg))
    whole = Disparity("whole", "", px, (low_deg, high_deg), vertical_px)
    return comfort(whole, [Disparity("leaf", "tibia", px, (low_deg, high_deg), 0.0)], SCREEN)


@pytest.mark.parametrize(
    ("low", "high", "level"),
    [
        (0.0, 0.0, "flat"),
        (-1.0, 1.0, "comfortable"),
        (-0.2, 1.01, "fusible"),
        (-2.0, 0.1, "fusible"),
        (-2.1, 0.0, "hard"),
        (0.0, 3.1, "not_fusible"),
    ],
)
def test_the_verdict_goes_by_the_worst_on_either_side(low: float, high: float, level: str) -> None:
    found = judged(low, high)
    assert found.level == level
    assert found.verdict.startswith(level.replace("_", " ").split()[0])
    assert (found.crossed_deg, found.uncrossed_deg) == (high, -low)
    if level not in ("flat", "comfortable"):
        assert "tibia" in found.verdict


def test_eyes_that_would_look_outward_are_told() -> None:
    near = Screen(pixel_pitch_mm=0.25, distance_mm=6000, ipd_mm=64)
    px = (-257.0, 0.0)
    degrees = tuple(float(near.degrees(p)) for p in px)
    assert -degrees[0] < 1, "far away even that is a small angle"
    found = comfort(Disparity("whole", "", px, degrees, 0.0), [], near)
    assert found.level == "not_fusible"
    assert "outward" in found.verdict


def test_a_difference_in_height_is_told() -> None:
    assert "height" in judged(-0.5, 0.5, vertical_px=5.0).verdict
    assert "height" not in judged(-0.5, 0.5).verdict


def test_what_lies_behind_an_eye_cannot_be_fused() -> None:
    found = comfort(Disparity("whole", "", None, None, None), [], SCREEN)
    assert found.level == "not_fusible"


@pytest.mark.parametrize(
    ("fields", "paths"),
    [
        ({"baseline_mm": 0}, ["/stereo/baseline_mm"]),
        ({"baseline_mm": -65.0}, ["/stereo/baseline_mm"]),
        ({"baseline_mm": "wide"}, ["/stereo/baseline_mm"]),
        ({"baseline_mm": [65]}, ["/stereo/baseline_mm"]),
        ({"angle_deg": 6}, ["/stereo/angle_deg"]),
        ({"method": "rotate", "baseline_mm": 65}, ["/stereo/baseline_mm"]),
        ({"method": "rotate", "angle_deg": 0}, ["/stereo/angle_deg"]),
        ({"screen": {"distance_mm": 0}}, ["/stereo/screen/distance_mm"]),
        ({"screen": {"pixel_pitch_mm": -0.2}}, ["/stereo/screen/pixel_pitch_mm"]),
        ({"screen": {"ipd_mm": float("nan")}}, ["/stereo/screen/ipd_mm"]),
        ({"zero_parallax": {"plane_mm": 0}}, ["/stereo/zero_parallax/plane_mm"]),
        ({"zero_parallax": {"plane_mm": -100}}, ["/stereo/zero_parallax/plane_mm"]),
        ({"zero_parallax": "knee"}, ["/stereo/zero_parallax"]),
        ({"zero_parallax": 5}, ["/stereo/zero_parallax"]),
        ({"dose": "half", "mono": "left"}, ["/stereo/dose", "/stereo/mono"]),
    ],
)
def test_what_is_no_pair_is_refused_with_its_place(fields, paths) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Stereo(**fields)
    assert [p.path for p in refusal.value.problems] == paths
    assert all("found" in p.message and "expected" in p.message for p in refusal.value.problems)
