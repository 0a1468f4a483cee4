"""The hand measured by the engine: its sizes in men and women, and what can be wrong with it."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.document import Document
from phantom.errors import InvalidInputError
from phantom.library import Population, mean_person
from phantom.scene import Phantom, load
from phantom.tracing import intervals, materials_at, path_lengths
from phantoms.hand import Parameters, entry
from phantoms.hand.skeleton import skeleton

# Buryanov and Kotiuk 2010, table I: mean and standard deviation, mm.
PUBLISHED = {
    "thumb metacarpal": (46.2, 3.9),
    "index metacarpal": (68.1, 6.3),
    "middle metacarpal": (64.6, 5.4),
    "ring metacarpal": (58.0, 5.1),
    "little metacarpal": (53.7, 4.4),
    "thumb proximal phalanx": (31.6, 3.1),
    "index proximal phalanx": (39.8, 4.9),
    "middle proximal phalanx": (44.6, 3.8),
    "ring proximal phalanx": (41.4, 3.9),
    "little proximal phalanx": (32.7, 2.8),
    "index middle phalanx": (22.4, 2.5),
    "middle middle phalanx": (26.3, 3.0),
    "ring middle phalanx": (25.7, 3.3),
    "little middle phalanx": (18.1, 2.5),
    "thumb distal phalanx": (21.7, 1.6),
    "index distal phalanx": (15.8, 2.3),
    "middle distal phalanx": (17.4, 1.9),
    "ring distal phalanx": (17.3, 2.2),
    "little distal phalanx": (16.0, 2.5),
}
CORTEX = "cortical bone"


@pytest.fixture(scope="module")
def hands() -> dict[str, Phantom]:
    """The mean man's and the mean woman's."""
    return {sex: library.build("hand", sex=sex) for sex in ("male", "female")}


def mark(hand: Phantom, name: str) -> np.ndarray[Any, Any]:
    return np.array(hand.document.landmarks[name])


def along_axis(hand: Phantom, bone: str, aside: float = 0.0) -> tuple[float, float]:
    """First and last place of a bone on lines along it, from its base's landmark, in mm."""
    end = "tip" if "distal" in bone else "head"
    start, stop = mark(hand, f"{bone} base"), mark(hand, f"{bone} {end}")
    direction = (stop - start) / np.linalg.norm(stop - start)
    across = np.cross(direction, (0.0, 1.0, 0.0))
    origins = start - 40 * direction + np.outer([aside, -aside], across)
    found = intervals(hand, origins, np.tile(direction, (2, 1)))
    own = [found.leaf_names[leaf].startswith(f"{bone}/") for leaf in found.leaf]
    return float(found.entry_mm[own].min() - 40), float(found.exit_mm[own].max() - 40)


def midshaft(hand: Phantom, bone: str) -> tuple[float, float]:
    """Width of a bone across its middle, and how much of it is cortex."""
    end = "tip" if "distal" in bone else "head"
    start, stop = mark(hand, f"{bone} base"), mark(hand, f"{bone} {end}")
    across = np.cross((stop - start) / np.linalg.norm(stop - start), (0.0, 1.0, 0.0))
    middle = (start + stop) / 2 + (0.0, 0.028 * float(np.linalg.norm(stop - start)), 0.0)
    found = intervals(hand, (middle - 12 * across)[None], across[None])
    rows = [i for i, leaf in enumerate(found.leaf) if found.leaf_names[leaf].startswith(bone)]
    lengths = {row: float(found.exit_mm[row] - found.entry_mm[row]) for row in rows}
    cortex = sum(
        v for row, v in lengths.items() if found.leaf_names[found.leaf[row]].endswith("/cortex")
    )
    return sum(lengths.values()), cortex


@pytest.mark.parametrize("sex", ["male", "female"])
def test_lengths_lie_within_a_standard_deviation_of_the_published(
    hands: dict[str, Phantom], sex: str
) -> None:
    for bone, (mean, spread) in PUBLISHED.items():
        condyle = 0.0 if "metacarpal" in bone or "distal" in bone else 2.2
        base, end = along_axis(hands[sex], bone, condyle)
        assert end - base == pytest.approx(mean, abs=spread), bone


def test_women_have_shorter_bones_as_published(hands: dict[str, Phantom]) -> None:
    """Ozsoy et al. 2019: 3.82 over 4.17 cm for proximal, 2.40 over 2.62 for middle phalanges."""
    for bone, ratio in (
        ("ring proximal phalanx", 3.82 / 4.17),
        ("ring middle phalanx", 2.4 / 2.62),
    ):
        ends = {sex: along_axis(hand, bone, 2.2) for sex, hand in hands.items()}
        lengths = {sex: end - base for sex, (base, end) in ends.items()}
        assert lengths["female"] / lengths["male"] == pytest.approx(ratio, abs=0.02)


@pytest.mark.parametrize(
    ("sex", "index", "spread"), [("male", 0.533, 0.032), ("female", 0.462, 0.039)]
)
def test_cortex_of_the_index_metacarpal_as_published(
    hands: dict[str, Phantom], sex: str, index: float, spread: float
) -> None:
    """Ekpo et al. 2007: means of all ages; at 45 years the index is above its mean."""
    width, cortex = midshaft(hands[sex], "index metacarpal")
    peak = {"male": 0.574, "female": 0.528}[sex]
    assert index - spread < cortex / width < peak + 0.02
    assert 7.5 < width < 10.5


def test_joint_space_is_what_was_asked_for(hands: dict[str, Phantom]) -> None:
    """The gap on the line through the head's end, of a finger whose bones are nearly in line."""
    for sex, space in (("male", 1.72), ("female", 1.49)):
        head = mark(hands[sex], "middle metacarpal head")
        base = mark(hands[sex], "middle proximal phalanx base")
        direction = (base - head) / np.linalg.norm(base - head)
        found = intervals(hands[sex], (head - 5 * direction)[None], direction[None])
        names = [found.leaf_names[leaf] for leaf in found.leaf]
        last = max(i for i, name in enumerate(names) if name.startswith("middle metacarpal"))
        first = min(i for i, name in enumerate(names) if name.startswith("middle proximal"))
        gap = found.entry_mm[first] - found.exit_mm[last]
        assert gap == pytest.approx(space, abs=0.06)


def bones_along(
    hand: Phantom, start: tuple[float, ...], direction: tuple[float, ...]
) -> list[tuple[str, float, float]]:
    """The bones that a ray meets, in order: name, where it enters and where it leaves, in mm."""
    found = intervals(hand, np.array([start]), np.array([direction]))
    bones: list[tuple[str, float, float]] = []
    for row, leaf in enumerate(found.leaf):
        bone, _, part = found.leaf_names[leaf].partition("/")
        if not part:
            continue
        entry_mm = bones.pop()[1] if bones and bones[-1][0] == bone else found.entry_mm[row]
        bones.append((bone, float(entry_mm), float(found.exit_mm[row])))
    return bones


def test_the_middle_ray_stands_on_capitate_lunate_and_radius(hands: dict[str, Phantom]) -> None:
    """From the side they are in line, with joints of 1 to 3 mm."""
    for hand in hands.values():
        x, y, _ = mark(hand, "middle metacarpal base")
        line = bones_along(hand, (x - 1.0, y - 2.0, -70.0), (0.0, 0.0, 1.0))[:4]
        names = [name for name, _, _ in line]
        assert names == ["radius", "lunate", "capitate", "middle metacarpal"]
        for (_, _, end), (_, start, _) in pairwise(line):
            assert 1.0 < start - end < 3.0


@pytest.mark.parametrize(
    ("sex", "height_mm", "spread_mm"), [("male", 34.6, 2.2), ("female", 32.0, 1.7)]
)
def test_carpal_height_as_published(
    hands: dict[str, Phantom], sex: str, height_mm: float, spread_mm: float
) -> None:
    """Along the middle metacarpal, from the radius: Fuentes et al., Cir. Cir. 74 (2006) 457."""
    base, head = (mark(hands[sex], f"middle metacarpal {end}") for end in ("base", "head"))
    direction = (head - base) / np.linalg.norm(head - base)
    line = bones_along(hands[sex], tuple(base - 60 * direction), tuple(direction))
    ends = {name: (first, last) for name, first, last in line}
    height = ends["middle metacarpal"][0] - ends["radius"][1]
    assert height == pytest.approx(height_mm, abs=spread_mm)


@pytest.mark.parametrize(
    ("z", "expected"),
    [
        (-26.4, ["triquetrum", "lunate", "scaphoid"]),
        (-10.5, ["hamate", "capitate", "trapezoid"]),
    ],
)
def test_a_film_from_the_front_shows_carpals_1_to_2_mm_apart(
    hands: dict[str, Phantom], z: float, expected: list[str]
) -> None:
    hand = hands["male"]
    x = np.arange(-40.0, 40.0, 0.05)
    level = 1.04 * z
    origins = np.stack([x, np.full(x.size, -80.0), np.full(x.size, level)], axis=1)
    found = intervals(hand, origins, np.tile([0.0, 1.0, 0.0], (x.size, 1)))
    bone = np.array([name.partition("/")[0] for name in hand.leaf_names])[found.leaf]
    seen = [x[found.ray[bone == name]] for name in expected]
    for one, two in pairwise(seen):
        assert 1.0 < two.min() - one.max() < 2.0


def test_the_lunate_holds_the_head_of_the_capitate_from_palm_and_back(
    hands: dict[str, Phantom],
) -> None:
    """A crescent from the side: a line from palm to back meets it on both sides of the head."""
    hand = hands["male"]
    line = bones_along(hand, (-1.0, -60.0, -23.6), (0.0, 1.0, 0.0))
    assert [name for name, _, _ in line] == ["lunate", "capitate", "lunate"]


def test_thumb_rides_on_the_trapezium(hands: dict[str, Phantom]) -> None:
    for hand in hands.values():
        base, head = mark(hand, "thumb metacarpal base"), mark(hand, "thumb metacarpal head")
        direction = (head - base) / np.linalg.norm(head - base)
        line = bones_along(hand, tuple(base - 12 * direction), tuple(direction))
        names = [name for name, _, _ in line]
        first = names.index("trapezium")
        assert names[first + 1] == "thumb metacarpal"
        assert 1.0 < line[first + 1][1] - line[first][2] < 2.5


def test_radius_leans_to_the_ulna_and_to_the_palm_as_published(
    hands: dict[str, Phantom],
) -> None:
    """Hadi and Wijiono, Med. J. Indones. 22 (2013) 173: means and standard deviations of 400."""
    hand = hands["male"]

    x, y = np.meshgrid(np.arange(-12.0, 32.0, 0.5), np.arange(-9.0, 9.1, 1.0), indexing="ij")
    origins = np.stack([x.ravel(), y.ravel(), np.full(x.size, -80.0)], axis=1)
    found = intervals(hand, origins, np.tile([0.0, 0.0, 1.0], (x.size, 1)))
    of_radius = np.array([name.startswith("radius/") for name in hand.leaf_names])[found.leaf]
    top = np.full(x.size, -np.inf)
    np.maximum.at(top, found.ray[of_radius], found.exit_mm[of_radius] - 80.0)
    top = top.reshape(x.shape)
    across = top[:, y[0] == 0.0].ravel()
    styloid = int(np.argmax(across))
    corner = int(np.argmax(np.where(x[:, 0] < -4.0, across, -np.inf)))
    height = across[styloid] - across[corner]
    assert height == pytest.approx(11.31, abs=1.66)
    inclination = np.arctan2(height, x[styloid, 0] - x[corner, 0])
    assert np.degrees(inclination) == pytest.approx(23.99, abs=3.75)
    # The rims of the fossa from palm to back, where the lunate and the scaphoid meet.
    along = top[np.flatnonzero(x[:, 0] == 6.0)[0]]
    palm, back = (np.argmax(np.where(side, along, -np.inf)) for side in (y[0] < -3, y[0] > 3))
    tilt = np.arctan2(along[back] - along[palm], y[0, back] - y[0, palm])
    assert np.degrees(tilt) == pytest.approx(13.76, abs=4.36)


def test_the_field_ends_within_the_forearm_and_beyond_the_fingertips() -> None:
    for sex, height_cm in (("female", 145.0), ("male", 195.0)):
        hand = library.build("hand", sex=sex, height_cm=height_cm)
        for view in entry.views:
            technique = entry.technique_of(view)
            assert technique.field_mm is not None
            assert technique.object_detector_mm is not None
            shrunk = 1.0 - technique.object_detector_mm / technique.source_detector_mm
            half = technique.field_mm / 2 * shrunk
            middle = mark(hand, "isocentre")[2]
            assert hand.bounds[0][2] < middle - half
            assert hand.bounds[1][2] < middle + half


def test_twenty_seven_bones_and_their_neighbours(hands: dict[str, Phantom]) -> None:
    leaves = hands["male"].leaf_names
    bones = {name.split("/")[0] for name in leaves if "/" in name}
    carpals = {
        "scaphoid", "lunate", "triquetrum", "pisiform",
        "trapezium", "trapezoid", "capitate", "hamate",
    }  # fmt: skip
    others = {"radius", "ulna", "radial sesamoid", "ulnar sesamoid"}
    assert bones == carpals | others | set(PUBLISHED)
    assert len(carpals | set(PUBLISHED)) == 27


def test_nothing_but_skin_is_outermost(hands: dict[str, Phantom]) -> None:
    """Rays from the front meet skin first and last, wherever they meet the hand."""
    hand = hands["female"]
    x, z = np.meshgrid(np.arange(-50.0, 95.0, 2.5), np.arange(-60.0, 170.0, 2.5))
    origins = np.stack([x.ravel(), np.full(x.size, -100.0), z.ravel()], axis=1)
    found = intervals(hand, origins, np.tile([0.0, 1.0, 0.0], (x.size, 1)))
    firsts = np.unique(found.ray, return_index=True)[1]
    lasts = np.append(firsts[1:], len(found.ray)) - 1
    outer = {found.leaf_names[found.leaf[row]] for row in (*firsts, *lasts)}
    assert all(name.endswith(" skin") for name in outer)


def test_left_hand_mirrors_the_right(hands: dict[str, Phantom]) -> None:
    left = library.build("hand", side="left")
    generator = np.random.default_rng(3)
    points = generator.uniform((-50, -15, -60), (95, 12, 170), (400, 3))
    mirrored = points * (-1.0, 1.0, 1.0)
    assert np.array_equal(materials_at(left, mirrored), materials_at(hands["male"], points))
    assert left.document.landmarks["isocentre"][0] == -mark(hands["male"], "isocentre")[0]


def rays_through(hand: Phantom) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    x, z = np.meshgrid(np.arange(-45.0, 85.0, 1.7), np.arange(-50.0, 165.0, 1.7))
    origins = np.stack([x.ravel(), np.full(x.size, -100.0), z.ravel()], axis=1)
    return origins, np.tile([0.0, 1.0, 0.0], (x.size, 1))


WRONG: dict[str, dict[str, Any]] = {
    "lytic_lesion": {},
    "blastic_lesion": {},
    "erosion": {"diameter_mm": 4.0},
    "foreign_body": {"substance": "steel"},
    "osteoarthritis": {"grade": 4, "joint": "ring proximal interphalangeal"},
}


def test_abnormalities_are_where_they_are_said_to_be_and_nowhere_else(
    hands: dict[str, Phantom],
) -> None:
    wrong = [{"type": kind, **more} for kind, more in WRONG.items()]
    ill = library.build("hand", wrong)
    healthy = hands["male"]
    assert ill.material_names == healthy.material_names
    origins, directions = rays_through(healthy)
    rest = path_lengths(healthy, origins, directions)
    changed = (path_lengths(ill, origins, directions) != rest).any(axis=1)
    at = origins[:, [0, 2]]
    reached = np.zeros(len(at), dtype=bool)
    for finding in ill.document.findings:
        assert finding.center is not None
        size = np.max(np.atleast_1d(np.array(finding.size_mm, dtype=float)))
        near = np.linalg.norm(at - np.array(finding.center)[[0, 2]], axis=1) < 0.5 * size + 3.0
        assert changed[near].any(), finding.name
        reached |= near
    assert not changed[~reached].any()
    assert {f.kind for f in ill.document.findings} >= {"lytic lesion", "blastic lesion", "erosion"}
    assert all(set(f.leaves) <= set(ill.leaf_names) for f in ill.document.findings)


def test_fracture_opens_a_gap_and_moves_only_its_own_ray() -> None:
    wrong = {"type": "fracture", "gap_mm": 2.0, "step_mm": 0.0, "angle_deg": 0.0, "at": 0.5}
    hand = library.build("hand", [{**wrong, "bone": "ring metacarpal"}])
    finding = hand.document.findings[0]
    base, head = mark(hand, "ring metacarpal base"), mark(hand, "ring metacarpal head")
    direction = (head - base) / np.linalg.norm(head - base)
    found = intervals(hand, (base + 5 * direction)[None], direction[None])
    names = [found.leaf_names[leaf] for leaf in found.leaf]
    inner = max(i for i, name in enumerate(names) if "inner fragment" in name)
    outer = min(i for i, name in enumerate(names) if "outer fragment" in name)
    gap = (found.exit_mm[inner], found.entry_mm[outer])
    assert gap[1] - gap[0] == pytest.approx(2.0, abs=1e-6)
    middle = base + (5 + float(np.mean(gap))) * direction
    assert np.allclose(finding.center, middle, atol=1e-5)


def built(*wrong: dict[str, Any], **parameters: object) -> Document:
    return library.document("hand", parameters, wrong)


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"type": "lytic_lesion", "width_mm": 11.0}, "width_mm"),
        ({"type": "lytic_lesion", "at": 0.1, "length_mm": 20.0}, "length_mm"),
        ({"type": "foreign_body", "deep_mm": 0.0, "aside_mm": 0.0}, "deep_mm"),
        ({"type": "foreign_body", "deep_mm": 18.0}, "deep_mm"),
        ({"type": "osteoarthritis", "grade": 5}, "grade"),
        ({"type": "fracture", "bone": "femur"}, "bone"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(wrong: dict[str, Any], field: str) -> None:
    with pytest.raises(InvalidInputError) as caught:
        built({"type": "erosion"}, wrong)
    assert [problem.path for problem in caught.value.problems] == [f"/abnormalities/1/{field}"]


def test_a_length_can_be_set_by_hand() -> None:
    given = built(index_metacarpal_mm=80.0)
    base, head = (np.array(given.landmarks[f"index metacarpal {end}"]) for end in ("base", "head"))
    assert np.linalg.norm(head - base) == pytest.approx(80.0, abs=1e-4)
    with pytest.raises(InvalidInputError) as caught:
        built(index_metacarpal_mm=20.0)
    assert caught.value.problems[0].path == "/parameters/index_metacarpal_mm"


def test_people_are_themselves_and_differ() -> None:
    population = Population()

    def people(seed: int) -> list[Parameters]:
        generator = np.random.default_rng(seed)
        assert entry.of_person is not None
        return [entry.of_person(population.draw(generator), generator) for _ in range(200)]

    first = people(5)
    assert first == people(5)
    lengths = np.array([person.middle_metacarpal_mm for person in first], dtype=float)
    assert np.mean(lengths) == pytest.approx(64.6, abs=1.5)
    assert 3.0 < np.std(lengths) < 6.0
    index = np.array([person.metacarpal_index for person in first], dtype=float)
    ages = np.array([person.age_years for person in first])
    assert np.corrcoef(index, ages)[0, 1] < -0.3
    for person in first[:12]:
        entry.build(person)


def of_one_material(tree: dict[str, Any], material: str) -> dict[str, Any]:
    """A solid's tree with all that it is made of in one material."""
    changed = dict(tree)
    if tree.get("material") is not None:
        changed["material"] = material
    if "solid" in tree:
        changed["solid"] = of_one_material(tree["solid"], material)
    if "solids" in tree:
        changed["solids"] = [of_one_material(part, material) for part in tree["solids"]]
    return changed


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(12))
def test_no_bone_goes_through_another(seed: int) -> None:
    """Where bones add up and where each hides the next, rays meet as much bone within 0.1 mm."""
    generator = np.random.default_rng(seed)
    assert entry.of_person is not None
    chosen = entry.of_person(Population().draw(generator), generator).resolved()
    bones = skeleton(chosen)
    solids = bones.solids()
    names = [str(solid.name) for solid in solids]
    trees = [
        of_one_material(solid.model_dump(mode="json"), name)
        for solid, name in zip(solids, names, strict=True)
    ]
    lengths = []
    low, high = np.array((-50.0, -30.0, -75.0)), np.array((100.0, 30.0, 185.0))
    for operator in ("overlap", "union"):
        phantom = load(
            {
                "format": "phantom/1",
                "materials": {name: {"attenuation_per_mm": 1.0} for name in names},
                "solid": {"type": operator, "solids": trees},
            }
        )
        found = []
        for axis in range(3):
            sides = [i for i in range(3) if i != axis]
            grid = np.meshgrid(*[bones.scale * np.arange(low[i], high[i], 0.8) for i in sides])
            origins = np.full((grid[0].size, 3), -500.0)
            origins[:, sides] = np.stack([side.ravel() for side in grid], axis=1)
            directions = np.broadcast_to(np.eye(3)[axis], origins.shape)
            found.append(path_lengths(phantom, origins, directions).sum(axis=1))
        lengths.append(np.concatenate(found))
    assert np.max(lengths[0] - lengths[1]) < 0.1


@pytest.mark.nightly
def test_random_people_have_valid_hands() -> None:
    generator = np.random.default_rng(11)
    population = Population(age_years=(18.0, 100.0))
    assert entry.of_person is not None
    for _ in range(200):
        person = entry.of_person(population.draw(generator), generator)
        load(entry.build(person).model_dump(mode="json"))


def test_old_women_have_thinner_cortex() -> None:
    assert mean_person("female").sex == "female"
    young, old = (built(sex="female", age_years=age).parameters for age in (40.0, 80.0))
    assert young["metacarpal_index"] - old["metacarpal_index"] > 0.1
