"""Values are spread as their distributions say, each from a stream of its own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from phantom.datasets.draws import Choose, LogUniform, Normal, Uniform, chance, drawn, stream, word
from phantom.document import validate_model
from phantom.errors import InvalidInputError

CHANCES = np.linspace(0.001, 0.999, 41)


@pytest.mark.parametrize(
    ("value", "known"),
    [
        (Uniform(low=-2, high=5), stats.uniform(-2, 7)),
        (LogUniform(low=0.5, high=50), stats.loguniform(0.5, 50)),
        (
            Normal(mean=1, sd=2, low=0, high=8),
            stats.truncnorm((0 - 1) / 2, (8 - 1) / 2, loc=1, scale=2),
        ),
    ],
)
def test_quantiles_are_those_of_the_distribution(value, known):
    found = [value.at(c) for c in CHANCES]
    assert found == pytest.approx(known.ppf(CHANCES), rel=1e-9, abs=1e-9)


def test_choices_come_as_often_as_they_weigh():
    value = Choose(values=("a", "b", "c"), weights=(1, 0, 3))
    found = [value.at((k + 0.5) / 400) for k in range(400)]
    assert [found.count(x) for x in "abc"] == [100, 0, 300]


def test_a_stream_is_numpys_philox_of_its_key():
    sequence = np.random.SeedSequence(entropy=9, spawn_key=(4, 1))
    assert stream(9, 4, 1).random() == np.random.Generator(np.random.Philox(sequence)).random()


def test_streams_of_other_keys_are_independent():
    pairs = np.array([[chance(1, k, 0), chance(1, k, 1)] for k in range(2000)])
    assert stats.kstest(pairs[:, 0], "uniform").pvalue > 1e-3
    assert abs(np.corrcoef(pairs.T)[0, 1]) < 4 / 2000**0.5


def test_what_is_no_distribution_is_itself():
    assert drawn({"low": 1}, 3, 0) == {"low": 1}
    assert drawn(2.5, 3, 0) == 2.5


def test_the_number_of_a_name_is_the_crc_of_zip_and_ethernet():
    assert word("123456789") == 0xCBF43926


@pytest.mark.parametrize(
    ("model", "tree", "path"),
    [
        (Uniform, {"low": 2, "high": 1}, "/high"),
        (LogUniform, {"low": 0, "high": 1}, "/low"),
        (Normal, {"mean": 50, "sd": 1, "low": 0, "high": 1}, "/mean"),
        (Normal, {"mean": 0, "sd": 0, "low": 0, "high": 1}, "/sd"),
        (Choose, {"values": []}, "/values"),
        (Choose, {"values": [1, 2], "weights": [1]}, "/weights"),
        (Choose, {"values": [1, 2], "weights": [0, 0]}, "/weights"),
    ],
)
def test_what_cannot_be_drawn_is_refused(model, tree, path):
    with pytest.raises(InvalidInputError) as refusal:
        validate_model(model, tree)
    assert [p.path for p in refusal.value.problems] == [path]
