"""Where prevalence is exact it is so to the case, in every split, and the cases are anyone."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from scipy import stats

from phantom.datasets.checks import check
from phantom.datasets.places import images_of_splits, place
from phantom.datasets.presence import allotted, cases_with, counts, present
from phantom.errors import InvalidInputError

WRONG = [{"type": "nodule", "prevalence": 0.3}, {"type": "void", "prevalence": 0.5}]
SPLITS = {"train": 0.7, "validation": 0.2, "test": 0.1}


def _seen(design):
    """Tell split by split which abnormalities each case has, from its first view."""
    step = len(design.views)
    return {
        split: [present(design, place(design, n)) for n in images[::step]]
        for split, images in images_of_splits(design).items()
    }


@pytest.mark.parametrize("exclusive", [False, True])
def test_every_split_has_its_share_to_the_case(design, exclusive):
    wanted = design(
        people=50,
        cases_per_person=2,
        views=[{"preset": "ap"}, {"preset": "pa"}],
        abnormalities=WRONG,
        exclusive=exclusive,
        exact_prevalence=True,
        splits=SPLITS,
    )
    found = _seen(wanted)
    for split, cases in (("train", 70), ("validation", 20), ("test", 10)):
        number = Counter(k for both in found[split] for k in both)
        assert number == {0: 0.3 * cases, 1: 0.5 * cases}
        if exclusive:
            assert max(map(len, found[split])) == 1
    assert cases_with(wanted) == {"nodule": 30, "void": 50}
    again = present(wanted, place(wanted, 2 * 7 + 1))
    assert again == found["train"][7], "both views of a case show the same"


def test_a_case_with_two_of_a_type_is_one_case(design):
    twice = [{"type": "nodule", "prevalence": 1.0}] * 2
    for exact in (False, True):
        assert cases_with(design(abnormalities=twice, exact_prevalence=exact)) == {"nodule": 10}


def test_what_whole_cases_do_not_allow_is_nearest_and_right_in_all(design):
    # 5 of 10: 4 of the 8, and of the two splits of one case one has it.
    wrong = [{"type": "nodule", "prevalence": 0.5}, {"type": "void", "prevalence": 0.5}]
    for exclusive in (False, True):
        wanted = design(abnormalities=wrong, exact_prevalence=True, exclusive=exclusive)
        found = counts(wanted)
        assert found["train"] == (4, 4)
        assert [sum(own[k] for own in found.values()) for k in (0, 1)] == [5, 5]
        if exclusive:
            assert sum(found["validation"]) == sum(found["test"]) == 1


def test_numbers_are_rounded_down_or_up_and_add_up_both_ways():
    """For shares and sizes at random; also where giving to the nearest alone would get stuck."""
    chance = np.random.default_rng(20261122)
    for _ in range(300):
        sizes = chance.integers(0, 12, chance.integers(1, 8))
        total = int(sizes.sum())
        shares = chance.multinomial(total, chance.dirichlet(np.ones(4)))[:3] / max(total, 1)
        found = np.array(allotted(shares.tolist(), sizes.tolist()))
        exact = np.outer(shares, sizes)
        assert np.all(np.abs(found - exact) < 1)
        assert np.array_equal(found.sum(axis=1), np.rint(shares * total))
        healthy = sizes - found.sum(axis=0)
        assert np.all(np.abs(healthy - (sizes - exact.sum(axis=0))) < 1)


def test_each_case_is_as_likely_as_any_other_and_abnormalities_are_independent(design):
    """Over seeds: which of 10 cases have the nodule, and of these how many the void too."""
    times, both, seeds = np.zeros(10), [], 600
    for seed in range(seeds):
        wanted = design(
            abnormalities=[{**WRONG[0], "prevalence": 0.4}, WRONG[1]],
            exact_prevalence=True,
            splits={"train": 1.0},
            seed=seed,
        )
        of = _seen(wanted)["train"]
        times += [0 in own for own in of]
        both.append(sum(len(own) == 2 for own in of))
    assert times.sum() == 4 * seeds
    # A case has it with chance 0.4, and the ten counts add up: 9 degrees of freedom.
    square = np.sum((times - 0.4 * seeds) ** 2) / (0.4 * 0.6 * seeds) * 0.9
    assert stats.chi2(9).sf(square) > 1e-3
    # 4 of 10 and 5 of 10 share 2 on average (hypergeometric).
    law = stats.hypergeom(10, 5, 4)
    assert np.mean(both) == pytest.approx(law.mean(), abs=4 * law.std() / seeds**0.5)


def test_an_unequal_share_is_refused_with_two_that_do(design):
    def asked(people, share):
        wrong = [{"type": "nodule", "prevalence": share}]
        return design(people=people, abnormalities=wrong, exact_prevalence=True)

    with pytest.raises(InvalidInputError, match=r"expected a whole number.* 0\.33 or 0\.34"):
        check(asked(100, 1 / 3))
    for people, share in ((100, 0.33), (100, 0.34), (30, 1 / 3)):
        check(asked(people, share))
