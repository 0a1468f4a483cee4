"""Numbers as codes of 16 bits: nearest, stated, and with the ends where they are said to be."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest

from phantom.encode import encode
from phantom.encode.coding import Coding, coding


def test_a_line_integral_has_8192_codes_a_unit(shot) -> None:
    picture = shot()
    encoded = encode(picture, "line_integral", format="npy-uint16")
    codes = np.load(io.BytesIO(encoded.data))
    said = {k: encoded.beside["file"][k] for k in ("quantity", "codes_per_unit", "offset")}
    assert said == {"quantity": "line_integral", "codes_per_unit": 8192, "offset": 0}
    assert codes.dtype == np.dtype("<u2")
    assert np.abs(codes / 8192 - picture.quantity("line_integral")).max() <= 0.5 / 8192


@pytest.mark.parametrize(
    ("value", "code"),
    [(0.0, 0), (1.0, 8192), (0.49 / 8192, 0), (0.51 / 8192, 1), (7.99, 65454), (9.0, 65535),
     (-0.1, 0)],
)  # fmt: skip
def test_the_nearest_code_is_taken_and_the_ends_hold(value: float, code: int) -> None:
    assert Coding("line_integral", 8192).codes(np.array([[value]])) == code


def test_an_offset_leaves_room_below_zero() -> None:
    assert Coding("signal", 2, offset=100).codes(np.array([-3.0, 0.0, 5.0])).tolist() == [
        94,
        100,
        110,
    ]


@pytest.mark.parametrize(
    ("unit", "greatest", "per_unit"),
    [("1", 0.3, 65535), ("codes", 3.0, 1), ("codes", 16383.0, 1), ("photons", 70_000.0, 0.5),
     ("photons", 65_535.0, 1), ("photons", 300.0, 128), ("keV", 0.0, 1)],
)  # fmt: skip
def test_other_quantities_fill_the_range_without_passing_its_end(
    unit: str, greatest: float, per_unit: float
) -> None:
    values: Any = np.array([[0.0, greatest / 3, greatest]])
    chosen = coding("signal", values, unit)
    assert (chosen.codes_per_unit, chosen.offset) == (per_unit, 0)
    assert greatest * chosen.codes_per_unit <= 65_535
