"""Which colour a leaf has: its own, or that of what it is made of."""

import numpy as np
import pytest

import phantom
from phantom.visible.looks import linear, looks


def colors(materials, **look):
    """The rows of looks of one ball a material."""
    balls = [
        {"type": "sphere", "center": [30 * i, 0, 0], "radius": 9, "material": name, **look}
        for i, name in enumerate(materials)
    ]
    again = {**balls[0], "center": [0, 50, 0]}
    solid = {"type": "union", "solids": [*balls, again]}
    tree = {"format": "phantom/1", "name": "t", "materials": materials, "solid": solid}
    return looks(phantom.load(tree))


def reference(name):
    return {"reference": name}


def test_srgb_is_undone_as_the_standard_says():
    """IEC 61966-2-1: black, white, the foot of the curve, and 18 % grey at 118 of 255."""
    np.testing.assert_allclose(linear("#000000"), 0)
    np.testing.assert_allclose(linear("#ffffff"), 1)
    np.testing.assert_allclose(linear("#0a0a0a"), 10 / 255 / 12.92)
    np.testing.assert_allclose(linear("#767676"), 0.181, atol=5e-4)


def test_a_leafs_own_appearance_holds():
    own = {"color": [0.1, 0.2, 0.3], "ambient": 0.4, "diffuse": 0.3, "specular": 0.2, "exponent": 7}
    rows = colors({"bone": {"attenuation_per_mm": 1}}, appearance=own)
    np.testing.assert_array_equal(rows, [[0.1, 0.2, 0.3, 0.4, 0.3, 0.2, 7]] * 2)


def test_bone_is_lighter_than_flesh_and_flesh_is_redder():
    bone, muscle, bone_again = colors(
        {"a": reference("cortical_bone_icru44"), "b": reference("muscle_icru44")}
    )
    np.testing.assert_array_equal(bone, bone_again)
    assert np.all(bone[:3] > muscle[:3])
    assert bone[0] / bone[2] < 1.7 < muscle[0] / muscle[2]


def test_a_word_in_the_name_counts_before_the_reference():
    soft = reference("soft_tissue_icru44")
    named, other, _ = colors({"patellar tendon": soft, "thing": soft})
    assert not np.array_equal(named, other)
    marrow, bone, _ = colors({"bone marrow": soft, "bone": soft})
    assert not np.array_equal(marrow, bone)


@pytest.mark.parametrize("count", [2, 5])
def test_materials_of_no_kind_differ_from_their_neighbours(count):
    rows = colors({f"m{i}": {"attenuation_per_mm": 1} for i in range(count)})[:count]
    assert len(np.unique(rows[:, :3], axis=0)) == count


def test_no_look_gives_back_more_light_than_it_gets():
    names = ["water", "air", "skin_icru44", "steel", "glass", "pmma", "lung_icru44", "blood_icru44"]
    rows = colors({name: reference(name) for name in names})
    assert np.all(rows[:, 3:6].sum(axis=1) <= 1)
    assert np.all((rows[:, :3] >= 0) & (rows[:, :3] <= 1))
