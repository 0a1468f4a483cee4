"""The paper's contrast stretching, in both polarities and depths."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging import Presentation, present
from phantom.imaging.presentation_stage import presentation_stage

RAMP = np.linspace(0.2, 0.7, 256).reshape(16, 16)


@pytest.mark.parametrize(("bits", "full"), [(8, 255), (16, 65535)])
def test_least_becomes_0_and_greatest_full_scale(bits: Any, full: int) -> None:
    grey = present(RAMP, Presentation(polarity="bones_dark", bits=bits))
    assert grey.dtype == np.dtype(f"uint{bits}")
    assert grey.shape == RAMP.shape
    assert grey[0, 0] == 0
    assert grey[-1, -1] == full
    expected = np.arange(256).reshape(16, 16) * (full // 255)
    np.testing.assert_array_equal(grey, expected)


@pytest.mark.parametrize("bits", [8, 16])
def test_bones_white_is_full_scale_minus_bones_dark(bits: Any) -> None:
    image = np.random.default_rng(0).uniform(0, 1, (30, 40))
    dark = present(image, Presentation(polarity="bones_dark", bits=bits))
    white = present(image, Presentation(polarity="bones_white", bits=bits))
    np.testing.assert_array_equal(white, (2**bits - 1) - dark.astype(int))


def test_much_attenuation_is_white_by_default_whichever_way_the_quantity_runs() -> None:
    line_integral = np.array([[0.0, 1.0, 3.0]])
    white = present(np.exp(-line_integral))
    assert white[0, 2] == 255
    assert white[0, 0] == 0
    risen = present(line_integral, rises_with_attenuation=True)
    assert risen.tolist() == [[0, 85, 255]]


@pytest.mark.parametrize("polarity", ["bones_white", "bones_dark"])
@pytest.mark.parametrize("level", [0.0, 1.0, 3.7])
def test_a_constant_image_gives_0(polarity: Any, level: float) -> None:
    assert not present(np.full((4, 5), level), Presentation(polarity=polarity)).any()


def test_neighbouring_doubles_still_span_the_scale() -> None:
    image = np.array([[1.0, np.nextafter(1.0, 2.0)]])
    assert present(image, Presentation(polarity="bones_dark")).tolist() == [[0, 255]]


@pytest.mark.parametrize(
    ("field", "value"),
    [("bits", 12), ("mode", "log"), ("scope", "set"), ("polarity", "white"), ("gamma", 2.2)],
)
def test_what_is_not_offered_is_refused(field: str, value: Any) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Presentation(**{field: value})
    assert [p.path for p in refusal.value.problems] == [f"/presentation/{field}"]


def dark(mode_fields: dict[str, Any], bits: Any = 8) -> Presentation:
    return Presentation(polarity="bones_dark", bits=bits, **mode_fields)


def test_a_window_has_its_middle_at_half_scale_and_its_ends_at_the_ends() -> None:
    """Centre 2 and width 3: line integrals from 0.5 to 3.5."""
    line_integral = np.array([[0.0, 0.5, 1.25, 2.0, 2.75, 3.5, 9.0]])
    window = Presentation(window_center=2, window_width=3)
    expected = [[0, 0, 64, 128, 191, 255, 255]]
    for grey in (
        present(line_integral, window, rises_with_attenuation=True),
        present(np.exp(-line_integral), window),
        present(40_000 * np.exp(-line_integral), window, open_field=40_000),
    ):
        assert np.abs(grey - np.array(expected, dtype=int)).max() <= 1
        assert grey[0, [0, 1, 5, 6]].tolist() == [0, 0, 255, 255]


def test_a_window_does_not_depend_on_the_rest_of_the_image() -> None:
    window = Presentation(window_center=1, window_width=2, bits=16)
    image = np.random.default_rng(1).uniform(0.1, 1, (20, 20))
    with_lesion = image.copy()
    with_lesion[3:5, 3:5] = 1e-6
    same = np.ones(image.shape, dtype=bool)
    same[3:5, 3:5] = False
    one, other = present(image, window), present(with_lesion, window)
    np.testing.assert_array_equal(one[same], other[same])


def test_no_signal_at_all_is_the_far_end_of_a_window() -> None:
    window = Presentation(window_center=1, window_width=2)
    assert present(np.array([[1.0, 0.0, -0.2]]), window).tolist() == [[0, 255, 255]]


def test_percentiles_of_a_hundred_steps_are_the_steps() -> None:
    """Of 0 to 100, the 10th and 90th percentiles are 10 and 90."""
    image = np.random.default_rng(2).permutation(101).reshape(1, -1).astype(float)
    grey = present(image, dark({"percentiles": (10, 90)}, 16))
    expected = np.rint(np.clip((image - 10) / 80, 0, 1) * 65535)
    np.testing.assert_array_equal(grey, expected)


def test_a_few_wild_pixels_move_the_stretch_but_not_the_percentiles() -> None:
    image = np.random.default_rng(3).uniform(0.4, 0.6, (100, 100))
    wild = image.copy()
    wild[0, :3] = 1e4
    percentile = dark({"mode": "percentile"})
    assert (
        np.abs(present(image, percentile)[1:].astype(int) - present(wild, percentile)[1:]).max() < 3
    )
    assert present(wild, dark({}))[1:].max() == 0


def test_equalisation_gives_every_grey_level_as_many_pixels() -> None:
    image = np.random.default_rng(4).lognormal(0, 2, (64, 64))
    grey = present(image, Presentation(mode="equalise"))
    counts = np.bincount(grey.ravel(), minlength=256)[1:255]
    assert np.abs(counts - 64 * 64 / 255).max() <= 1


def test_equalisation_is_the_same_of_the_transmission_and_of_the_line_integral() -> None:
    line_integral = np.random.default_rng(5).integers(0, 40, (30, 30)) / 8
    equalise = Presentation(mode="equalise", bits=16)
    np.testing.assert_array_equal(
        present(line_integral, equalise, rises_with_attenuation=True),
        present(np.exp(-line_integral), equalise),
    )


def test_a_large_open_field_takes_one_level_of_an_equalised_image() -> None:
    transmission = np.concatenate([np.ones(900), np.linspace(0.2, 0.8, 100)]).reshape(10, 100)
    grey = present(transmission, Presentation(mode="equalise"))
    assert not grey[:9].any()
    assert np.abs(np.sort(grey[9].astype(float)) - 255 * np.arange(1, 101) / 100).max() <= 0.5


@pytest.mark.parametrize("polarity", ["bones_white", "bones_dark"])
@pytest.mark.parametrize(
    "mode", [{"mode": "percentile"}, {"mode": "equalise"}, {"window_center": 1, "window_width": 1}]
)
def test_a_constant_image_gives_0_in_every_mode(mode: dict[str, Any], polarity: Any) -> None:
    assert not present(np.full((4, 5), 0.3), Presentation(polarity=polarity, **mode)).any()


def test_the_mode_and_the_scope_follow_from_what_is_given() -> None:
    told = [
        (p.mode, p.scope)
        for p in (
            Presentation(),
            Presentation(window_center=1, window_width=2),
            Presentation(scope="fixed"),
            Presentation(percentiles=(2, 98)),
            Presentation(mode="percentile"),
        )
    ]
    expected = [("stretch", "image"), ("window", "fixed"), ("window", "fixed")]
    assert told == [*expected, ("percentile", "image"), ("percentile", "image")]
    assert Presentation(mode="percentile").percentiles == (1, 99)


def test_a_window_that_nobody_gave_is_asked_for() -> None:
    with pytest.raises(InvalidInputError) as refusal:
        present(RAMP, Presentation(scope="fixed"))
    (problem,) = refusal.value.problems
    assert (problem.path, problem.kind) == ("/presentation/window_center", "missing")


@pytest.mark.parametrize(
    ("fields", "path", "kind"),
    [
        ({"window_center": 1, "window_width": 0}, "window_width", "out_of_range"),
        ({"window_center": 1, "window_width": -2}, "window_width", "out_of_range"),
        ({"window_center": 1}, "window_width", "missing"),
        ({"window_width": 1}, "window_center", "missing"),
        ({"percentiles": (99, 1)}, "percentiles", "not_rising"),
        ({"mode": "stretch", "percentiles": (1, 99)}, "percentiles", "no_effect"),
        (
            {"mode": "equalise", "window_center": 1, "window_width": 1},
            "window_center",
            "no_effect",
        ),
        ({"mode": "stretch", "scope": "fixed"}, "scope", "contradiction"),
        ({"mode": "window", "scope": "image"}, "scope", "contradiction"),
    ],
)
def test_what_contradicts_itself_is_refused(fields: Any, path: str, kind: str) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Presentation(**fields)
    found = {(p.path, p.kind) for p in refusal.value.problems}
    assert (f"/presentation/{path}", kind) in found


@pytest.mark.parametrize(
    ("wanted", "rises", "shown"),
    [
        ({}, False, [0.0, 200.0]),
        ({"percentiles": (10, 90)}, False, [20.0, 180.0]),
        ({"window_center": 100, "window_width": 50}, True, [75.0, 125.0]),
        ({"window_center": 1, "window_width": 2}, False, [400 * np.exp(-2), 400.0]),
        ({"mode": "equalise"}, False, None),
    ],
)
def test_the_stage_tells_the_values_at_the_ends_of_the_scale(
    wanted: Any, rises: bool, shown: Any
) -> None:
    image = np.arange(201.0).reshape(3, 67)
    stage = presentation_stage(
        image, Presentation(**wanted), rises_with_attenuation=rises, open_field=400
    )
    assert stage["stage"] == "presentation"
    assert stage.get("shown") == (None if shown is None else pytest.approx(shown))
    assert None not in stage.values()
    assert "constant" not in stage


def test_a_window_beyond_all_numbers_still_tells_its_stage() -> None:
    wide = Presentation(window_center=0, window_width=1e6)
    assert presentation_stage(RAMP, wide)["shown"] == [0.0, None]


def test_the_stage_tells_of_a_constant_image_and_of_the_display() -> None:
    display = {"l_min_cd_m2": 1, "l_max_cd_m2": 300}
    stage = presentation_stage(np.ones((2, 2)), Presentation(gsdf=display))
    assert (stage["constant"], stage["levels"]) == (True, "P-values")
    assert stage["jnd_range"][0] < stage["jnd_range"][1]
