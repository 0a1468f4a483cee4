"""The paper's contrast stretching, in both polarities and depths."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging import Presentation, present

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
    ("field", "value"), [("bits", 12), ("mode", "window"), ("polarity", "white"), ("gamma", 2.2)]
)
def test_what_is_not_offered_is_refused(field: str, value: Any) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Presentation(**{field: value})
    assert [p.path for p in refusal.value.problems] == [f"/presentation/{field}"]
