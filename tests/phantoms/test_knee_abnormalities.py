"""What can be wrong with the knee: in its place, of its size, and nowhere else."""

from __future__ import annotations

from functools import cache
from typing import Any, get_args

import numpy as np
import pytest

from phantom import library
from phantom.errors import InvalidInputError
from phantom.scene import Phantom
from phantom.tracing import materials_at, path_lengths
from phantoms.knee.abnormalities import FractureSite, LesionSite, LooseSite

BONE = ("cortical bone", "spongiosa", "trabeculae", "marrow")


@cache
def healthy() -> Phantom:
    return library.build("knee")


def wrong(*abnormalities: dict[str, object], **parameters: object) -> Phantom:
    return library.build("knee", list(abnormalities), **parameters)


def names_at(phantom: Phantom, points: Any) -> list[str]:
    """Name of the material at each point; empty outside."""
    found = materials_at(phantom, np.atleast_2d(points))
    assert found.sum(axis=1).max() <= 1
    return [phantom.material_names[row.argmax()] if row.any() else "" for row in found]


def on_sphere(center: Any, radius: float) -> Any:
    """Points of a sphere, evenly spread."""
    count = 400
    height = 1 - 2 * (np.arange(count) + 0.5) / count
    turn = np.arange(count) * np.pi * (3 - 5**0.5)
    ring = np.sqrt(1 - height**2)
    unit = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=1)
    return np.asarray(center) + radius * unit


def largest_mm(abnormality: dict[str, object]) -> float:
    """Size that the refusal of one far too large says would fit."""
    with pytest.raises(InvalidInputError) as refusal:
        library.document("knee", {}, [abnormality])
    (problem,) = refusal.value.problems
    assert problem.kind == "does_not_fit"
    return float(problem.message.split("expected ")[1].split(" ")[0])


@pytest.mark.parametrize("site", get_args(LesionSite))
def test_the_largest_lesion_stays_in_spongy_bone(site: str) -> None:
    given = {"type": "lytic_lesion", "site": site}
    largest = largest_mm({**given, "diameter_mm": 30.0})
    assert largest > 10.0
    document = library.document("knee", {}, [{**given, "diameter_mm": largest - 0.1}])
    (finding,) = document.findings
    around = names_at(healthy(), on_sphere(finding.center, largest / 2))
    assert set(around) <= {"spongiosa", "trabeculae", "marrow"}


@pytest.mark.parametrize("site", get_args(LooseSite))
def test_the_largest_loose_body_touches_no_bone(site: str) -> None:
    given = {"type": "loose_body", "site": site}
    largest = largest_mm(
        {**given, "diameter_mm": 14.0, "offset_mm": [0.0, 0.0, 5.0]} | {"diameter_mm": 14.0}
    )
    (finding,) = library.document("knee", {}, [{**given, "diameter_mm": 1.0}]).findings
    radius = min(largest / 2, 7.0)
    around = set(names_at(healthy(), on_sphere(finding.center, radius)))
    assert not around & {*BONE, "", "skin"}


@pytest.mark.parametrize(
    "site", ["front_of_the_patella", "medial_side", "lateral_side", "back_of_the_knee"]
)
def test_splinters_are_under_the_skin(site: str) -> None:
    given = {"type": "foreign_body", "site": site, "thickness_mm": 2.0}
    (finding,) = library.document("knee", {}, [given]).findings
    around = set(names_at(healthy(), on_sphere(finding.center, 1.0)))
    assert around <= {"fat", "muscle", "tendon"}


@pytest.mark.parametrize(
    ("given", "darker"),
    [
        ({"type": "lytic_lesion", "mineral_change": 0.5}, True),
        ({"type": "blastic_lesion", "mineral_change": 0.5}, False),
    ],
)
def test_a_lesion_is_a_ball_and_all_else_is_the_twin(
    given: dict[str, object], darker: bool
) -> None:
    """Rays that miss it cross the same lengths, bit for bit; a ray through it its diameter."""
    phantom = wrong({**given, "diameter_mm": 16.0})
    (finding,) = phantom.document.findings
    assert finding.size_mm == 16.0
    assert phantom.material_names[:-1] == healthy().material_names
    center = np.array(finding.center)
    rng = np.random.default_rng(2)
    directions = rng.standard_normal((4000, 3))
    origins = rng.uniform(-60.0, 60.0, (4000, 3)) - 500 * directions
    units = directions / np.linalg.norm(directions, axis=1)[:, None]
    apart = np.linalg.norm(np.cross(center - origins, units), axis=1)
    missing = apart > 8.0 + 1e-6
    assert 0.5 < missing.mean() < 0.999
    changed = path_lengths(phantom, origins, directions)
    before = path_lengths(healthy(), origins, directions)
    assert np.array_equal(changed[missing][:, :-1], before[missing])
    assert (changed[missing][:, -1] == 0.0).all()
    through = path_lengths(phantom, [center - [0, 500, 0]], [[0, 1, 0]])[0]
    assert through[-1] == pytest.approx(16.0, abs=1e-6)
    density = phantom.document.materials["lytic lesion" if darker else "blastic lesion"]
    assert (density.density_g_cm3 < 1.18) == darker  # type: ignore[union-attr, operator]


@pytest.mark.parametrize("compartment", ["medial", "lateral"])
@pytest.mark.parametrize("loss", [0.25, 1.6, 4.0])
def test_osteoarthritis_narrows_one_compartment(compartment: str, loss: float) -> None:
    from tests.phantoms.test_knee import joint_space_mm

    given = {"type": "osteoarthritis", "compartment": compartment, "joint_space_loss_mm": loss}
    phantom = wrong(given)
    sides = {"medial": np.arange(16.0, 30.0, 0.5), "lateral": np.arange(-30.0, -16.0, 0.5)}
    for side, xs in sides.items():
        before, after = joint_space_mm(healthy(), xs), joint_space_mm(phantom, xs)
        expected = loss if side == compartment else 0.0
        assert before - after == pytest.approx(expected, abs=0.12 * loss + 0.02)


def test_grades_of_osteoarthritis_grow_worse() -> None:
    from phantoms.knee.abnormalities import Osteoarthritis

    grades = [Osteoarthritis(grade=grade) for grade in (1, 2, 3, 4)]
    for name in ("loss_mm", "spur_mm", "dense_mm"):
        values = [getattr(grade, name) for grade in grades]
        assert values == sorted(values)
    # Ratzlaff et al. 2018.
    assert (grades[1].loss_mm, grades[2].loss_mm) == (0.25, 1.6)


@pytest.mark.parametrize("site", get_args(FractureSite))
def test_a_fracture_opens_by_its_gap(site: str) -> None:
    """Halfway across the gap of an unshifted break there is no bone; beside it there is."""
    phantom = wrong({"type": "fracture", "site": site, "gap_mm": 2.0, "step_mm": 0.0})
    (finding,) = phantom.document.findings
    piece = finding.leaves[0].split("/")[0]
    assert any(name.startswith(f"{piece}/") for name in phantom.leaf_names)
    center = np.array(finding.center)
    steps = np.linspace(-6.0, 6.0, 49)
    normals = {"patella": (0, 0, -1), "tibial_shaft": (0, 0, -1), "femoral_shaft": (0, 0, 1)}
    lean, turn = np.radians(22.0), np.radians(35.0)
    wedge = (-np.cos(lean) * np.cos(turn), -np.cos(lean) * np.sin(turn), np.sin(lean))
    normal = np.array(normals.get(site, wedge), dtype=float)
    start = center - [0, 0, 12.0] if site == "lateral_tibial_plateau" else center
    along = names_at(phantom, start + steps[:, None] * normal)
    bone = np.array([name in BONE for name in along])
    offset = 0.0 if site != "lateral_tibial_plateau" else 12.0 * np.sin(lean)
    gap = (steps - offset > 0.05) & (steps - offset < 1.95)
    assert not bone[gap].any()
    assert bone[~gap & (np.abs(steps - offset - 1.0) > 1.2)].all()


def test_effusion_is_as_deep_as_asked() -> None:
    """Between femur and tendon; a deeper one is held back by the tendon."""
    crossed = []
    for depth in (5.0, 9.0, 13.0, 18.0):
        phantom = wrong({"type": "effusion", "depth_mm": depth})
        (finding,) = phantom.document.findings
        x, _, z = finding.center  # type: ignore[misc]
        crossed.append(path_lengths(phantom, [[x, -500.0, z]], [[0.0, 1.0, 0.0]])[0, -1])
    assert crossed[:3] == pytest.approx([5.0, 9.0, 13.0], abs=1.6)
    assert crossed == sorted(crossed)


@pytest.mark.parametrize(
    ("given", "path", "kind"),
    [
        ([{"type": "lytic_lesion", "diameter_mm": 99.0}], "/abnormalities/0/diameter_mm", "over"),
        (
            [{"type": "lytic_lesion", "offset_mm": [9.0, 0.0, 0.0]}],
            "/abnormalities/0/offset_mm",
            "does_not_fit",
        ),
        (
            [{"type": "effusion"}, {"type": "osteoarthritis", "joint_space_loss_mm": 7.0}],
            "/abnormalities/1/joint_space_loss_mm",
            "does_not_fit",
        ),
        (
            [{"type": "loose_body", "site": "medial_gutter", "diameter_mm": 9.0}],
            "/abnormalities/0/diameter_mm",
            "does_not_fit",
        ),
        ([{"type": "fracture"}] * 2, "/abnormalities/1/site", "does_not_fit"),
        ([{"type": "lytic_lesion"}, {"type": "fracture"}], "/abnormalities/1/site", "does_not_fit"),
        ([{"type": "fracture"}, {"type": "lytic_lesion"}], "/abnormalities/1/site", "does_not_fit"),
        (
            [{"type": "effusion", "name": "a"}, {"type": "loose_body", "name": "a"}],
            "/abnormalities/1/name",
            "repeated",
        ),
        ([{"type": "osteoarthritis"}] * 2, "/abnormalities/1/type", "repeated"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(
    given: list[dict[str, object]], path: str, kind: str
) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        library.document("knee", {}, given)
    (problem,) = refusal.value.problems
    assert problem.path == path
    assert kind == "over" or problem.kind == kind
    assert "found" in problem.message
    assert "expected" in problem.message


@pytest.mark.parametrize(
    "given",
    [
        [{"type": "osteoarthritis", "grade": 4}, {"type": "effusion", "depth_mm": 18.0}],
        [{"type": "fracture", "gap_mm": 3.0, "step_mm": 5.0, "tilt_deg": 25.0}],
        [{"type": "fracture", "site": "tibial_shaft", "gap_mm": 3.0, "step_mm": 5.0}],
    ],
)
def test_bones_stay_apart_at_the_limits(given: list[dict[str, object]]) -> None:
    from tests.phantoms.test_knee import holds

    holds(library.document("knee", {}, given), 2.5)


def test_findings_of_a_left_knee_are_on_its_left() -> None:
    given = [{"type": "lytic_lesion", "site": "medial_tibial_plateau"}]
    (right,) = library.document("knee", {}, given).findings
    (left,) = library.document("knee", {"side": "left"}, given).findings
    assert left.center == (-right.center[0], *right.center[1:])  # type: ignore[index]
    assert names_at(wrong(*given, side="left"), left.center) == ["lytic lesion"]
