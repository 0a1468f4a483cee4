"""The chest measured by the engine: published widths, and what no chest may be."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.scene import Phantom, load
from phantom.tracing import Intervals, intervals, materials_at, path_lengths

Along = Callable[..., Intervals]
SEXES = ("male", "female")

# Means and standard deviations on PA radiographs, mm: Pan African Medical Journal 2017, 27:201.
HEART = {"male": (130.8, 12.0), "female": (129.0, 13.0)}
CHEST = {"male": (297.0, 27.0), "female": (271.0, 26.0)}
RATIO = {"male": (0.466, 0.039), "female": (0.478, 0.048)}
# Apex to right and left dome on PA radiographs: West African Journal of Medicine 2007.
DOMES = {"male": (229.0, 244.0), "female": (215.0, 226.0)}
SOURCE_MM, DETECTOR_MM = 1650.0, -150.0


@pytest.fixture(scope="module")
def chests() -> dict[str, Phantom]:
    return {sex: library.build("chest", sex=sex) for sex in SEXES}


def shadow(chest: Phantom, x_mm: Any, z_mm: Any) -> tuple[Intervals, Any, Any]:
    """Pieces along rays of a PA view to points of its detector, and those points."""
    aim = np.array(chest.isocentre)
    x, z = (side.ravel() for side in np.meshgrid(x_mm, z_mm, indexing="ij"))
    source = aim + np.array([0.0, SOURCE_MM, 0.0])
    points = np.stack([x, np.full(x.size, aim[1] + DETECTOR_MM), z], axis=1)
    found = intervals(chest, np.broadcast_to(source, points.shape), points - source)
    return found, x, z


def where(found: Intervals, *names: str) -> Any:
    """Pick the rows of leaves by their labels' first or last words."""
    wanted = [i for i, leaf in enumerate(found.leaf_names) if leaf.startswith(names)]
    return np.isin(found.leaf, wanted)


@pytest.mark.parametrize("sex", SEXES)
def test_heart_chest_and_lungs_on_the_film_are_those_of_people(
    chests: dict[str, Phantom], sex: str
) -> None:
    chest = chests[sex]
    across, along = np.arange(-170.0, 170.5, 1.0), np.arange(-115.0, 20.0, 9.0)
    found, x, _ = shadow(chest, across, along)
    heart = np.ptp(x[found.ray[where(found, "heart")]])
    lungs = np.ptp(x[found.ray[where(found, "left lung", "right lung")]])
    assert abs(heart - HEART[sex][0]) < HEART[sex][1] / 2
    assert abs(lungs - CHEST[sex][0]) < CHEST[sex][1] / 2
    assert abs(heart / lungs - RATIO[sex][0]) < RATIO[sex][1]
    assert heart / lungs < 0.5

    for side, sign, height in (("right", -1.0, DOMES[sex][0]), ("left", 1.0, DOMES[sex][1])):
        found, _, z = shadow(chest, sign * np.array([45.0, 60.0, 75.0]), np.arange(-190.0, 160.0))
        dome = z[found.ray[where(found, "liver" if side == "right" else "stomach and spleen")]]
        found, _, top = shadow(chest, sign * np.arange(25.0, 60.0, 5.0), np.arange(80.0, 160.0))
        apex = top[found.ray[where(found, f"{side} lung")]].max()
        assert apex - dome.max() == pytest.approx(height, abs=12.0)


def test_right_dome_is_the_higher(chests: dict[str, Phantom]) -> None:
    for chest in chests.values():
        tops = dict(zip(chest.leaf_names, chest.leaf_bounds[:, 1, 2], strict=True))
        assert 8.0 < tops["liver"] - tops["stomach and spleen"] < 25.0


@pytest.mark.parametrize("sex", SEXES)
def test_section_and_wall_of_the_sixth_rib(
    chests: dict[str, Phantom], sex: str, along: Along
) -> None:
    """Measured where the rib runs straight forward: across is then along x, high along z."""
    chest = chests[sex]
    name = "left rib 6/cortex"
    low, high = chest.leaf_bounds[chest.leaf_names.index(name)]
    found = along(chest, "x", np.array([0.0]), np.arange(low[2], high[2], 0.25))
    rows = where(found, name)
    outer = np.isin(found.leaf, [chest.leaf_names.index("left rib 6/spongiosa")])
    assert rows.any()
    assert outer.any()
    both = rows | outer
    rays = np.unique(found.ray[both])
    ends = (np.concatenate([found.entry_mm[on], found.exit_mm[on]]) for on in
            (both & (found.ray == ray) for ray in rays))  # fmt: skip
    thickness = [np.ptp(places) for places in ends]
    walls = [
        (found.exit_mm - found.entry_mm)[rows & (found.ray == r)]
        for r in rays
        if (rows & (found.ray == r)).sum() == 2
    ]
    expected = {"male": 7.2, "female": 6.6}[sex]
    assert max(thickness) == pytest.approx(expected, rel=0.15)
    # Journal of Anatomy 2019, 235:883: 1.4 mm on average, 0.9 to 2.6 mm among people.
    assert min(wall.min() for wall in walls) == pytest.approx(1.4, abs=0.25)


def test_vertebrae_and_discs(chests: dict[str, Phantom], along: Along) -> None:
    """Bodies of T2 to T8 (dry bones of both sexes), anterior heights of discs in men."""
    sizes = []
    for chest in chests.values():
        for level in ("T2", "T3", "T4", "T5", "T6", "T7", "T8"):
            low, high = chest.leaf_bounds[chest.leaf_names.index(f"{level}/cortex")]
            middle = (low + high) / 2
            wide = along(chest, "x", middle[1], high[2] - 4.0)
            deep = along(chest, "y", 0.0, middle[2] + 4.0)
            tall = along(chest, "z", 0.0, middle[1])
            sizes.append([_span(found, f"{level}/") for found in (wide, deep, tall)])
    for mean, (published, sd) in zip(
        np.mean(sizes, axis=0), ((27.0, 2.1), (20.8, 3.4), (17.2, 1.7)), strict=True
    ):
        assert abs(mean - published) < sd

    man = chests["male"]
    for upper, lower, published, sd in (("T4", "T5", 2.7, 0.7), ("T10", "T11", 5.4, 1.2)):
        low, high = man.leaf_bounds[man.leaf_names.index(f"{lower}/cortex")]
        found = along(man, "z", 0.0, (low[1] + high[1]) / 2 - 3.0)
        above, below = where(found, f"{upper}/"), where(found, f"{lower}/")
        gap = found.entry_mm[above].min() - found.exit_mm[below].max()
        assert abs(gap - published) < sd


def _span(found: Intervals, name: str) -> float:
    rows = where(found, name + "cortex", name + "spongiosa")
    return float(found.exit_mm[rows].max() - found.entry_mm[rows].min())


def test_the_aorta_is_as_wide_as_an_aorta(chests: dict[str, Phantom], along: Along) -> None:
    """Journal of Thoracic and Cardiovascular Surgery 2002, 123:1060, both sexes together."""
    across = []
    for chest in chests.values():
        found = along(chest, "x", np.arange(0.0, 70.0, 2.0), -70.0)
        rows = where(found, "aorta")
        across.append((found.exit_mm - found.entry_mm)[rows].max())
    assert abs(np.mean(across) - 24.3) < 3.5


def bare(chest: Phantom, step_mm: float) -> set[str]:
    """Leaves besides skin that rays across the body meet first or last, but at its cut ends."""
    low, high = chest.bounds
    found: set[str] = set()
    for axis in (0, 1):
        others = [i for i in range(3) if i != axis]
        sides = [np.arange(low[i] + 2.5, high[i] - 2.5, step_mm) for i in others]
        origins = np.zeros((len(sides[0]) * len(sides[1]), 3))
        origins[:, others] = np.stack([g.ravel() for g in np.meshgrid(*sides)], axis=1)
        origins[:, axis] = -1000.0
        pieces = intervals(chest, origins, np.broadcast_to(np.eye(3)[axis], origins.shape))
        new = np.diff(pieces.ray) != 0
        for rows, place in (
            (np.r_[True, new], pieces.entry_mm),
            (np.r_[new, True], pieces.exit_mm),
        ):
            at = origins[pieces.ray[rows]]
            at[:, axis] += place[rows]
            # Hanging arms are cut at a plane, which takes in the lowest of their fat.
            cut = np.minimum(np.abs(at - low), np.abs(at - high))[:, [0, 2]].min(axis=1) < 8.0
            leaves = np.unique(pieces.leaf[rows][~cut])
            materials = np.array(chest.material_names)[chest.leaf_materials[leaves]]
            found |= {chest.leaf_names[leaf] for leaf in leaves[materials != "skin"]}
    return found


BONES = ("clavicle", "scapula", "humerus", "sternum")


def bones(tree: dict[str, Any]) -> list[dict[str, Any]]:
    """The solids of a document's tree that are each one bone."""
    name = str(tree.get("name") or "")
    if name.endswith(BONES) or " rib " in name or re.fullmatch(r"[CTL]\d+", name):
        return [tree] if tree["type"] == "transformed" else []
    return [one for part in tree.get("solids", ()) for one in bones(part)]


def shared_mm(document: Any, step_mm: float) -> float:
    """Longest stretch, on rays along the axes, of one bone within another."""
    tree = document.model_dump(mode="json")
    parts = bones(tree["solid"])
    assert len(parts) == 24 + 1 + 19 + 6
    added, joined = (
        load({**tree, "findings": [], "solid": {"type": kind, "solids": parts}})
        for kind in ("overlap", "union")
    )
    low, high = joined.bounds
    worst = 0.0
    for axis in range(3):
        others = [i for i in range(3) if i != axis]
        sides = [np.arange(low[i], high[i], step_mm) for i in others]
        origins = np.zeros((len(sides[0]) * len(sides[1]), 3))
        origins[:, others] = np.stack([g.ravel() for g in np.meshgrid(*sides)], axis=1)
        origins[:, axis] = -1000.0
        ways = np.broadcast_to(np.eye(3)[axis], origins.shape)
        more = path_lengths(added, origins, ways) - path_lengths(joined, origins, ways)
        worst = max(worst, float(more.sum(axis=1).max()))
    return worst


def holds(parameters: Any, step_mm: float) -> None:
    document = library.entry("chest").build(parameters)
    assert shared_mm(document, step_mm) <= 0.1
    assert bare(load(document.model_dump(mode="json")), step_mm) == set()


def drawn(index: int) -> Any:
    """A person of the usual population, every other one with raised arms."""
    generator = np.random.Generator(np.random.Philox(np.random.SeedSequence(9, spawn_key=(index,))))
    of_person = library.entry("chest").of_person
    assert of_person is not None
    person = of_person(library.Population().draw(generator), generator)
    return person.model_copy(update={"arms": ("at_sides", "raised")[index % 2]})


@pytest.mark.parametrize("index", range(2))
def test_bones_are_apart_and_under_the_skin(index: int) -> None:
    holds(drawn(index), 8.0)


def test_no_rib_runs_through_a_lung(chests: dict[str, Phantom], along: Along) -> None:
    """Points on the ribs' surfaces are not in the lungs of the same chest without its ribs."""
    for chest in chests.values():
        y, z = np.arange(-90.0, 90.0, 9.0), np.arange(-140.0, 120.0, 6.0)
        found = along(chest, "x", y, z)
        rows = where(found, "left rib", "right rib")
        grid = np.stack([side.ravel() for side in np.meshgrid(y, z, indexing="ij")], axis=1)
        points = np.concatenate(
            [
                np.column_stack([x[rows], grid[found.ray[rows]]])
                for x in (found.entry_mm, found.exit_mm)
            ]
        )
        assert len(points) > 1000
        tree = chest.document.model_dump(mode="json")
        tree["solid"]["solids"] = [
            part
            for part in tree["solid"]["solids"]
            if not any(" rib " in (one.get("name") or "") for one in part.get("solids", ()))
        ]
        bare = load(tree)
        assert len(bare.leaf_names) == len(chest.leaf_names) - 48
        inside = materials_at(bare, points)[:, bare.material_names.index("lung")] > 0
        assert not inside.any()


def test_without_asymmetry_the_ribs_of_both_sides_mirror_each_other() -> None:
    chest = library.build("chest", asymmetry=0.0)
    for number in range(1, 13):
        for part in ("cortex", "spongiosa"):
            left, right = rib_boxes(chest, f"rib {number}/{part}")
            assert np.allclose(left[::-1, 0], -right[:, 0], atol=1e-9)
            assert np.allclose(left[:, 1:], right[:, 1:], atol=1e-9)


def test_the_sides_of_a_person_differ_by_some_millimetres(chests: dict[str, Phantom]) -> None:
    """Heads of ribs are level; the ends in front, and the shoulders, are not."""
    chest = chests["male"]
    lower = []
    for number in range(2, 11):
        left, right = rib_boxes(chest, f"rib {number}/cortex")
        assert abs(left[1, 2] - right[1, 2]) < 0.5
        lower.append(left[0, 2] - right[0, 2])
    assert 0.2 < np.abs(lower).max() < 3.0
    heads = rib_boxes(chest, "humerus/head")
    assert 1.0 < heads[0][1, 2] - heads[1][1, 2] < 6.0


def rib_boxes(chest: Phantom, name: str) -> list[Any]:
    return [chest.leaf_bounds[chest.leaf_names.index(f"{s} {name}")] for s in ("left", "right")]


def test_the_same_seed_is_the_same_person_and_everyone_is_a_chest() -> None:
    entry = library.entry("chest")
    assert entry.of_person is not None
    people = []
    for seed in (7, 7, 8):
        generator = np.random.default_rng(seed)
        people.append(entry.of_person(library.Population().draw(generator), generator))
    assert people[0] == people[1] != people[2]
    for wanted in (people[0], people[2]):
        load(entry.build(wanted).model_dump(mode="json"))


def test_lengths_can_be_set_by_hand(along: Along) -> None:
    asked: dict[str, Any] = {"heart_width_mm": 110.0, "chest_width_mm": 250.0, "aorta_mm": 34.0}
    chest = library.build("chest", **asked)
    heart = np.ptp(chest.leaf_bounds[chest.leaf_names.index("heart")][:, 0])
    assert heart == pytest.approx(110.0, abs=1.5)
    outer = chest.leaf_bounds[chest.leaf_names.index("left rib 8/cortex")][1, 0]
    assert 2 * (outer - 7.2) == pytest.approx(250.0, abs=2.5)
    assert chest.document.parameters is not None
    assert chest.document.parameters["rib_cortex_mm"] == pytest.approx(1.4, abs=0.1)


def test_raised_arms_clear_the_lungs_of_a_lateral(chests: dict[str, Phantom]) -> None:
    """Humeri and muscles of hanging arms lie over the upper lungs, raised ones over the neck."""
    raised = library.build("chest", arms="raised")
    z = np.arange(40.0, 90.0, 10.0)
    bone, soft = {}, {}
    for name, chest in (("hanging", chests["male"]), ("raised", raised)):
        y = np.arange(-30.0, 30.0, 10.0)
        sides = np.stack([g.ravel() for g in np.meshgrid(y, z)], axis=1)
        origins = np.column_stack([np.full(len(sides), -500.0), sides])
        found = intervals(chest, origins, np.broadcast_to([1.0, 0.0, 0.0], origins.shape))
        length = found.exit_mm - found.entry_mm
        bone[name] = length[where(found, "left humerus", "right humerus")].sum() / len(sides)
        soft[name] = length[
            where(found, "muscle/", "muscle of", "left muscle", "right muscle")
        ].sum()
    assert bone["hanging"] > 10.0 > 1.0 > bone["raised"]
    assert soft["raised"] < 0.75 * soft["hanging"]


def test_fissures_are_thin_sheets_within_the_lungs(
    chests: dict[str, Phantom], along: Along
) -> None:
    chest = chests["male"]
    x, y = np.arange(-110.0, 111.0, 4.0), np.arange(-70.0, 70.0, 7.0)
    found = along(chest, "z", x, y)
    sheets = np.flatnonzero(where(found, "left oblique", "right oblique", "horizontal"))
    beside = [found.leaf_names[leaf] for leaf in found.leaf[sheets - 1]]
    lungs_beside = np.mean([name.endswith("lung") for name in beside])
    assert lungs_beside > 0.9
    assert 0.5 < np.median(found.exit_mm[sheets] - found.entry_mm[sheets]) < 1.2
    assert {found.leaf_names[leaf] for leaf in found.leaf[sheets]} == {
        "left oblique fissure",
        "right oblique fissure",
        "horizontal fissure",
    }


def test_the_shell_of_a_vertebra_is_as_thin_as_published(
    chests: dict[str, Phantom], along: Along
) -> None:
    """Of the thoracic spine 0.244 mm (J Bone Miner Res 1997, 12:89), of L1 0.35 mm (1994)."""
    chest = chests["male"]
    for level, most in (("T6", 0.35), ("L1", 0.45)):
        low, high = chest.leaf_bounds[chest.leaf_names.index(f"{level}/cortex")]
        found = along(chest, "z", 0.0, (low[1] + high[1]) / 2)
        walls = (found.exit_mm - found.entry_mm)[where(found, f"{level}/cortex")]
        assert len(walls) == 2
        assert (walls > 0.2).all()
        assert (walls < most).all()


@pytest.mark.nightly
@pytest.mark.parametrize("hundred", range(10))
def test_a_thousand_people_are_chests(hundred: int) -> None:
    """About three hours on one core."""
    for index in range(100):
        holds(drawn(100 * hundred + index), 4.0)
