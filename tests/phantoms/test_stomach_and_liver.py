"""Stomach and liver measured by the engine: volume, wall, level, and what can be wrong."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.document import Document
from phantom.errors import InvalidInputError
from phantom.library import Population, mean_person
from phantom.requests.radiograph import plan
from phantom.scene import Phantom, load
from phantom.tracing import Intervals, intervals, path_lengths
from phantoms.stomach_and_liver import Parameters, entry
from phantoms.stomach_and_liver.organs import Stomach
from phantoms.stomach_and_liver.phantom import suspension

Array = np.ndarray[Any, np.dtype[np.float64]]


@pytest.fixture(scope="module")
def trunks() -> dict[str, Phantom]:
    """The mean man's and the mean woman's."""
    return {sex: library.build("stomach-and-liver", sex=sex) for sex in ("male", "female")}


def beam(x: Any, z: Any) -> tuple[Array, Array]:
    """Parallel rays from the front."""
    across, up = np.meshgrid(x, z)
    origins = np.stack([across.ravel(), np.full(across.size, -400.0), up.ravel()], axis=1)
    return origins, np.tile([0.0, 1.0, 0.0], (across.size, 1))


def pieces(found: Intervals, name: str) -> list[tuple[float, float]]:
    """Entry and exit of every piece of one leaf."""
    leaf = found.leaf_names.index(name)
    rows = found.leaf == leaf
    return list(zip(found.entry_mm[rows].tolist(), found.exit_mm[rows].tolist(), strict=True))


@pytest.mark.parametrize("sex", ["male", "female"])
def test_volume_of_the_liver_is_the_published_mean(trunks: dict[str, Phantom], sex: str) -> None:
    """Feng et al. 2017, with the surface of Du Bois and Du Bois, by hand."""
    person = mean_person("male" if sex == "male" else "female")
    surface = 0.007184 * person.height_cm**0.725 * person.weight_kg**0.425
    step = 2.0
    origins, directions = beam(np.arange(-145.0, 75.0, step), np.arange(-15.0, 180.0, step))
    trunk = trunks[sex]
    lengths = path_lengths(trunk, origins, directions)[:, trunk.material_names.index("liver")]
    volume = lengths.sum() * step**2 / 1000
    assert volume == pytest.approx(758.3 * surface - 124.3, rel=0.005)


@pytest.mark.parametrize("sex", ["male", "female"])
def test_wall_of_the_stomach_as_published(trunks: dict[str, Phantom], sex: str) -> None:
    """Pickhardt and Asher 2003: 2.0 ± 0.4 mm in the body, 5.1 ± 1.6 mm in the antrum."""
    trunk = trunks[sex]
    low = trunk.document.landmarks["pylorus"]
    size = mean_person("male" if sex == "male" else "female").height_cm / 168.5
    # Across the body from the left; and up through the bottom of the bend, square to the wall.
    body = intervals(trunk, np.array([[180.0, 5.0 * size, 66.0 * size]]), np.array([[-1.0, 0, 0]]))
    entry_mm, exit_mm = pieces(body, "stomach/wall")[0]
    assert exit_mm - entry_mm == pytest.approx(2.0, abs=0.4)
    antrum = np.array([[low[0] + 24.0 * size, -60.0 * size, low[2] - 52.0 * size]])
    toward = np.array([[0.0, 1.0, 0.0]])
    entry_mm, exit_mm = pieces(intervals(trunk, antrum, toward), "stomach/wall")[0]
    assert 5.1 - 1.6 <= exit_mm - entry_mm <= 5.1 + 1.6 + 1.0  # the ray is not quite square


@pytest.mark.parametrize("sex", ["male", "female"])
def test_widest_lumen_is_what_was_asked_for(trunks: dict[str, Phantom], sex: str) -> None:
    trunk = trunks[sex]
    z = np.arange(80.0, 140.0, 1.0)
    origins = np.stack([np.full(z.size, 200.0), np.full(z.size, 20.0), z], axis=1)
    found = intervals(trunk, origins, np.tile([-1.0, 0.0, 0.0], (z.size, 1)))
    air = pieces(found, "stomach/air") + pieces(found, "stomach/barium")
    asked = float(trunk.document.parameters["stomach_lumen_mm"])
    assert 80.0 < asked < 100.0
    assert max(exit_mm - entry_mm for entry_mm, exit_mm in air) == pytest.approx(asked, abs=2.5)


def test_barium_stands_level_under_air(trunks: dict[str, Phantom]) -> None:
    trunk = trunks["male"]
    level = trunk.document.landmarks["barium level"]
    for dx, dy in ((0.0, 0.0), (15.0, 5.0), (-15.0, -8.0)):
        above = np.array([[level[0] + dx, level[1] + dy, 250.0]])
        down = intervals(trunk, above, np.array([[0.0, 0.0, -1.0]]))
        bottom = pieces(down, "stomach/air")[-1][1]
        top = pieces(down, "stomach/barium")[0][0]
        assert 250.0 - bottom == pytest.approx(level[2], abs=1e-6)
        assert top == pytest.approx(bottom, abs=1e-6)


@pytest.mark.parametrize(
    ("sex", "height", "spread", "pedicle", "wide_spread"),
    [("male", 30.7, 1.9, 16.6, 2.3), ("female", 29.6, 1.8, 15.1, 1.8)],
)
def test_fifth_lumbar_vertebra_as_published(
    trunks: dict[str, Phantom],
    sex: str,
    height: float,
    spread: float,
    pedicle: float,
    wide_spread: float,
) -> None:
    """International Journal of Spine Surgery, table 6: height in front, width of the pedicle."""
    trunk = trunks[sex]
    size = mean_person("male" if sex == "male" else "female").height_cm / 168.5
    front = np.array([[0.0, (37.0 - 12.0) * size, -130.0]])
    found = intervals(trunk, front, np.array([[0.0, 0.0, 1.0]]))
    parts = pieces(found, "L5/body") + pieces(found, "L5/spongiosa")
    measured = max(end for _, end in parts) - min(start for start, _ in parts)
    assert measured == pytest.approx(height, abs=spread)
    y, z = (37.0 + 35.2 / 2 + 5.0) * size, (-76.5 + 0.16 * 29.6) * size
    across = intervals(trunk, np.array([[-60.0, y, z]]), np.array([[1.0, 0.0, 0.0]]))
    right = pieces(across, "L5/right pedicle") + pieces(across, "L5/right pedicle spongiosa")
    measured = max(end for _, end in right) - min(start for start, _ in right)
    assert measured == pytest.approx(pedicle, abs=wide_spread)


@pytest.mark.parametrize(
    "person",
    [
        {"sex": "male", "height_cm": 187.0, "weight_kg": 62.0},
        {"sex": "female", "height_cm": 150.0, "weight_kg": 45.0},
        {"sex": "female", "height_cm": 166.0, "weight_kg": 126.0},
    ],
)
def test_only_skin_is_outermost(person: dict[str, Any]) -> None:
    trunk = library.build("stomach-and-liver", **person)
    front, ahead = beam(np.arange(-180.0, 181.0, 6.0), np.arange(-120.0, 190.0, 6.0))
    aside = front[:, [1, 0, 2]]
    for origins, directions in ((front, ahead), (aside, ahead[:, [1, 0, 2]])):
        found = intervals(trunk, origins, directions)
        first = np.unique(found.ray, return_index=True)[1]
        last = np.append(first[1:], len(found.ray)) - 1
        assert {found.leaf_names[found.leaf[row]] for row in (*first, *last)} == {"skin"}


@pytest.mark.parametrize(
    ("sex", "height", "weight"),
    [("female", 150.0, 45.0), ("male", 200.0, 120.0)],
)
def test_the_trunk_goes_on_beyond_the_field(sex: str, height: float, weight: float) -> None:
    """Its cut ends are never seen: below and above the picture's edge there is a whole person."""
    person = {"sex": sex, "height_cm": height, "weight_kg": weight}
    asked = {
        "phantom": {"name": "stomach-and-liver", "parameters": person},
        "view": {"preset": "ap"},
        "detector": {"columns": 24, "rows": 24},
        "acquisition": None,
    }
    shown = plan(asked).render()
    assert shown.line_integral[[0, -1], 6:18].min() > 1.5
    assert not shown.warnings


def test_folds_stand_in_from_the_wall_of_the_body(trunks: dict[str, Phantom]) -> None:
    """Twelve of them run along it, 4 to 5 mm high: seen from the axis, all around."""
    trunk = trunks["male"]
    chosen = Parameters().resolved()
    height = chosen.person.height_cm
    stomach = Stomach(
        height / 168.5,
        chosen.value("stomach_axis_mm"),
        chosen.value("stomach_lumen_mm"),
        chosen.stomach_wall_mm,
    )
    at, back, greater = stomach.frame(0.22)
    turns = np.linspace(0.0, 2 * np.pi, 1440, endpoint=False)[:, None]
    directions = np.cos(turns) * greater + np.sin(turns) * back
    found = intervals(trunk, np.tile(at, (len(turns), 1)), directions)
    highest: dict[str, float] = {}
    for leaf, start, end in zip(found.leaf, found.entry_mm, found.exit_mm, strict=True):
        name = found.leaf_names[leaf]
        if name.startswith("stomach/fold"):
            fold = name.split("-")[0]
            highest[fold] = max(highest.get(fold, 0.0), float(end - start))
    assert len(highest) == 12
    assert all(3.0 < high < 5.5 for high in highest.values())


def test_polyp_and_ulcer_are_where_they_are_said_to_be_and_nowhere_else(
    trunks: dict[str, Phantom],
) -> None:
    ill = library.build("stomach-and-liver", [{"type": "filling_defect"}, {"type": "ulcer_niche"}])
    origins, directions = beam(np.arange(-60.0, 125.0, 2.0), np.arange(-55.0, 165.0, 2.0))
    rest = path_lengths(trunks["male"], origins, directions)
    with_both = path_lengths(ill, origins, directions)
    assert ill.material_names == trunks["male"].material_names
    changed = (with_both != rest).any(axis=1)
    places = origins[:, [0, 2]]
    reached = np.zeros(len(places), dtype=bool)
    barium = ill.material_names.index("barium")
    for finding, sign in zip(ill.document.findings, (-1.0, 1.0), strict=True):
        assert finding.center is not None
        assert isinstance(finding.size_mm, float)
        away = np.linalg.norm(places - np.array(finding.center)[[0, 2]], axis=1)
        near = away < 0.5 * finding.size_mm + 3.0
        more = (with_both - rest)[near][:, barium]
        assert sign * more[np.abs(more).argmax()] > 2.0
        reached |= near
    assert not changed[~reached].any()


def made(*wrong: dict[str, Any], **parameters: object) -> Document:
    return library.document("stomach-and-liver", parameters, wrong)


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"type": "filling_defect", "diameter_mm": 45.0, "at": 0.9}, "diameter_mm"),
        ({"type": "ulcer_niche", "width_mm": 25.0, "at": 0.92}, "width_mm"),
        ({"type": "ulcer_niche", "depth_mm": 18.0, "at": 0.12, "curvature": "back"}, "depth_mm"),
        ({"type": "filling_defect", "at": 0.0}, "at"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(wrong: dict[str, Any], field: str) -> None:
    with pytest.raises(InvalidInputError) as caught:
        made(wrong)
    assert [problem.path for problem in caught.value.problems] == [f"/abnormalities/0/{field}"]


def test_a_lumen_too_wide_for_its_axis_is_refused() -> None:
    with pytest.raises(InvalidInputError) as caught:
        made(stomach_axis_mm=220.0, stomach_lumen_mm=100.0)
    assert caught.value.problems[0].path == "/parameters/stomach_lumen_mm"


def test_suspension_holds_its_barium_sulphate() -> None:
    """0.6 g in a millilitre: 0.6 g of salt and 1 - 0.6/4.5 g of water."""
    mixture = suspension(0.6)
    assert mixture.density_g_cm3 == pytest.approx(0.6 + 1 - 0.6 / 4.5)
    salt = 137.327 + 32.06 + 4 * 15.999
    barium = mixture.composition["Ba"] * mixture.density_g_cm3
    assert barium == pytest.approx(0.6 * 137.327 / salt, rel=1e-3)
    assert sum(mixture.composition.values()) == pytest.approx(1.0, abs=1e-5)


def test_people_are_themselves_and_differ() -> None:
    population = Population()
    assert entry.of_person is not None

    def people(seed: int) -> list[Any]:
        generator = np.random.default_rng(seed)
        assert entry.of_person is not None
        return [entry.of_person(population.draw(generator), generator) for _ in range(100)]

    assert people(2) == people(2)
    volumes = np.array([person.liver_volume_cm3 for person in people(2)])
    assert 1100.0 < volumes.mean() < 1600.0
    assert 180.0 < volumes.std() < 350.0
    for person in people(2)[:10]:
        entry.build(person)


@pytest.mark.nightly
def test_random_people_are_valid() -> None:
    generator = np.random.default_rng(12)
    population = Population(age_years=(18.0, 100.0))
    assert entry.of_person is not None
    for _ in range(200):
        person = entry.of_person(population.draw(generator), generator)
        load(entry.build(person).model_dump(mode="json"))
