"""Uniform, normal and Poisson numbers at a pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

from phantom.errors import InvalidInputError
from phantom.imaging.detection import ELECTRONICS, QUANTA, NoiseKey
from phantom.imaging.detection.draws import normal, poisson, uniforms

KEY = NoiseKey(seed=7)


def pixels(rows: int, columns: int, key: NoiseKey = KEY, stage: int = QUANTA) -> Any:
    return uniforms(key, stage, np.arange(rows), np.arange(columns))[0]


@pytest.mark.parametrize("mean", [1e-3, 0.7, 5, 11.99, 12, 12.5, 14, 20, 77.3, 1e3, 2.5e5, 3e7])
def test_poisson_numbers_are_the_quantiles_of_the_distribution(mean: float) -> None:
    uniform = np.concatenate(
        [pixels(100, 200).ravel(), np.geomspace(1e-14, 0.5, 300), 1 - np.geomspace(1e-14, 0.5, 300)]
    )
    if mean > 1e6:
        # Farther out scipy's distribution function is wrong in the eighth digit at such a mean.
        uniform = uniform[(uniform > 1e-5) & (uniform < 1 - 1e-5)]
    found = poisson(uniform, np.full(uniform.shape, mean))
    law = stats.poisson(mean)
    # What is asked of n, by scipy's own distribution; its own rounding is left to it.
    assert (law.cdf(found) >= uniform * (1 - 1e-11)).all()
    below = law.cdf(found - 1)
    assert (below <= uniform * (1 + 1e-11)).all()


def test_a_mean_of_zero_gives_zero_and_shapes_mix() -> None:
    mean = np.array([[0.0, 3.0, 1e4], [-1.0, 12.0, 0.0]])
    found = poisson(np.full((2, 3), 0.5), mean)
    assert found.tolist() == [[0, 3, 1e4], [0, 12, 0]]


def test_numbers_rise_with_their_mean() -> None:
    means = np.sort(np.concatenate([np.linspace(0, 40, 2001), np.geomspace(40, 1e6, 2000)]))
    for uniform in (1e-9, 0.02, 0.4999, 0.77, 1 - 1e-7):
        assert (np.diff(poisson(np.full(means.shape, uniform), means)) >= 0).all()


def test_uniform_numbers_are_uniform_and_independent_of_their_neighbours() -> None:
    found = pixels(1000, 1000)
    count = found.size
    histogram = np.histogram(found, bins=100, range=(0, 1))[0]
    chi2 = float(((histogram - count / 100) ** 2 / (count / 100)).sum())
    assert stats.chi2(99).ppf(1e-5) < chi2 < stats.chi2(99).ppf(1 - 1e-5)
    centred = (found - 0.5) * np.sqrt(12)
    for other in (centred[1:, :] * centred[:-1, :], centred[:, 1:] * centred[:, :-1]):
        assert abs(other.mean()) < 4.5 / np.sqrt(other.size)


@pytest.mark.parametrize(
    "other",
    [
        NoiseKey(seed=8),
        NoiseKey(seed=7 + 2**32),
        NoiseKey(seed=7, case=1),
        NoiseKey(seed=7, case=2**32),
        NoiseKey(seed=7, view=1),
        NoiseKey(seed=7, eye=1),
    ],
)
def test_another_seed_case_view_or_eye_is_another_noise(other: NoiseKey) -> None:
    one, two = normal(pixels(300, 300)), normal(pixels(300, 300, other))
    assert abs((one * two).mean()) < 4.5 / 300
    one, two = pixels(50, 50), pixels(50, 50, stage=ELECTRONICS)
    assert not (one == two).any()


def test_a_pixel_has_its_number_wherever_it_is_computed() -> None:
    whole, second = uniforms(KEY, QUANTA, np.arange(40), np.arange(60))
    part, second_part = uniforms(KEY, QUANTA, np.arange(11, 29), np.arange(5, 47))
    assert (whole[11:29, 5:47] == part).all()
    assert (second[11:29, 5:47] == second_part).all()


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"seed": -1}, "/noise/seed"),
        ({"seed": 2**64}, "/noise/seed"),
        ({"seed": 1.5}, "/noise/seed"),
        ({"seed": True}, "/noise/seed"),
        ({"seed": 1, "case": "a"}, "/noise/case"),
        ({"seed": 1, "eye": 2**32}, "/noise/eye"),
    ],
)
def test_a_key_that_is_no_whole_number_in_range_is_refused(
    fields: dict[str, Any], path: str
) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        NoiseKey(**fields)
    assert [p.path for p in refusal.value.problems] == [path]
