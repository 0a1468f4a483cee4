"""People are spread as the published tables say."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.document import validate_model
from phantom.errors import InvalidInputError
from phantom.library import Person, PersonParameters, Population, mean_person


def _drawn(count, **settings):
    population = Population(**settings)
    return [
        population.draw(
            np.random.Generator(np.random.Philox(np.random.SeedSequence(7, spawn_key=(i,))))
        )
        for i in range(count)
    ]


def test_heights_and_weights_have_the_published_means():
    # National Health Statistics Reports 122 (2018), adults of 2015-2016: 175.4 cm, 89.8 kg and
    # 161.7 cm, 77.4 kg.
    for share, height_cm, weight_kg in ((0.0, 175.4, 89.8), (1.0, 161.7, 77.4)):
        people = _drawn(4000, female=share)
        heights = [p.height_cm for p in people]
        weights = [p.weight_kg for p in people]
        assert np.mean(heights) == pytest.approx(height_cm, abs=4 * np.std(heights) / 4000**0.5)
        assert np.mean(weights) == pytest.approx(weight_kg, rel=0.02)
        assert 0.2 < np.corrcoef(heights, weights)[0, 1] < 0.6


@pytest.mark.parametrize(
    ("sex", "by_70_cm", "by_80_cm"), [("male", 3.0, 5.0), ("female", 5.0, 8.0)]
)
def test_people_shrink_as_they_were_seen_to(sex, by_70_cm, by_80_cm):
    # Sorkin, Muller, Andres 1999.
    grown = mean_person(sex, 30.0).height_cm
    assert mean_person(sex, 20.0).height_cm == grown
    assert grown - mean_person(sex, 70.0).height_cm == pytest.approx(by_70_cm, abs=0.3)
    assert grown - mean_person(sex, 80.0).height_cm == pytest.approx(by_80_cm, abs=0.3)
    assert mean_person(sex, 80.0).tallness == pytest.approx(0.0, abs=0.01)


def test_shares_and_ages_are_as_asked():
    people = _drawn(4000, female=0.25, age_years=(30.0, 50.0))
    women = np.mean([p.sex == "female" for p in people])
    assert women == pytest.approx(0.25, abs=4 * (0.25 * 0.75 / 4000) ** 0.5)
    ages = [p.age_years for p in people]
    assert 30.0 <= min(ages) < 31.0 < 49.0 < max(ages) <= 50.0


def test_a_person_depends_on_nothing_but_the_generator():
    assert _drawn(3) == _drawn(3)


def test_what_is_left_out_of_a_person_is_the_mean_persons():
    assert PersonParameters(sex="female", age_years=45.0).person == mean_person("female")
    small = PersonParameters(sex="female", height_cm=150.0).person
    assert small.bmi == pytest.approx(mean_person("female").bmi, rel=2e-3)


@pytest.mark.parametrize(
    ("given", "path"),
    [
        ({"sex": "other"}, "/sex"),
        ({"age_years": 12}, "/age_years"),
        ({"height_cm": 20}, "/height_cm"),
        ({"weight_kg": "heavy"}, "/weight_kg"),
    ],
)
def test_nobody_is_out_of_range(given, path):
    with pytest.raises(InvalidInputError) as refusal:
        validate_model(PersonParameters, given)
    assert [p.path for p in refusal.value.problems] == [path]


def test_ages_run_upwards():
    with pytest.raises(InvalidInputError, match="youngest first"):
        validate_model(Population, {"age_years": [60, 30]})


def test_the_body_mass_index_is_weight_over_height_squared():
    assert Person(height_cm=200.0, weight_kg=80.0).bmi == 20.0
