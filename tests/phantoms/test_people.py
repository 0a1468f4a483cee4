"""Bones, fat and density over people, against what is published of them."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.library import Person, Population, mean_person
from phantoms.people import (
    Measure,
    canal_share,
    cortex_share,
    cortical_density_g_cm3,
    fat_mm,
    spongiosa_density_g_cm3,
)

BICONDYLAR = Measure((88.6, 4.2), (78.5, 3.0))


def crowd(count=3000, **settings):
    """People, and a standard normal number for each."""
    generator = np.random.Generator(np.random.Philox(11))
    population = Population(**settings)
    return [(population.draw(generator), generator.standard_normal()) for _ in range(count)]


@pytest.mark.parametrize(("share", "mean", "sd"), [(0.0, 88.6, 4.2), (1.0, 78.5, 3.0)])
def test_lengths_have_the_mean_and_the_spread_of_their_measure(share, mean, sd):
    people = crowd(female=share)
    lengths = [BICONDYLAR.of(person, scatter) for person, scatter in people]
    assert np.mean(lengths) == pytest.approx(mean, abs=0.3)
    assert np.std(lengths) == pytest.approx(sd, rel=0.06)
    tall = [person.tallness for person, _ in people]
    assert np.corrcoef(tall, lengths)[0, 1] == pytest.approx(0.6, abs=0.05)


def test_bones_keep_their_length_when_people_shrink():
    for sex in ("male", "female"):
        young, old = mean_person(sex, 25.0), mean_person(sex, 85.0)
        assert young.height_cm - old.height_cm > 5.0
        assert BICONDYLAR.of(old) == pytest.approx(BICONDYLAR.of(young), abs=0.05)


def test_canal_widens_as_at_the_femurs_midshaft():
    """Feik, Thomas, Clement 1997: void of 25 % becomes 37 % and 50 %, with its pores."""
    for sex, void in (("male", 0.37), ("female", 0.50)):
        young, old = canal_share(mean_person(sex, 25.0)), canal_share(mean_person(sex, 85.0))
        assert young + 0.05 * (1.0 - young) == pytest.approx(0.25, abs=0.01)
        assert old + 0.09 * (1.0 - old) == pytest.approx(void, abs=0.01)
    # 26.5 mm across (Karakaş 2008): a cortex of 6 to 8 mm in a young man.
    assert 6.0 < 13.25 * cortex_share(mean_person("male", 25.0)) < 8.0


@pytest.mark.parametrize(("sex", "lost"), [("male", 0.18), ("female", 0.25)])
def test_density_falls_over_life_as_published(sex, lost):
    """Riggs et al. 2004."""
    young, old = mean_person(sex, 20.0), mean_person(sex, 90.0)
    assert cortical_density_g_cm3(young) == 1.92
    assert cortical_density_g_cm3(old) / 1.92 == pytest.approx(1.0 - lost)
    assert spongiosa_density_g_cm3(mean_person(sex, 45.0)) == pytest.approx(1.18)
    for central in (False, True):
        losses = [spongiosa_density_g_cm3(p, central=central) for p in (young, old)]
        assert 1.18 < losses[0] < 1.31
        assert 0.98 < losses[1] < 1.12


def test_fat_goes_with_the_body_mass_index():
    """Cotofana et al. 2020: r = 0.75."""
    people = crowd(female=0.0)
    logs = [np.log(fat_mm(person, 6.0, 11.0, scatter=at)) for person, at in people]
    found = np.corrcoef(logs, [person.bmi for person, _ in people])[0, 1]
    assert found == pytest.approx(0.75, abs=0.04)
    lean, stout = (Person(height_cm=175.0, weight_kg=kg) for kg in (67.4, 107.2))
    assert fat_mm(stout, 6.0, 11.0) / fat_mm(lean, 6.0, 11.0) == pytest.approx(np.exp(1.04), 0.01)
