"""The generator against the vectors its authors publish with it."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.imaging.detection.philox import fractions, philox4x32

# Random123 1.14, tests/kat_vectors, the three lines "philox4x32 10": counter, key, expected.
KNOWN = [
    (
        "00000000 00000000 00000000 00000000",
        "00000000 00000000",
        "6627e8d5 e169c58d bc57ac4c 9b00dbd8",
    ),
    (
        "ffffffff ffffffff ffffffff ffffffff",
        "ffffffff ffffffff",
        "408f276d 41c83b0e a20bc7c6 6d5451fd",
    ),
    (
        "243f6a88 85a308d3 13198a2e 03707344",
        "a4093822 299f31d0",
        "d16cfe09 94fdcceb 5001e420 24126ea1",
    ),
]


def words(text: str) -> list[int]:
    return [int(word, 16) for word in text.split()]


@pytest.mark.parametrize(("counter", "key", "expected"), KNOWN)
def test_known_answers(counter: str, key: str, expected: str) -> None:
    a, b, c, d = (np.full((2, 3), w, dtype=np.uint64) for w in words(counter))
    k0, k1 = words(key)
    found = philox4x32((a, b, c, d), (k0, k1))
    for array, word in zip(found, words(expected), strict=True):
        assert array.shape == (2, 3)
        assert (array == word).all()


def test_fractions_stay_inside_0_and_1() -> None:
    ends = np.array([0, 0xFFFFFFFF], dtype=np.uint64)
    assert fractions(ends, ends).tolist() == [2.0**-53, 1 - 2.0**-53]
    half = np.array([0x80000000], dtype=np.uint64)
    assert fractions(half, np.zeros(1, dtype=np.uint64))[0] == 0.5 + 2.0**-53
