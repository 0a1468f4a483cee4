"""The algebra of densities, against its table and against its own identities."""

import json

import numpy as np
import pytest

import phantom
from tests.oracles import documents, rays
from tests.oracles.agreement import assert_agree
from tests.oracles.naive import Twin

SPAN = (0.0, 520.0)


def plain(document):
    """As a reader of JSON would have it."""
    return json.loads(json.dumps(document))


def pair(seed):
    rng = np.random.default_rng(seed)
    kinds = list(documents._LEAVES)
    a = documents.leaf(rng, kinds[seed % len(kinds)])
    b = documents.leaf(rng, kinds[(seed // 2) % len(kinds)])
    return plain({**a, "material": "bone"}), plain({**b, "material": "soft"})


def lengths(operator, a, b, origins, directions):
    """Of bone and of soft."""
    tree = a if operator is None else {"type": operator, "solids": [a, b]}
    return phantom.path_lengths(phantom.load(documents.document(tree)), origins, directions)[:, :2]


@pytest.mark.parametrize("seed", range(16))
def test_identities_of_two_solids(seed):
    a, b = pair(seed)
    origins, directions = rays.through_ball(np.random.default_rng(seed), 1500, 35.0)

    def of(operator, left=a, right=b):
        return lengths(operator, left, right, origins, directions)

    only_a, only_b = of(None), of(None, b)
    both = of("intersection")
    assert np.all(both[:, 1] == 0)
    total = only_a.sum(axis=1) + only_b.sum(axis=1)
    # Ends are where they are whatever is made of them: only rounding differs.
    same = {"rtol": 0, "atol": 1e-10}
    np.testing.assert_allclose(of("union").sum(axis=1) + both.sum(axis=1), total, **same)
    np.testing.assert_allclose(of("difference"), only_a - both, **same)
    np.testing.assert_allclose(of("overlap"), only_a + only_b, **same)
    np.testing.assert_allclose(of("union")[:, 0], only_a[:, 0], **same)
    np.testing.assert_allclose(of("replace")[:, 1], only_b[:, 1], **same)
    np.testing.assert_allclose(of("replace")[:, 0], (only_a - both)[:, 0], **same)
    swapped = lengths("union", b, a, origins, directions)
    np.testing.assert_allclose(of("replace"), swapped, **same)
    np.testing.assert_allclose(
        lengths("intersection", b, a, origins, directions).sum(axis=1), both.sum(axis=1), **same
    )


@pytest.mark.parametrize("operator", documents.OPERATORS)
def test_the_table_itself(operator):
    """Two concentric balls and one ray through the middle: lengths one can say by heart."""
    big = {"type": "sphere", "center": [0, 0, 0], "radius": 10, "material": "bone"}
    near = {"type": "sphere", "center": [0, 0, 12], "radius": 4, "material": "soft"}
    # Along z: bone from -10 to 10, soft from 8 to 16; both from 8 to 10.
    wanted = {
        "union": (20, 6),
        "intersection": (2, 0),
        "difference": (18, 0),
        "overlap": (20, 8),
        "replace": (18, 8),
    }[operator]
    found = lengths(operator, big, near, [[0, 0, -50]], [[0, 0, 1]])[0]
    np.testing.assert_allclose(found, wanted, atol=1e-12)
    # The same from inside the both-part, at z = 9, on either side.
    wanted = {
        "union": ((1, 6), (19, 0)),
        "intersection": ((1, 0), (1, 0)),
        "difference": ((0, 0), (18, 0)),
        "overlap": ((1, 7), (19, 1)),
        "replace": ((0, 7), (18, 1)),
    }[operator]
    found = lengths(operator, big, near, [[0, 0, 9]] * 2, [[0, 0, 1], [0, 0, -1]])
    np.testing.assert_allclose(found, wanted, atol=1e-12)


@pytest.mark.parametrize("operator", documents.OPERATORS)
def test_many_solids_are_taken_from_the_left(operator):
    rng = np.random.default_rng(41)
    leaves = [plain(documents.leaf(rng)) for _ in range(5)]
    nested = leaves[0]
    for one in leaves[1:]:
        nested = {"type": operator, "solids": [nested, one]}
    flat = {"type": operator, "solids": leaves}
    origins, directions = rays.through_ball(rng, 2000, 40.0)
    found = [
        phantom.path_lengths(phantom.load(documents.document(t)), origins, directions)
        for t in (flat, nested)
    ]
    np.testing.assert_array_equal(*found)


def random_document(seed, depth):
    rng = np.random.default_rng(seed)
    definitions = {"one": documents.leaf(rng)}
    definitions["two"] = documents.tree(rng, 2, ("one",))
    solid = documents.tree(rng, depth, ("one", "two"))
    while solid["type"] not in documents.OPERATORS:
        solid = documents.tree(rng, depth, ("one", "two"))
    return plain(documents.document(solid, definitions))


def check_tree(seed, depth, count):
    rng = np.random.default_rng(seed + 1000)
    document = random_document(seed, depth)
    origins, directions = rays.through_ball(rng, count, 45.0)
    # Half of the sources are somewhere inside.
    origins[::2] += directions[::2] * rng.uniform(90, 150, (len(origins[::2]), 1))
    try:
        shape = phantom.load(document)
    except phantom.InvalidDocumentError as refused:
        # A random cut may leave nothing of a leaf, or a random bend fold it; that is all.
        if {p.kind for p in refused.problems} <= {"empty", "local_overlap"}:
            return False
        raise
    assert_agree(document, origins, directions, SPAN, 100.0, samples=600, shape=shape)
    return True


@pytest.mark.parametrize("depth", [1, 2, 3, 4, 5])
def test_random_trees(depth):
    done = sum(check_tree(100 * depth + k, depth, 12) for k in range(6))
    assert done >= 3


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(400))
def test_more_random_trees(seed):
    check_tree(10_000 + seed, 1 + seed % 5, 60)


def chest(count, seed=42):
    """Many small solids in a soft body, some of them overlapping."""
    rng = np.random.default_rng(seed)
    solids = [
        {"type": "ellipsoid", "center": [0, 0, 0], "semi_axes": [85, 60, 80], "material": "soft"}
    ]
    for _ in range(count):
        small = documents.leaf(rng, rng.choice(["sphere", "ellipsoid", "box", "cone", "quadric"]))
        small["material"] = str(rng.choice(["bone", "metal"]))
        small.pop("cuts", None)
        place = rays.unit(rng.standard_normal(3)) * rng.uniform(0, 60)
        solids.append(
            {"type": "transformed", "solid": small, "scale": 0.2, "translate": place.tolist()}
        )
    return plain(documents.document({"type": "replace", "solids": solids}))


def test_several_hundred_leaves():
    document = chest(300)
    origins, directions = rays.through_ball(np.random.default_rng(43), 25, 70.0)
    assert_agree(document, origins, directions, SPAN, 100.0, samples=1500)


def test_bounds_hold_what_is_left():
    """No point of the final solid lies outside the box that is told for it."""
    for seed in range(12):
        document = random_document(300 + seed, 3)
        try:
            shape = phantom.load(document)
        except phantom.InvalidDocumentError:
            continue
        twin = Twin(document)
        points = np.random.default_rng(seed).uniform(-100, 100, (4_000, 3))
        state = twin.survivors(points)
        inside = points[state.any(axis=1)]
        low, high = shape.bounds
        assert np.all((inside >= low - 1e-9) & (inside <= high + 1e-9))
        for k in range(len(twin.leaves)):
            mine = points[state[:, k]]
            low, high = shape.leaf_bounds[k]
            assert np.all((mine >= low - 1e-9) & (mine <= high + 1e-9)), shape.leaf_names[k]


def test_leaves_carry_their_materials_and_labels():
    rng = np.random.default_rng(44)
    named = {**documents.leaf(rng, "box"), "name": "tip"}
    solid = {
        "type": "union",
        "solids": [
            {"type": "transformed", "solid": documents.leaf(rng, "sphere")},
            {"type": "transformed", "name": "left", "solid": named, "scale": 1.5},
            {"type": "instance", "of": "other", "name": "right"},
        ],
    }
    definitions = {"other": {**named, "material": "metal"}}
    solid = {"type": "transformed", "name": "limb", "solid": solid, "translate": [1, 2, 3]}
    document = plain(documents.document(solid, definitions))
    shape = phantom.load(document)
    twin = Twin(document)
    assert shape.leaf_names == ("limb", "limb/left/tip", "limb/right/tip")
    given = [documents.MATERIALS.index(leaf["material"]) for leaf in twin.leaves]
    assert shape.leaf_materials.tolist() == given
