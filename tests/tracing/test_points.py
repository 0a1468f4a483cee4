"""What is at a point, against membership by definition."""

import numpy as np
import pytest

import phantom
from tests.oracles import documents, families_new
from tests.oracles.naive_new import Twin

WALLS_MM = 1e-7


def assert_counts(tree, points):
    """Counts agree everywhere but within the tolerance of a surface, where either side will do."""
    shape, twin = phantom.load(tree), Twin(tree)
    found, wanted = phantom.materials_at(shape, points), twin.materials_at(points)
    assert found.shape == (len(points), len(shape.material_names))
    differ = np.any(found != wanted, axis=1)
    assert twin.surface_within(points[differ], WALLS_MM).all()
    assert np.count_nonzero(differ) < 3
    assert np.any(wanted)


@pytest.mark.parametrize("seed", range(10))
def test_trees_of_operators(seed):
    rng = np.random.default_rng(800 + seed)
    definitions = {"part": documents.tree(rng, 1)}
    solids = [documents.tree(rng, 2, ("part",)) for _ in range(3)]
    tree = documents.document({"type": "overlap", "solids": solids}, definitions)
    assert_counts(tree, rng.uniform(-60, 60, (3000, 3)))


@pytest.mark.parametrize(
    "kinds",
    [
        ("spline", "C spline", "rotate", "rotation_minimizing"),
        ("closed formula", "kidney formula", "formula all", "up"),
        ("formula helix", "sharp C", "matrix", "frenet"),
        ("arc", "sharp star", "formula scale", "rotation_minimizing"),
        ("formula wave", "circle", "sharp morph", "up"),
        ("closed arc", "polar formula", "formula sweep", "frenet"),
    ],
    ids="-".join,
)
def test_generalized_cylinders(kinds):
    rng = np.random.default_rng(820)
    leaf = {"material": "bone", **families_new.generalized_cylinder(rng, kinds)}
    tree = documents.document(leaf)
    low, high = phantom.load(tree).bounds
    assert_counts(tree, rng.uniform(low - 2, high + 2, (4000, 3)))


def test_a_cut_solid_in_a_hollow_one():
    """Non-star tubes among operators, transforms and cuts."""
    rng = np.random.default_rng(830)
    letter = families_new.generalized_cylinder(
        rng, ("spline", "C polygon", "none", "rotation_minimizing")
    )
    letter |= {"material": "bone", "cuts": [{"point": [0, 0, 20], "normal": [0.2, 0, 1]}]}
    ball = {"type": "sphere", "center": [0, 0, 10], "radius": 40, "material": "soft"}
    moved = {"type": "transformed", "solid": letter, **documents.motion(rng)}
    for operator in documents.OPERATORS:
        tree = documents.document({"type": operator, "solids": [ball, moved]})
        assert_counts(tree, rng.uniform(-45, 45, (4000, 3)))


def test_overlap_counts_a_material_twice():
    ball = {"type": "sphere", "center": [0, 0, 0], "radius": 10, "material": "bone"}
    shape = phantom.load(documents.document({"type": "overlap", "solids": [ball, ball]}))
    points = [[0, 0, 0], [0, 0, 9.999], [0, 0, 10.001]]
    assert phantom.materials_at(shape, points)[:, 0].tolist() == [2, 2, 0]
