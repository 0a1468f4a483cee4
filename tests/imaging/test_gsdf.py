"""The Grayscale Standard Display Function against the numbers that PS3.14 prints."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging import Presentation, present
from phantom.imaging.gsdf import Gsdf, jnd_index, luminance_cd_m2
from phantom.imaging.presentation import contrast_jnd

CALIBRATED = {"l_min_cd_m2": 0.5, "l_max_cd_m2": 400, "l_ambient_cd_m2": 0.3}
LEVELS = np.arange(256)
GAMMA = 0.5 + 399.5 * (LEVELS / 255) ** 2.2
"""A display as it comes: luminance rises with the 2.2th power of the drive level."""
MEASURED = {**CALIBRATED, "response": [[int(i), float(GAMMA[i])] for i in range(256)]}
RAMP = np.linspace(0, 1, 1001).reshape(1, -1)


def test_luminances_at_the_ends_are_those_of_table_b1() -> None:
    """Coefficients are printed to eight digits, which leaves 2e-5 at the bright end."""
    assert luminance_cd_m2(1) == pytest.approx(0.05, abs=5e-5)
    assert luminance_cd_m2(1023) == pytest.approx(3993.404, rel=2e-5)


def test_the_middle_is_that_of_another_program() -> None:
    """colour-science 0.4.2, ``colour.models.eotf_DICOMGSDF(512, in_int=True)``: 130.0652840."""
    assert luminance_cd_m2(512) == pytest.approx(130.0652840, abs=1e-6)


def test_indices_of_the_worked_example_of_annex_d() -> None:
    """PS3.14 D.2.3: a film from 12.0 to 1271.9 cd/m2, whose darkest has the index 233.32.

    The standard rounds luminances to a tenth, 0.37 of an index at 12 cd/m2, and uses equation 7-2.
    """
    assert jnd_index(12.0) == pytest.approx(233.32, abs=0.05)


def test_the_inverse_is_the_standards_polynomial_within_its_own_error() -> None:
    """PS3.14 equation 7-2, an approximation of its own; there and back to 1e-5."""
    powers = [71.498068, 94.593053, 41.912053, 9.8247004, 0.28175407]
    powers += [-1.1878455, -0.18014349, 0.14710899, -0.017046845]
    luminance = np.geomspace(0.05, 3993, 400)
    approximate = np.polynomial.polynomial.polyval(np.log10(luminance), powers)
    assert np.abs(jnd_index(luminance) - approximate).max() < 0.15
    indices = np.linspace(1, 1023, 3001)
    np.testing.assert_allclose(jnd_index(luminance_cd_m2(indices)), indices, rtol=0, atol=1e-5)


def test_a_threshold_contrast_is_that_of_bartens_eye() -> None:
    """Near 100 cd/m2 one index is just under 0.7 % of luminance (PS3.14, figure 7-1's slope)."""
    index = float(jnd_index(100.0))
    step = float(luminance_cd_m2(index + 1) / luminance_cd_m2(index)) - 1
    assert 0.005 < step < 0.01


def test_p_values_are_the_grey_levels_themselves() -> None:
    plain = present(RAMP, Presentation(polarity="bones_dark"))
    shown = present(RAMP, Presentation(polarity="bones_dark", gsdf=Gsdf(**CALIBRATED)))
    np.testing.assert_array_equal(shown, plain)


def test_drive_levels_make_a_measured_display_follow_the_standard() -> None:
    """What the eye gets, worked out from the display alone, is even in the JND index."""
    display = Gsdf(**MEASURED)
    levels = present(RAMP, Presentation(polarity="bones_dark", gsdf=display))[0]
    seen = jnd_index(GAMMA[levels] + 0.3)
    black, white = jnd_index([0.8, 400.3])
    even = black + RAMP[0] * (white - black)
    # Half a drive level is as near as whole levels come.
    half = 0.5 * np.diff(jnd_index(GAMMA + 0.3)).max()
    assert np.abs(seen - even).max() <= 1.02 * half
    assert levels[0] == 0
    assert levels[-1] == 255


def test_sixteen_bits_of_drive_levels_are_even_to_a_hundredth_of_a_jnd() -> None:
    table = [[257 * int(i), float(GAMMA[i])] for i in range(256)]
    display = Gsdf(**{**CALIBRATED, "response": table})
    levels = present(RAMP, Presentation(polarity="bones_dark", bits=16, gsdf=display))[0]
    between = np.interp(levels / 257, LEVELS, jnd_index(GAMMA + 0.3))
    black, white = jnd_index([0.8, 400.3])
    assert np.abs(between - black - RAMP[0] * (white - black)).max() < 0.05


def test_bones_white_turns_the_picture_before_it_reaches_the_display() -> None:
    display = Gsdf(**MEASURED)
    dark = present(RAMP, Presentation(polarity="bones_dark", gsdf=display))
    white = present(RAMP[:, ::-1], Presentation(gsdf=display))
    np.testing.assert_array_equal(white, dark)


@pytest.mark.parametrize("fields", [CALIBRATED, MEASURED])
def test_a_lesions_contrast_counts_the_steps_between_its_luminances(fields: Any) -> None:
    grey = np.full((8, 8), 100, dtype=np.uint8)
    grey[2:4, 2:4] = 110
    inside = grey == 110
    presentation = Presentation(gsdf=Gsdf(**fields))
    found = contrast_jnd(grey, inside, ~inside, presentation)
    if "response" in fields:
        expected = float(np.diff(jnd_index(GAMMA[[100, 110]] + 0.3))[0])
    else:
        black, white = jnd_index([0.8, 400.3])
        expected = float(10 / 255 * (white - black))
    assert found == pytest.approx(expected, rel=1e-9)
    assert contrast_jnd(grey, ~inside, inside, presentation) == pytest.approx(-found)


def test_ambient_light_takes_contrast_away() -> None:
    grey = np.array([[10, 30]], dtype=np.uint8)
    inside = np.array([[False, True]])
    contrasts = [
        contrast_jnd(
            grey,
            inside,
            ~inside,
            Presentation(gsdf=Gsdf(**{**MEASURED, "l_ambient_cd_m2": ambient})),
        )
        for ambient in (0.0, 1.0, 10.0)
    ]
    assert contrasts[0] > contrasts[1] > contrasts[2] > 0


@pytest.mark.parametrize(
    ("fields", "path", "kind"),
    [
        ({"l_max_cd_m2": 0.5}, "/l_max_cd_m2", "not_rising"),
        ({"l_max_cd_m2": 0.1}, "/l_max_cd_m2", "not_rising"),
        ({"l_min_cd_m2": 0.01, "l_ambient_cd_m2": 0.0}, "/l_min_cd_m2", "out_of_range"),
        ({"l_max_cd_m2": 3993.3}, "/l_max_cd_m2", "out_of_range"),
        ({"l_ambient_cd_m2": -1}, "/l_ambient_cd_m2", "out_of_range"),
        ({"response": [[0, 0.5]]}, "/response", "too_few"),
        ({"response": [[0, 0.5], [255, 0.5]]}, "/response/1/1", "not_rising"),
        ({"response": [[0, 0.5], [0, 400]]}, "/response/1/0", "not_rising"),
        ({"response": [[0, 0.9], [255, 500]]}, "/l_min_cd_m2", "out_of_range"),
        ({"response": [[0, 0.5], [255, 300]]}, "/l_max_cd_m2", "out_of_range"),
    ],
)
def test_a_display_that_cannot_be_is_refused(fields: Any, path: str, kind: str) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Gsdf(**{**CALIBRATED, **fields})
    assert [(p.path, p.kind) for p in refusal.value.problems] == [
        (f"/presentation/gsdf{path}", kind)
    ]


def test_drive_levels_must_fit_the_pixels() -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Presentation(gsdf={**CALIBRATED, "response": [[0, 0.5], [1023, 400]]})
    (problem,) = refusal.value.problems
    assert problem.path == "/presentation/gsdf/response/1/0"
    assert problem.kind == "out_of_range"


def test_a_contrast_needs_a_display_and_pixels() -> None:
    grey = np.zeros((2, 2), dtype=np.uint8)
    none = np.zeros((2, 2), dtype=bool)
    with pytest.raises(InvalidInputError) as refusal:
        contrast_jnd(grey, none, np.ones((3, 3), dtype=bool), Presentation())
    assert [p.path for p in refusal.value.problems] == ["/presentation/gsdf", "/inside", "/around"]
