"""What is wrong with a chest is where it should be, and nowhere else."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.errors import InvalidInputError
from phantom.scene import Phantom
from phantom.tracing import materials_at, path_lengths
from phantoms.chest import abnormalities as known

WRONG: list[dict[str, Any]] = [
    {"type": "nodule", "site": "right middle lobe", "diameter_mm": 14.0, "density_g_cm3": 0.9},
    {"type": "mass", "site": "right upper lobe", "diameter_mm": 30.0},
    {"type": "effusion", "side": "right"},
    {"type": "pneumothorax", "side": "left"},
    {"type": "rib_fracture", "side": "left", "rib": 7, "gap_mm": 2.0, "step_mm": 4.0},
    {"type": "rib_lesion", "side": "right", "rib": 4, "length_mm": 20.0},
    {"type": "vertebral_lesion", "level": "T8"},
    {"type": "coin"},
    {"type": "tracheal_tube"},
]


@pytest.fixture(scope="module")
def healthy() -> Phantom:
    return library.build("chest")


@pytest.fixture(scope="module")
def ill() -> Phantom:
    return library.build("chest", abnormalities=WRONG)


def finding(chest: Phantom, name: str) -> Any:
    return next(one for one in chest.document.findings if one.name == name)


def test_the_twin_has_the_same_materials_and_leaves(healthy: Phantom, ill: Phantom) -> None:
    assert healthy.document.findings == ()
    assert [one.name for one in ill.document.findings] == [
        str(one["type"]).replace("_", " ") for one in WRONG
    ]
    assert ill.material_names[: len(healthy.material_names)] == healthy.material_names
    gone = set(healthy.leaf_names) - set(ill.leaf_names)
    assert {name.split("/")[0] for name in gone} == {"left rib 7"}
    for one in ill.document.findings:
        assert set(one.leaves) <= set(ill.leaf_names)


def test_rays_that_miss_what_is_wrong_are_bit_for_bit_the_twins(
    healthy: Phantom, ill: Phantom
) -> None:
    """A grid of rays from front to back; those that differ lie over something that is wrong."""
    x, z = (side.ravel() for side in np.meshgrid(np.arange(-150, 151, 9), np.arange(-170, 150, 9)))
    origins = np.stack([x, np.full(x.size, -500.0), z], axis=1)
    ways = np.broadcast_to([0.0, 1.0, 0.0], origins.shape)
    twin = path_lengths(healthy, origins, ways)
    paths = path_lengths(ill, origins, ways)
    differ = (paths[:, : twin.shape[1]] != twin).any(axis=1) | (paths[:, twin.shape[1] :] > 0).any(
        axis=1
    )
    boxes = dict(zip(ill.leaf_names, ill.leaf_bounds, strict=True))
    over = np.zeros(len(x), dtype=bool)
    for name in (leaf for one in ill.document.findings for leaf in one.leaves):
        low, high = boxes[name]
        over |= (x >= low[0]) & (x <= high[0]) & (z >= low[2]) & (z <= high[2])
    for low, high in (healthy.leaf_bounds[healthy.leaf_names.index("left rib 7/cortex")],):
        over |= (x >= low[0]) & (x <= high[0]) & (z >= low[2]) & (z <= high[2])
    assert differ.any()
    assert not (differ & ~over).any()
    assert (~differ).mean() > 0.4


@pytest.mark.parametrize(
    ("name", "material"),
    [
        ("nodule", "nodule"),
        ("mass", "mass"),
        ("rib lesion", "lytic bone"),
        ("vertebral lesion", "blastic bone"),
        ("coin", "steel"),
        ("effusion", "fluid"),
        ("pneumothorax", "air"),
    ],
)
def test_it_is_where_the_finding_says(ill: Phantom, name: str, material: str) -> None:
    at = materials_at(ill, np.array([finding(ill, name).center]))
    assert [ill.material_names[i] for i in np.flatnonzero(at[0])] == [material]


def test_a_nodule_is_as_wide_as_asked(ill: Phantom) -> None:
    centre = np.array(finding(ill, "nodule").center)
    index = ill.material_names.index("nodule")
    for way in np.eye(3):
        found = path_lengths(ill, [centre - 500.0 * way], [way])
        assert found[0, index] == pytest.approx(14.0, abs=1e-9)


def test_fragments_of_a_rib_lie_apart_by_the_gap(healthy: Phantom, ill: Phantom) -> None:
    centre = np.array(finding(ill, "rib fracture").center)
    bones = [ill.material_names.index(name) for name in ("cortical_bone", "spongiosa")]
    assert materials_at(healthy, centre[None])[0, bones].sum() > 0
    assert materials_at(ill, centre[None])[0, bones].sum() == 0


@pytest.mark.parametrize(
    ("given", "path"),
    [
        ({"type": "nodule", "site": "left apex", "offset_mm": [0.0, 0.0, 60.0]}, "offset_mm"),
        ({"type": "nodule", "site": "lingula", "offset_mm": [-60.0, 0.0, 0.0]}, "offset_mm"),
        ({"type": "mass", "site": "right apex", "diameter_mm": 80.0}, "diameter_mm"),
        ({"type": "vertebral_lesion", "offset_mm": [10.0, 0.0, 0.0]}, "diameter_mm"),
        ({"type": "nodule", "diameter_mm": 31.0}, "diameter_mm"),
        ({"type": "pneumothorax", "rim_mm": 4.0}, "rim_mm"),
        ({"type": "rib_fracture", "rib": 13}, "rib"),
        ({"type": "effusion", "depth_mm": 14.0}, "depth_mm"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(given: dict[str, Any], path: str) -> None:
    with pytest.raises(InvalidInputError) as refused:
        library.document("chest", {}, [given])
    (problem,) = refused.value.problems
    assert problem.path == f"/abnormalities/0/{path}"
    assert "found" in problem.message
    assert "expected" in problem.message


def test_no_nodule_in_a_lung_that_is_drawn_in() -> None:
    with pytest.raises(InvalidInputError) as refused:
        library.document(
            "chest", {}, [{"type": "nodule", "site": "lingula"}, {"type": "pneumothorax"}]
        )
    assert [problem.path for problem in refused.value.problems] == ["/abnormalities/0/site"]


def test_limits_of_sizes_give_valid_chests() -> None:
    largest: list[dict[str, Any]] = [
        {"type": "nodule", "diameter_mm": 30.0, "site": "right lower lobe"},
        {"type": "nodule", "diameter_mm": 2.0, "site": "right apex"},
        {"type": "effusion", "depth_mm": 120.0},
        {"type": "effusion", "depth_mm": 15.0, "side": "left"},
        {"type": "pneumothorax", "rim_mm": 60.0, "side": "left"},
        *({"type": "rib_fracture", "rib": n, "along": 0.08, "gap_mm": 5.0, "step_mm": 8.0}
          for n in (1, 6, 12)),
        {"type": "rib_fracture", "side": "left", "rib": 10, "along": 0.95, "gap_mm": 0.2,
         "step_mm": 0.0},
        {"type": "rib_lesion", "rib": 11, "length_mm": 50.0, "kind": "blastic"},
        {"type": "vertebral_lesion", "level": "T2", "diameter_mm": 4.0},
        {"type": "coin", "site": "stomach", "diameter_mm": 33.0},
        {"type": "coin", "site": "lower oesophagus", "diameter_mm": 14.0},
        {"type": "tracheal_tube", "tip_above_carina_mm": 5.0},
    ]  # fmt: skip
    assert {one["type"] for one in largest} | {"mass"} == set(known.KINDS)
    chest = library.build("chest", abnormalities=largest)
    assert len(chest.document.findings) == len(largest)
