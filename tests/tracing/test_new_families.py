"""Formulas, matrices, morphs, corners and any outline against a naive twin."""

import itertools

import numpy as np
import pytest

import phantom
from tests.oracles import families_new, rays
from tests.oracles.comparison import compare
from tests.oracles.naive_new import Solid, Twin, axis_of

NIGHTLY_SOLIDS, NIGHTLY_RAYS = 2000, 200


TENSORS = (
    ("spline", "circle", "sharp morph", "up"),
    ("arc", "ellipse", "formula sweep", "frenet"),
    ("formula wave", "circle", "morph", "rotation_minimizing"),
)


def document(leaf):
    return {
        "format": "phantom/1",
        "name": "family",
        "materials": {"m": {"attenuation_per_mm": 0.02}},
        "solid": {"material": "m", **leaf},
    }


def drawn(rng, kinds):
    """A random document that is a solid, and its shape; what is refused must be none."""
    while True:
        tree = document(families_new.generalized_cylinder(rng, kinds))
        try:
            return tree, phantom.load(tree)
        except phantom.InvalidDocumentError as error:
            refusal = error
        kinds_told = {p.kind for p in refusal.problems}
        assert kinds_told <= {"local_overlap", "singular_sweep", "not_star_shaped"}
        assert Solid(tree["solid"]).is_none(), (kinds, str(refusal))


def figures(kinds, seed, count, samples=160):
    """Compare on rays of which half pass near the axis, some along its sections."""
    rng = np.random.default_rng(seed)
    tree, shape = drawn(rng, kinds)
    center = shape.compiled.scene.leaf_center[0]
    radius = float(shape.compiled.scene.leaf_radius[0])
    origins, directions = rays.through_ball(rng, count, radius, center)
    line = axis_of(tree["solid"]["axis"])
    s = rng.random(count)
    along = np.arange(count) % 4 == 3
    directions[along] -= (directions * line.tangent(s)).sum(axis=1)[along, None] * line.tangent(s)[
        along
    ]
    directions = rays.unit(directions)
    near = np.arange(count) % 4 > 0
    places = line(s) + rng.normal(0, 5, (count, 3))
    origins[near] = places[near] - 3 * radius * directions[near]
    twin = Twin(tree, 200)
    return compare(shape, twin, origins, directions, (1.0 * radius, 5.2 * radius), radius, samples)


def covering():
    """Few combinations in which most pairs of new kinds and frames come up."""
    product = itertools.product(
        (*families_new.NEW_AXES, "spline", "closed arc"),
        families_new.CONTOURS,
        ("formula scale", "formula all", "matrix", "all"),
        families_new.FRAMES,
    )
    new = {*families_new.NEW_AXES, *families_new.NEW_CONTOURS, *families_new.NEW_SWEEPS}
    new |= {*families_new.FRAMES}
    everything = [kinds for kinds in product if families_new.allowed(kinds)]
    order = [everything[i] for i in np.random.default_rng(71).permutation(len(everything))]
    seen, chosen = set(), []
    for least in (5, 4, 3):
        for kinds in order:
            pairs = {p for p in itertools.combinations(kinds, 2) if set(p) <= new}
            if len(pairs - seen) >= least:
                seen |= pairs
                chosen.append(kinds)
    # Tensor tables take seconds to build: one of each.
    return [*chosen, *TENSORS]


@pytest.mark.parametrize("kinds", covering(), ids=lambda kinds: "-".join(kinds).replace(" ", "_"))
def test_kinds_with_kinds(kinds):
    found = figures(kinds, 72, 20)
    assert found.hits > 0
    assert found.right(), found


@pytest.mark.parametrize("turn_deg", [0, 0.9, 1.7, 3.1, 7.3])
def test_the_tips_of_a_star_that_does_not_morph(turn_deg):
    """Rays across a tip, wherever it points, have the chord of the wedge that it is."""
    outer, inner, half = 20.0, 8.0, np.pi / 5
    angle = half * np.arange(10) + np.radians(turn_deg)
    radius = np.where(np.arange(10) % 2, inner, outer)
    star = (radius * np.array([np.cos(angle), np.sin(angle)])).T.tolist()
    contour = {"type": "polygon", "points": star, "corner_radius": 0}
    line = {"type": "line", "start": [0, 0, 0], "end": [0, 0, 10]}
    stops = [{"at": u, "contour": contour} for u in (0.0, 0.5, 1.0)]
    sweep = {"type": "morph", "contours": stops}
    leaf = {"type": "generalized_cylinder", "axis": line, "frame": {"up": [1, 0, 0]}}
    shape = phantom.load(document({**leaf, "sweep": sweep}))
    tips = angle[::2]
    # b is t x n: the section's plane is x and y.
    out = np.stack([np.cos(tips), np.sin(tips), 0 * tips], axis=1)
    along = np.cross([0, 0, 1], out)
    slope = inner * np.sin(half) / (outer - inner * np.cos(half))
    for depth in (1e-3, 1e-2, 0.1):
        origins = (outer - depth) * out - 50 * along + [0, 0, 5]
        lengths = phantom.path_lengths(shape, origins, along)[:, 0]
        assert lengths == pytest.approx(2 * depth * slope, abs=2e-7)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(10_000, 10_000 + NIGHTLY_SOLIDS))
def test_random_solids(seed, record_property):
    kinds = families_new.any_kinds(np.random.default_rng(seed))
    found = figures(kinds, seed, NIGHTLY_RAYS, 120)
    for name, value in vars(found).items():
        record_property(name, value)
    assert found.right(), (kinds, found)
