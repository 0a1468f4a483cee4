"""The knee of 1993 measured by the engine: the sizes of a knee, and the paper's six parts."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
import pytest

from phantom import library
from phantom.errors import InvalidInputError
from phantom.scene import Phantom, load
from phantom.tracing import Intervals, path_lengths

Along = Callable[..., Intervals]

BODY = np.arange(-46.0, 46.5)
MEDIAL_X, CONTACT_Y = np.arange(10.0, 35.0, 0.5), np.arange(5.0, 25.0, 0.5)


@pytest.fixture(scope="module")
def knee() -> Phantom:
    return library.build("knee-1993")


def of(found: Intervals, name: str) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Pick the rows of one leaf."""
    return found.leaf == found.leaf_names.index(name)


def extent_mm(found: Intervals, name: str) -> float:
    """Distance between the first and the last point of a leaf along parallel rays."""
    rows = of(found, name)
    return float(found.exit_mm[rows].max() - found.entry_mm[rows].min())


def joint_space_mm(knee: Phantom, along: Along) -> float:
    """Least vertical distance between the tibia and the femur's medial condyle."""
    found = along(knee, "z", MEDIAL_X, CONTACT_Y)
    rays = len(MEDIAL_X) * len(CONTACT_Y)
    top, bottom = np.full(rays, -np.inf), np.full(rays, np.inf)
    tibia, femur = of(found, "tibia"), of(found, "femur")
    np.maximum.at(top, found.ray[tibia], found.exit_mm[tibia])
    np.minimum.at(bottom, found.ray[femur], found.entry_mm[femur])
    return float((bottom - top).min())


def test_six_primitives_as_in_the_paper(knee: Phantom) -> None:
    def types(tree: Any) -> list[tuple[str, str]]:
        below = [tree["solid"]] if "solid" in tree else tree.get("solids")
        if below is None:
            return [(tree["name"], tree["type"])]
        return [leaf for part in below for leaf in types(part)]

    assert types(knee.document.solid.model_dump(mode="json")) == [
        ("femur", "generalized_cylinder"),
        ("notch", "ellipsoid"),
        ("patella", "ellipsoid"),
        ("tibia", "generalized_cylinder"),
        ("fibula", "generalized_cylinder"),
        ("fibular head", "ellipsoid"),
    ]
    assert knee.leaf_names == ("femur", "notch", "patella", "tibia", "fibula", "fibular head")


def test_joint_space_is_what_was_asked_for(along: Along) -> None:
    for space, width in ((1.0, 110.0), (5.7, 88.6), (10.0, 60.0)):
        knee = library.build("knee-1993", joint_space_mm=space, bicondylar_width_mm=width)
        assert joint_space_mm(knee, along) == pytest.approx(space, abs=0.05)


@pytest.mark.parametrize("width", [60.0, 78.5, 88.6, 110.0])
def test_bicondylar_width_is_what_was_asked_for(width: float, along: Along) -> None:
    knee = library.build("knee-1993", bicondylar_width_mm=width)
    found = along(knee, "x", np.arange(-25.0, 50.0), np.arange(5.0, 60.0))
    assert extent_mm(found, "femur") == pytest.approx(width, rel=0.002)


def test_published_sizes(knee: Phantom, along: Along) -> None:
    """Men's means, from the sources the document cites."""
    depth = extent_mm(along(knee, "y", BODY, np.arange(2.0, 60.0)), "femur")
    assert depth == pytest.approx(61.1, abs=0.5)
    assert extent_mm(along(knee, "x", 2.0, 115.0), "femur") == pytest.approx(26.5, abs=0.3)
    below = np.arange(-15.0, -2.0)
    across = extent_mm(along(knee, "x", np.arange(-20.0, 40.0), below), "tibia")
    assert across == pytest.approx(76.1, abs=0.5)
    assert extent_mm(along(knee, "y", BODY, below), "tibia") == pytest.approx(48.2, abs=0.5)


def test_notch_is_as_wide_as_its_ellipsoid(knee: Phantom, along: Along) -> None:
    through_center = along(knee, "x", 34.0, 14.0 + 5.7 / 2)
    assert through_center.exit_mm[0] == pytest.approx(-11.0, abs=1e-9)
    assert through_center.entry_mm[1] == pytest.approx(11.0, abs=1e-9)


def test_patella_is_hidden_in_front_view_and_clear_in_side_view(
    knee: Phantom, along: Along
) -> None:
    x, y, z = knee.document.landmarks["patella"]
    front = along(knee, "y", x, z)
    assert [front.leaf_names[leaf] for leaf in front.leaf][:2] == ["patella", "femur"]
    assert 3.0 < front.entry_mm[1] - front.exit_mm[0] < 8.0
    side = along(knee, "x", y, z)
    assert [side.leaf_names[leaf] for leaf in side.leaf] == ["patella"]
    assert side.exit_mm[0] - side.entry_mm[0] == pytest.approx(44.8, abs=1e-9)


def test_condyles_reach_behind_the_shaft(knee: Phantom, along: Along) -> None:
    condyles = along(knee, "y", 22.0, 25.0)
    shaft = along(knee, "y", -6.0, 120.0)
    assert condyles.exit_mm.max() > shaft.exit_mm.max() + 20.0


def test_shaft_leans_outward_by_its_valgus(along: Along) -> None:
    middles = []
    for valgus in (0.0, 12.0):
        knee = library.build("knee-1993", valgus_deg=valgus)
        shaft = along(knee, "x", 2.0, np.array([90.0, 130.0]))
        middles.append((shaft.entry_mm + shaft.exit_mm) / 2)
    assert np.ptp(middles[0]) < 0.1
    lean_deg = np.degrees(np.arctan2(middles[1][0] - middles[1][1], 40.0))
    assert lean_deg == pytest.approx(12.0, abs=1.0)


@pytest.mark.parametrize(("side", "outward"), [("right", -1.0), ("left", 1.0)])
def test_fibula_is_at_the_outer_side_below_the_plateau(side: str, outward: float) -> None:
    knee = library.build("knee-1993", side=side)
    low, high = knee.leaf_bounds[knee.leaf_names.index("fibular head")]
    assert np.sign(low[0]) == np.sign(high[0]) == outward
    assert high[2] < -5.7 / 2 - 8.0
    assert np.allclose((low + high) / 2, knee.document.landmarks["fibular_head"])
    assert knee.document.anatomy is not None
    assert knee.document.anatomy.laterality == side


def test_left_knee_is_the_mirror_image(knee: Phantom) -> None:
    rng = np.random.default_rng(1993)
    origins = rng.uniform(-200.0, 200.0, (2000, 3))
    directions = rng.uniform(-60.0, 60.0, (2000, 3)) - origins
    mirror = np.array([-1.0, 1.0, 1.0])
    right = path_lengths(knee, origins, directions)
    left = path_lengths(
        library.build("knee-1993", side="left"), origins * mirror, directions * mirror
    )
    assert (right > 0).mean() > 0.3
    assert np.allclose(left, right, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("width", "space", "valgus"), list(product((60.0, 110.0), (1.0, 10.0), (0.0, 12.0)))
)
def test_bones_never_touch(
    width: float, space: float, valgus: float, overlapping: Callable[..., Any]
) -> None:
    """Where bones shared space, densities that add would change a ray's path."""
    knee = library.build(
        "knee-1993", bicondylar_width_mm=width, joint_space_mm=space, valgus_deg=valgus
    )
    tree = knee.document.model_dump(mode="json")
    added = load({**tree, "solid": overlapping(tree["solid"], "fibula", "fibular head")})
    spread = np.arange(-75.0, 75.0, 1.25)
    for index in range(3):
        grid = np.meshgrid(spread, spread, indexing="ij")
        origins = np.full((grid[0].size, 3), -400.0)
        origins[:, [i for i in range(3) if i != index]] = np.stack(
            [side.ravel() for side in grid], axis=1
        )
        directions = np.broadcast_to(np.eye(3)[index], origins.shape)
        union = path_lengths(knee, origins, directions)
        assert union.max() > 10.0
        assert np.allclose(path_lengths(added, origins, directions), union, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "changed",
    [
        {"side": "left"},
        {"bicondylar_width_mm": 80.0},
        {"joint_space_mm": 3.0},
        {"valgus_deg": 3.0},
        {"attenuation_per_mm": 0.05},
    ],
)
def test_every_parameter_changes_the_document(changed: dict[str, object]) -> None:
    usual, other = library.document("knee-1993"), library.document("knee-1993", changed)
    assert (usual.solid, usual.materials) != (other.solid, other.materials)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("side", "middle"),
        ("bicondylar_width_mm", 59.9),
        ("joint_space_mm", 0.0),
        ("valgus_deg", 13.0),
        ("attenuation_per_mm", float("nan")),
    ],
)
def test_values_out_of_range_are_refused(name: str, value: object) -> None:
    with pytest.raises(InvalidInputError) as refused:
        library.build("knee-1993", **{name: value})
    assert [problem.path for problem in refused.value.problems] == [f"/parameters/{name}"]
