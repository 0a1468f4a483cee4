"""Every family of generalized cylinders against the naive twin."""

import itertools
import json

import numpy as np
import pytest

from tests.oracles import families, rays
from tests.oracles.agreement import assert_agree
from tests.oracles.cylinders import Axis

ALL = [
    kinds
    for kinds in itertools.product(
        families.AXES, families.CONTOURS, families.SWEEPS, families.FRAMES
    )
    if families.allowed(kinds)
]


def covering():
    """Few of all combinations, so that every pair of kinds comes up once or more."""
    rng = np.random.default_rng(20)
    order = [ALL[i] for i in rng.permutation(len(ALL))]
    seen, chosen = set(), []
    for kinds in order:
        pairs = set(itertools.combinations(enumerate(kinds), 2))
        if len(pairs - seen) >= 3:
            seen |= pairs
            chosen.append(kinds)
    for kinds in order:
        pairs = set(itertools.combinations(enumerate(kinds), 2))
        if pairs - seen:
            seen |= pairs
            chosen.append(kinds)
    return chosen


def check(kinds, seed, count):
    rng = np.random.default_rng(seed)
    leaf = {"material": "m", **families.generalized_cylinder(rng, kinds)}
    document = {
        "format": "phantom/1",
        "name": "family",
        "materials": {"m": {"attenuation_per_mm": 0.02}},
        "solid": leaf,
    }
    document = json.loads(json.dumps(document))
    origins, directions = rays.through_ball(rng, count, 90.0)
    # Half of them past the axis, near enough to hit and to graze.
    near = Axis(document["solid"]["axis"])(rng.random(count // 2)) + rng.normal(
        0, 5, (count // 2, 3)
    )
    origins[::2] = near - 270 * directions[::2]
    lengths = assert_agree(document, origins, directions, (80.0, 480.0), 250.0, samples=600)
    assert np.count_nonzero(lengths) > 0


@pytest.mark.parametrize("kinds", covering(), ids="-".join)
def test_pairs_of_kinds(kinds):
    check(kinds, 21, 40)


@pytest.mark.nightly
@pytest.mark.parametrize("kinds", ALL, ids="-".join)
@pytest.mark.parametrize("seed", range(3))
def test_all_kinds(kinds, seed):
    check(kinds, 1000 + seed, 300)
