"""Clinical words: where the detector stands, and what is where in the picture."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.imaging import PRESETS, Detector, View, pose, projection

LEFT, BACK, HEAD = np.eye(3)
RIGHT, FRONT, FEET = -np.eye(3)


def image_of(points: Any, preset: Any, **turn: Any) -> Any:
    """Where points near the isocentre fall, in mm right and down of the picture's middle."""
    at = pose(preset, **turn)
    detector = Detector(
        center=300 * at.beam, right=at.right, down=at.down, columns=1, rows=1, pitch_mm=1.0
    )
    camera = projection(View(source=-900 * at.beam, detector=detector))
    return camera.project(np.atleast_2d(points))


ALL = [
    *((word, {}) for word in PRESETS),
    *((word, {"laterality": "left"}) for word in ("mediolateral", "lateromedial", "cc", "mlo")),
    ("lao", {"angle_deg": 30}),
    ("mlo", {"angle_deg": 60}),
    ("c_arm", {"primary_angle_deg": -110, "secondary_angle_deg": 35}),
]


@pytest.mark.parametrize(("word", "turn"), ALL)
def test_beam_right_and_down_are_orthogonal_unit_vectors(word: Any, turn: Any) -> None:
    frame = np.stack(pose(word, **turn))
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-15)


@pytest.mark.parametrize(("word", "turn"), [case for case in ALL if case[0] != "cc"])
def test_row_0_is_the_head_end(word: Any, turn: Any) -> None:
    (_, head), (_, feet) = image_of([10 * HEAD, 10 * FEET], word, **turn)
    assert head < 0 < feet


@pytest.mark.parametrize("word", ["ap", "pa", "lao", "rao", "lpo", "rpo"])
def test_the_patients_left_is_at_the_images_right(word: Any) -> None:
    (left, _), (right, _) = image_of([10 * LEFT, 10 * RIGHT], word)
    assert right < 0 < left


def test_pa_is_mirrored_and_ap_is_not() -> None:
    for word, mirrored in (("ap", False), ("pa", True)):
        at = pose(word)  # type: ignore[arg-type]
        assert (np.cross(at.right, at.down) @ at.beam < 0) == mirrored


DETECTOR_SIDE = {
    "ap": BACK,
    "pa": FRONT,
    "left_lateral": LEFT,
    "right_lateral": RIGHT,
    "cc": FEET,
    "lao": (LEFT + FRONT) / np.sqrt(2),
    "rao": (RIGHT + FRONT) / np.sqrt(2),
    "lpo": (LEFT + BACK) / np.sqrt(2),
    "rpo": (RIGHT + BACK) / np.sqrt(2),
}


@pytest.mark.parametrize("word", DETECTOR_SIDE)
def test_the_detector_is_on_the_side_the_word_says(word: Any) -> None:
    np.testing.assert_allclose(pose(word).beam, DETECTOR_SIDE[word], atol=1e-15)


@pytest.mark.parametrize(("laterality", "lateral"), [("left", LEFT), ("right", RIGHT)])
def test_a_mediolateral_beam_runs_outward_and_a_lateromedial_inward(
    laterality: Any, lateral: Any
) -> None:
    assert pose("mediolateral", laterality=laterality).beam.tolist() == lateral.tolist()
    assert pose("lateromedial", laterality=laterality).beam.tolist() == (-lateral).tolist()


def test_without_a_side_a_limb_is_a_right_one() -> None:
    assert pose("mediolateral").beam.tolist() == RIGHT.tolist()


def test_a_lateral_is_seen_from_its_detector() -> None:
    assert image_of(10 * FRONT, "left_lateral")[0, 0] < 0
    assert image_of(10 * FRONT, "right_lateral")[0, 0] > 0


@pytest.mark.parametrize(("laterality", "side"), [("left", 1), ("right", -1)])
@pytest.mark.parametrize("word", ["cc", "mlo"])
def test_the_nipple_points_away_from_the_chest_wall_of_its_side(
    word: Any, laterality: Any, side: int
) -> None:
    ((front, _),) = image_of(10 * FRONT, word, laterality=laterality)
    assert front * side > 0


@pytest.mark.parametrize(("laterality", "lateral"), [("left", LEFT), ("right", RIGHT)])
def test_the_lateral_side_of_a_breast_is_at_the_top(laterality: Any, lateral: Any) -> None:
    assert image_of(10 * lateral, "cc", laterality=laterality)[0, 1] < 0
    assert image_of(10 * (lateral + HEAD), "mlo", laterality=laterality)[0, 1] < 0


@pytest.mark.parametrize("laterality", ["left", "right"])
def test_mlo_turns_from_cc_to_mediolateral(laterality: Any) -> None:
    for turned, word in ((0, "cc"), (90, "mediolateral")):
        oblique = pose("mlo", laterality=laterality, angle_deg=turned)
        assert oblique.beam.tolist() == pose(word, laterality=laterality).beam.tolist()  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("primary", "word"), [(0, "pa"), (180, "ap"), (-180, "ap"), (90, "left_lateral"), (45, "lao")]
)
def test_positioner_angles_meet_the_words(primary: float, word: Any) -> None:
    for ours, theirs in zip(pose("c_arm", primary_angle_deg=primary), pose(word), strict=True):
        np.testing.assert_allclose(ours, theirs, atol=1e-15)


def test_a_positive_secondary_angle_lifts_the_detector_to_the_head() -> None:
    lifted = pose("c_arm", primary_angle_deg=0, secondary_angle_deg=30).beam
    np.testing.assert_allclose(lifted, [0, -np.sqrt(3) / 2, 0.5], atol=1e-15)
