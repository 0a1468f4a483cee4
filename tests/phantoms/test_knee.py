"""The knee measured by the engine: published sizes, whole bones, and what can be wrong with it."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.library import Population
from phantom.scene import Phantom, load
from phantom.tracing import Intervals, intervals, path_lengths
from phantoms.knee import Parameters, build, of_person

BONES = ("femur", "tibia", "fibula", "patella")
FAR = 1000.0


@cache
def knee(sex: str = "male", side: str = "right", limb_mm: float = 150.0) -> Phantom:
    return library.build("knee", sex=sex, side=side, limb_mm=limb_mm)


@cache
def with_(*items: tuple[str, object]) -> Phantom:
    return library.build("knee", [dict(items)])


def along(phantom: Phantom, axis: str, first: Any, second: Any) -> Intervals:
    """Pieces of rays along an axis, through every pair of the other two coordinates."""
    index = "xyz".index(axis)
    others = [i for i in range(3) if i != index]
    grid = np.meshgrid(np.atleast_1d(first), np.atleast_1d(second), indexing="ij")
    origins = np.zeros((grid[0].size, 3))
    origins[:, others] = np.stack([side.ravel() for side in grid], axis=1)
    origins[:, index] = -FAR
    return intervals(phantom, origins, np.broadcast_to(np.eye(3)[index], origins.shape))


def of(found: Intervals, bone: str) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Pick the pieces of one bone."""
    wanted = [i for i, name in enumerate(found.leaf_names) if name.startswith(f"{bone}/")]
    return np.isin(found.leaf, wanted)


def extent_mm(found: Intervals, bone: str) -> float:
    rows = of(found, bone)
    return float(found.exit_mm[rows].max() - found.entry_mm[rows].min())


def joint_space_mm(phantom: Phantom, x: Any) -> float:
    """Least vertical distance of femur and tibia in a compartment."""
    found = along(phantom, "z", x, np.arange(0.0, 32.0, 0.5))
    count = int(found.ray.max()) + 1
    top, bottom = np.full(count, -np.inf), np.full(count, np.inf)
    tibia, femur = of(found, "tibia"), of(found, "femur")
    np.maximum.at(top, found.ray[tibia], found.exit_mm[tibia])
    np.minimum.at(bottom, found.ray[femur], found.entry_mm[femur])
    return float((bottom - top).min())


@pytest.mark.parametrize("sex", ["male", "female"])
def test_the_mean_persons_sizes_are_the_published_ones(sex: str) -> None:
    """Within a standard deviation; the sources are those that the document cites."""
    phantom, woman = knee(sex), sex == "female"
    across = along(phantom, "x", np.arange(-20.0, 45.0, 1.5), np.arange(2.0, 60.0, 1.5))
    assert extent_mm(across, "femur") == pytest.approx(78.5 if woman else 88.6, abs=3.0)
    depth = along(phantom, "y", np.arange(-40.0, 41.0, 1.5), np.arange(3.0, 45.0, 1.5))
    assert extent_mm(depth, "femur") == pytest.approx(55.5 if woman else 61.1, abs=2.6)
    plateau = along(phantom, "x", np.arange(-10.0, 36.0, 1.0), np.arange(-12.0, -3.5, 0.5))
    assert extent_mm(plateau, "tibia") == pytest.approx(67.6 if woman else 76.1, abs=3.1)
    deep = along(phantom, "y", np.arange(-34.0, 35.0, 1.0), np.arange(-12.0, -6.0, 0.5))
    assert extent_mm(deep, "tibia") == pytest.approx(43.2 if woman else 48.2, abs=2.5)
    medial = np.arange(14.0, 34.0, 0.5)
    assert joint_space_mm(phantom, medial) == pytest.approx(4.8 if woman else 5.7, abs=0.7)


@pytest.mark.parametrize(("sex", "share"), [("male", 1.045), ("female", 0.955)])
def test_patella_is_as_large_as_the_published_one(sex: str, share: float) -> None:
    """Both sexes: 34.4 ± 3.8, 44.8 ± 4.8, 22.4 ± 2.3 mm; a tenth between them."""
    phantom = knee(sex)
    x, y, z = phantom.document.landmarks["patella"]
    near = np.arange(-30.0, 31.0, 1.0)
    height = along(phantom, "z", x + near, y + near[::2])
    width = along(phantom, "x", y + near[::2], z + near)
    thickness = along(phantom, "y", x + near[::2], z + near)
    assert extent_mm(height, "patella") == pytest.approx(34.4 * share, abs=3.8 / 2)
    assert extent_mm(width, "patella") == pytest.approx(44.8 * share, abs=4.8 / 2)
    assert extent_mm(thickness, "patella") == pytest.approx(22.4 * share, abs=2.3 / 2)


@pytest.mark.parametrize(("sex", "width"), [("male", 26.5), ("female", 25.6)])
def test_cortex_at_midshaft_leaves_the_published_canal(sex: str, width: float) -> None:
    """Feik et al. 1997: the canal is 21 % of the young section, 23-24 % at 45 years.

    Of a round shaft the width of Karakaş and Harma's that leaves a wall of half of (1 - √share).
    """
    phantom = knee(sex, limb_mm=230.0)
    middle = {"male": 448.2, "female": 419.0}[sex] / 2
    found = along(phantom, "x", -1.2, middle)
    rows = of(found, "femur")
    names = [found.leaf_names[leaf] for leaf in found.leaf[rows]]
    lengths = (found.exit_mm - found.entry_mm)[rows]
    assert lengths.sum() == pytest.approx(width, abs=1.7)
    walls = [at for at, name in zip(lengths, names, strict=True) if name == "femur/cortex"]
    assert len(walls) == 2
    share = 0.235
    assert np.mean(walls) == pytest.approx(width / 2 * (1 - share**0.5), abs=0.8)
    assert names[0] == names[-1] == "femur/cortex"
    assert "femur/marrow" in names


def test_walls_thin_toward_the_joint() -> None:
    walls = []
    for z in (140.0, 105.0, 70.0):
        found = along(knee(), "x", 0.0, z)
        rows = of(found, "femur")
        walls.append((found.exit_mm - found.entry_mm)[rows][0])
    assert walls[0] > 1.3 * walls[1] > 1.3 * 1.5 * walls[2]
    assert walls[2] > 1.0


def test_lengths_set_by_hand_are_those_of_the_bones() -> None:
    phantom = library.build(
        "knee",
        bicondylar_width_mm=84.0,
        condylar_depth_mm=64.0,
        plateau_width_mm=80.0,
        plateau_depth_mm=46.0,
        slope_deg=6.0,
    )
    across = along(phantom, "x", np.arange(-10.0, 40.0, 1.0), np.arange(20.0, 45.0, 1.0))
    assert extent_mm(across, "femur") == pytest.approx(84.0, abs=0.4)
    depth = along(phantom, "y", np.arange(-40.0, 41.0, 1.0), np.arange(3.0, 48.0, 1.0))
    assert extent_mm(depth, "femur") == pytest.approx(64.0, abs=0.4)
    plateau = along(phantom, "x", np.arange(-10.0, 36.0, 1.0), np.arange(-14.0, -3.5, 0.5))
    assert extent_mm(plateau, "tibia") == pytest.approx(80.0, abs=0.4)
    deep = along(phantom, "y", np.arange(-36.0, 37.0, 1.0), np.arange(-14.0, -5.0, 0.5))
    assert extent_mm(deep, "tibia") == pytest.approx(46.0, abs=0.5)


@pytest.mark.parametrize("space", [2.5, 5.0, 9.0])
def test_joint_space_is_what_was_asked_for(space: float) -> None:
    phantom = library.build("knee", joint_space_mm=space)
    assert joint_space_mm(phantom, np.arange(14.0, 34.0, 0.5)) == pytest.approx(space, abs=0.1)


def test_a_left_knee_is_the_mirror_image() -> None:
    rng = np.random.default_rng(7)
    origins = rng.uniform(-200.0, 200.0, (2000, 3))
    directions = rng.uniform(-60.0, 60.0, (2000, 3)) - origins
    mirror = np.array([-1.0, 1.0, 1.0])
    right = path_lengths(knee(), origins, directions)
    left = path_lengths(knee(side="left"), origins * mirror, directions * mirror)
    assert (right > 0).any(axis=1).mean() > 0.5
    assert np.allclose(left, right, rtol=0, atol=1e-6)
    fibula = along(knee(side="left"), "x", 30.0, -80.0)
    assert fibula.entry_mm[of(fibula, "fibula")].min() - FAR > 20.0


def test_a_person_has_one_knee_and_people_differ() -> None:
    def drawn(seed: int) -> Parameters:
        generator = np.random.Generator(np.random.Philox(seed))
        return of_person(Population().draw(generator), generator)

    assert drawn(3) == drawn(3)
    assert len({drawn(seed).bicondylar_width_mm for seed in range(20)}) == 20


def test_knees_of_a_people_spread_as_published() -> None:
    generator = np.random.Generator(np.random.Philox(5))
    men = Population(female=0.0)
    people = [of_person(men.draw(generator), generator) for _ in range(800)]
    widths = np.array([p.bicondylar_width_mm for p in people], dtype=float)
    plateaus = np.array([p.plateau_width_mm for p in people], dtype=float)
    assert widths.mean() == pytest.approx(88.6, abs=0.5)
    assert widths.std() == pytest.approx(4.2, rel=0.1)
    assert plateaus.std() == pytest.approx(4.0, rel=0.1)
    assert np.corrcoef(widths, plateaus)[0, 1] > 0.6


def bones_alone(document: Any) -> list[Any]:
    tree = document.model_dump(mode="json")["solid"]
    parts = tree["solids"] if "solids" in tree else tree["solid"]["solids"]
    return [part for part in parts if any(b in (part.get("name") or "") for b in BONES)]


def shared_mm(document: Any, step_mm: float) -> float:
    """Longest stretch, of rays along the axes, on which bones lie in one another."""
    tree = document.model_dump(mode="json")
    bones = [part for part in bones_alone(document) if part["type"] == "transformed"]
    added, joined = (
        load({**tree, "findings": [], "solid": {"type": kind, "solids": bones}})
        for kind in ("overlap", "union")
    )
    low, high = joined.bounds
    worst = 0.0
    for index in range(3):
        others = [i for i in range(3) if i != index]
        sides = [np.arange(low[i], high[i], step_mm) for i in others]
        origins = np.zeros((len(sides[0]) * len(sides[1]), 3))
        origins[:, others] = np.stack([g.ravel() for g in np.meshgrid(*sides)], axis=1)
        origins[:, index] = -FAR
        directions = np.broadcast_to(np.eye(3)[index], origins.shape)
        more = path_lengths(added, origins, directions) - path_lengths(joined, origins, directions)
        worst = max(worst, float(more.sum(axis=1).max()))
    return worst


def bare_rays(phantom: Phantom, step_mm: float) -> list[str]:
    """Leaves besides skin that rays across the limb meet first or last."""
    limb = float(phantom.document.parameters["limb_mm"])  # type: ignore[arg-type]
    heights = np.arange(-limb + 0.5, limb, step_mm)
    outside: set[str] = set()
    for axis in "xy":
        found = along(phantom, axis, np.arange(-70.0, 71.0, step_mm), heights)
        new = np.diff(found.ray) != 0
        ends = np.r_[True, new] | np.r_[new, True]
        outside |= {found.leaf_names[leaf] for leaf in found.leaf[ends]}
    return sorted(outside - {"skin"})


def without_trabeculae(tree: Any) -> Any:
    """Return a solid without the plates."""
    if "solid" in tree:
        return {**tree, "solid": without_trabeculae(tree["solid"])}
    if "solids" not in tree:
        return tree
    parts = [
        without_trabeculae(part)
        for part in tree["solids"]
        if not (part.get("solid", {}).get("name") or "").startswith("trabecula")
    ]
    return {**tree, "solids": parts}


def drawn_document(index: int) -> Any:
    sequence = np.random.SeedSequence(1993, spawn_key=(index,))
    generator = np.random.Generator(np.random.Philox(sequence))
    return build(of_person(Population().draw(generator), generator))


def holds(document: Any, step_mm: float) -> None:
    assert shared_mm(document, step_mm) <= 0.1
    assert bare_rays(load(document.model_dump(mode="json")), 2 * step_mm) == []


@pytest.mark.parametrize("index", range(3))
def test_a_persons_bones_are_apart_and_under_the_skin(index: int) -> None:
    holds(drawn_document(index), 2.5)


@pytest.mark.nightly
@pytest.mark.parametrize("hundred", range(10))
def test_a_thousand_persons_bones_are_apart_and_under_the_skin(hundred: int) -> None:
    for index in range(100):
        holds(drawn_document(100 * hundred + index), 4.0)


@pytest.mark.parametrize("index", [6, 21])
def test_trabeculae_take_the_place_of_spongy_bone_alone(index: int) -> None:
    """Without them every ray crosses as much of everything else, and spongy bone in their stead."""
    tree = drawn_document(index).model_dump(mode="json")
    rng = np.random.default_rng(index)
    origins = rng.uniform(-120.0, 120.0, (8000, 3)) * [0.4, 0.4, 1.0] - [0.0, FAR, 0.0]
    directions = rng.normal([0.0, 1.0, 0.0], 0.02, origins.shape)
    phantom = load(tree)
    whole = path_lengths(phantom, origins, directions)
    plain = path_lengths(load(without_trabeculae(tree)), origins, directions)
    spongy, plates = (phantom.material_names.index(name) for name in ("spongiosa", "trabeculae"))
    assert whole[:, plates].max() > 2.0
    assert (plain[:, plates] == 0.0).all()
    whole[:, spongy] += whole[:, plates]
    others = np.arange(whole.shape[1]) != plates
    assert np.allclose(whole[:, others], plain[:, others], rtol=0, atol=1e-6)


def test_trabeculae_are_of_the_person() -> None:
    """Another seed is another pattern in the same bone; the twin with a lesion has the same one."""
    first, again = library.document("knee"), library.document("knee", {"age_years": 45.0})
    other = library.document("knee", {"trabecular_seed": 1})
    assert first.solid == again.solid
    assert first.solid != other.solid
    assert without_trabeculae(first.solid.model_dump(mode="json")) == without_trabeculae(
        other.solid.model_dump(mode="json")
    )
