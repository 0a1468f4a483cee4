"""What two eyes get: depth that can be fused, one grey scale, noise of their own, and the dose."""

from __future__ import annotations

import numpy as np
import pytest

import phantom
from phantom.errors import InvalidInputError
from phantom.imaging import (
    Acquisition,
    Beam,
    Detector,
    DetectorModel,
    NoiseKey,
    Presentation,
    View,
    radiograph,
    stereo_pair,
)
from phantom.scene import load

BONES = ("femur", "tibia", "fibula", "fibular head", "patella")
PHOTONS = DetectorModel(response="photon_counting")


@pytest.fixture(scope="module")
def knee():
    return phantom.library.build("knee-1993")


@pytest.fixture(scope="module")
def knee_view(knee):
    return lambda pose="ap", pixels=96: phantom.preset_view(knee, pose, columns=pixels, rows=pixels)


@pytest.mark.parametrize("pose", ["ap", "pa", "left_lateral"])
@pytest.mark.parametrize("method", ["shift", "rotate"])
def test_a_pair_of_the_knee_can_be_fused_by_default(knee, knee_view, pose, method) -> None:
    pair = stereo_pair(knee, knee_view(pose, 1024), method=method) if pose == "ap" else (
        stereo_pair(knee, knee_view(pose), method=method)
    )  # fmt: skip
    assert pair.disparity("isocentre").pixels == pytest.approx((0, 0), abs=1e-9)
    assert {found.name for found in pair.disparities if found.kind == "leaf"} == set(BONES)
    for bone in BONES:
        low, high = pair.disparity(bone).degrees
        assert -1 <= low < high <= 1
    assert pair.comfort.level == "comfortable"
    assert max(pair.comfort.crossed_deg, pair.comfort.uncrossed_deg) > 0.01, "there is depth"


def test_what_is_small_gets_a_smaller_baseline(knee) -> None:
    ball = phantom.library.build("sphere", radius_mm=10)
    view = phantom.preset_view(ball, "ap", columns=1024, rows=1024)
    pair = stereo_pair(ball, view, baseline_mm="auto")
    assert pair.comfort.crossed_deg == pytest.approx(1, abs=0.01)
    assert pair.comfort.level == "comfortable"
    wider = stereo_pair(ball, view, baseline_mm=pair.eyes.baseline_mm + 0.2)
    assert wider.comfort.level == "fusible", "auto is the largest"
    tiny = phantom.library.build("sphere", radius_mm=1)
    small = phantom.preset_view(tiny, "ap", columns=1024, rows=1024, object_detector_mm=800)
    assert stereo_pair(tiny, small).comfort.level == "comfortable"


def test_an_absurd_baseline_says_so_and_still_gives_pictures(knee, knee_view) -> None:
    pair = stereo_pair(knee, knee_view(pixels=512), baseline_mm=6000)
    assert pair.comfort.level == "not_fusible"
    assert "not fusible" in pair.comfort.verdict
    for image in (pair.left, pair.right):
        assert image.transmission.shape == (512, 512)
        assert image.transmission.min() < 0.9
    assert pair.metadata()["stereo"]["comfort"]["level"] == "not_fusible"


def test_bones_are_where_their_depth_puts_them(knee, knee_view) -> None:
    pair = stereo_pair(knee, knee_view("ap"), baseline_mm=65)
    assert pair.disparity("patella").pixels[0] > 0, "it is in front, nearer the tube"
    assert pair.disparity("fibula").pixels[1] < 0
    behind = stereo_pair(knee, knee_view("pa"), baseline_mm=65)
    assert behind.disparity("patella").pixels[1] < 0
    assert behind.disparity("fibula").pixels[0] > 0


def test_a_finding_is_where_its_leaves_are() -> None:
    ball = {"type": "sphere", "radius": 5, "material": "m"}
    solid = {
        "type": "union",
        "solids": [
            {**ball, "name": "a", "center": [0, -20, 0]},
            {**ball, "name": "b", "center": [0, 20, 0]},
            {**ball, "center": [30, 0, 0]},
        ],
    }
    body = load(
        {
            "format": "phantom/1",
            "materials": {"m": {"attenuation_per_mm": 0.02}},
            "solid": solid,
            "findings": [
                {"name": "both", "leaves": ["a", "b"]},
                {"name": "a point", "center": [0, -20, 0]},
                {"name": "nowhere"},
            ],
        }
    )
    pair = stereo_pair(body, phantom.preset_view(body, "ap", columns=64, rows=64))
    both = pair.disparity("both").pixels
    assert both == (pair.disparity("b").pixels[0], pair.disparity("a").pixels[1])
    low, high = pair.disparity("a point").pixels
    assert pair.disparity("a").pixels[0] < low == high < pair.disparity("a").pixels[1]
    assert [d.name for d in pair.disparities] == ["a", "b", "both", "a point"]


def open_field(pixels: int = 64) -> tuple[phantom.Phantom, View]:
    ball = phantom.library.build("sphere", radius_mm=1)
    center, right, down = [0, 100, 0], [1, 0, 0], [0, 0, -1]
    detector = Detector(
        center=center, right=right, down=down, columns=pixels, rows=pixels, pitch_mm=0.3
    )
    return ball, View(source=[0, -1000, 0], detector=detector)


def test_the_two_eyes_have_noise_of_their_own() -> None:
    ball, view = open_field()
    exposure = Acquisition(detector=PHOTONS)
    once, again = (
        stereo_pair(ball, view, acquisition=exposure, noise=NoiseKey(seed=3)) for _ in range(2)
    )
    np.testing.assert_array_equal(once.left.signal, again.left.signal)
    np.testing.assert_array_equal(once.right.signal, again.right.signal)
    above = [image.signal[:25] for image in (once.left, once.right)]  # of the ball
    left, right = (part - part.mean() for part in above)
    correlation = float((left * right).mean() / (left.std() * right.std()))
    assert abs(correlation) < 4 / 40, "four standard errors of 25 · 64 independent pixels"
    assert left.std() == pytest.approx(np.sqrt(once.left.open_field), rel=0.05)


def test_a_pair_costs_what_one_image_costs_unless_each_has_its_own_dose() -> None:
    ball, view = open_field(16)
    for dose, exposure in (
        (2.5, Acquisition()),
        (4.0, Acquisition(detector_air_kerma_ugy=4.0)),
    ):
        split = stereo_pair(ball, view, acquisition=exposure)
        assert [i.exposed.detector_air_kerma_ugy for i in (split.left, split.right)] == [
            dose / 2,
            dose / 2,
        ]
        each = stereo_pair(ball, view, acquisition=exposure, dose="per_image")
        assert each.left.exposed.detector_air_kerma_ugy == dose
        mono = stereo_pair(ball, view, acquisition=exposure, mono="same_image")
        assert mono.left.exposed.detector_air_kerma_ugy == dose
    tube = Beam(kvp=70.0)
    whole = radiograph(ball, view, tube, acquisition=Acquisition(mas=4.0))
    half = stereo_pair(ball, view, tube, acquisition=Acquisition(mas=4.0))
    ratio = half.left.exposed.detector_air_kerma_ugy / whole.exposed.detector_air_kerma_ugy
    assert ratio == pytest.approx(0.5, rel=0.01), "but for the longer way"


@pytest.mark.parametrize("mono", ["same_image", "single"])
def test_the_mono_arm_is_the_radiograph_of_the_view_between_the_eyes(knee, knee_view, mono) -> None:
    exposure, noise = Acquisition(), NoiseKey(seed=11, case=2)
    view = knee_view(pixels=48)
    alone = radiograph(knee, view, acquisition=exposure, noise=noise)
    pair = stereo_pair(knee, view, acquisition=exposure, noise=noise, mono=mono)
    assert pair.left is pair.right
    np.testing.assert_array_equal(pair.left.signal, alone.signal)
    assert tuple(pair.images) == (("left", "right") if mono == "same_image" else ("mono",))
    assert pair.epipolar_matrix is None
    assert pair.comfort.level == "flat"
    assert pair.eyes.baseline_mm is None


def test_both_images_share_one_grey_scale(knee, knee_view) -> None:
    pair = stereo_pair(knee, knee_view("left_lateral"), baseline_mm=300)
    dark = Presentation(polarity="bones_dark", bits=16)
    levels = pair.presented("transmission", dark)
    values = np.concatenate([pair.left.transmission, pair.right.transmission])
    grey = np.concatenate([levels["left"], levels["right"]])
    share = (values - values.min()) / (values.max() - values.min())
    np.testing.assert_array_equal(grey, np.rint(share * 65535))
    assert pair.left.transmission.min() != pair.right.transmission.min(), "each alone would differ"
    for mode in ("percentile", "equalise"):
        order = np.argsort(values, axis=None)
        risen = np.concatenate(
            [*pair.presented("transmission", Presentation(mode=mode, bits=16)).values()]
        )
        steps = np.diff(risen.ravel()[order].astype(int))
        assert (steps <= 0).all(), "more transmission is never whiter, whichever eye has it"
    shown = pair.shown("transmission", None, "left")
    assert shown == pair.shown("transmission", None, "right")
    assert (shown["scope"], shown["shown"]) == ("pair", [values.min(), values.max()])


def test_an_eye_by_itself_is_presented_by_itself_when_asked(knee, knee_view) -> None:
    pair = stereo_pair(knee, knee_view("left_lateral"), baseline_mm=300)
    alone = Presentation(scope="image")
    levels = pair.presented("transmission", alone)
    for eye, image in (("left", pair.left), ("right", pair.right)):
        np.testing.assert_array_equal(levels[eye], image.presented("transmission", alone))
        assert {int(levels[eye].min()), int(levels[eye].max())} == {0, 255}
    window = Presentation(window_center=1.0, window_width=2.0)
    fixed = pair.presented("transmission", window)
    np.testing.assert_array_equal(fixed["left"], pair.left.presented("transmission", window))
    assert pair.shown("transmission", window, "left")["scope"] == "fixed"


def test_one_radiograph_has_no_scale_of_a_pair(knee, knee_view) -> None:
    image = radiograph(knee, knee_view(pixels=16))
    for ask in (image.presented, image.shown):
        with pytest.raises(InvalidInputError) as refusal:
            ask("signal", Presentation(scope="pair"))
        assert [p.path for p in refusal.value.problems] == ["/presentation/scope"]
    with pytest.raises(InvalidInputError) as refusal:
        Presentation(scope="pair", window_center=1, window_width=1)
    assert [p.path for p in refusal.value.problems] == ["/presentation/scope"]


def test_what_has_no_stereo_geometry_is_refused(knee, knee_view) -> None:
    view = knee_view(pixels=16)
    parallel = View(source=None, direction=[0, 1, 0], detector=view.detector)
    cases = [
        ({"view": parallel}, ["/stereo/method"]),
        (
            {"view": parallel, "zero_parallax": {"plane_mm": 900}},
            ["/stereo/method", "/stereo/zero_parallax/plane_mm"],
        ),
        ({"isocentre": [0, -2000, 0]}, ["/stereo/zero_parallax"]),
        ({"isocentre": [0, -2000, 0], "method": "rotate"}, ["/stereo/method"]),
        ({"noise": NoiseKey(eye=1)}, ["/noise/eye"]),
        ({"baseline_mm": 9e6, "zero_parallax": {"plane_mm": 1e-3}}, ["/stereo"]),
    ]
    for fields, paths in cases:
        chosen = {"view": view, **fields}
        with pytest.raises(InvalidInputError) as refusal:
            stereo_pair(knee, **chosen)
        assert [p.path for p in refusal.value.problems] == paths, fields
    turned = stereo_pair(knee, parallel, method="rotate", angle_deg=4.0)
    assert turned.eyes.angle_deg == pytest.approx(4)
    assert turned.eyes.baseline_mm is None


def test_the_whole_metadata_is_plain_json(knee, knee_view) -> None:
    import json

    pair = stereo_pair(knee, knee_view(pixels=16), acquisition=Acquisition(), baseline_mm=65)
    told = json.loads(json.dumps(pair.metadata(), allow_nan=False))
    assert told["stereo"]["baseline_mm"] == 65
    assert told["images"]["left"]["noise"]["eye"] != told["images"]["right"]["noise"]["eye"]
    assert told["images"]["left"]["view"] != told["images"]["right"]["view"] != told["view"]
    assert [d["name"] for d in told["disparities"]][:2] == ["femur", "patella"]


def test_progress_counts_both_images(knee, knee_view) -> None:
    told: list[tuple[int, int]] = []
    stereo_pair(knee, knee_view(pixels=64), progress=lambda done, of: told.append((done, of)))
    assert told[-1] == (128, 128)
    assert told == sorted(told)
