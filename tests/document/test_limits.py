"""Depth, number and length are bounded after instances are expanded, without expanding them."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

import phantom.document
from phantom.errors import InvalidInputError, Problem

Judge = Callable[[object], list[Problem]]
TRANSFORMED = {"type": "transformed"}


def chain(solid: Any, levels: int) -> Any:
    for _ in range(levels):
        solid = {**TRANSFORMED, "solid": solid}
    return solid


def test_sixty_four_levels_are_read_and_one_more_is_refused(
    sphere: Any, written: Any, problems: Judge
) -> None:
    assert problems(written(chain(sphere(), 63))) == []
    [problem] = problems(written(chain(sphere(), 64)))
    assert (problem.path, problem.kind) == ("/solid", "too_deep")
    assert "found solids nested 65 deep" in problem.message


def test_depth_counts_through_instances(sphere: Any, written: Any, problems: Judge) -> None:
    definitions = {"half": chain(sphere(), 31)}
    instance = {"type": "instance", "of": "half"}
    assert problems(written(chain(instance, 31), definitions=definitions)) == []
    [problem] = problems(written(chain(instance, 32), definitions=definitions))
    assert (problem.path, problem.kind) == ("/solid", "too_deep")


def test_twenty_thousand_solids_are_read_and_one_more_is_refused(
    sphere: Any, written: Any, problems: Judge
) -> None:
    many = {"type": "union", "solids": [sphere()] * 19_999}
    assert problems(written(many)) == []
    more = {"type": "union", "solids": [sphere()] * 20_000}
    [problem] = problems(written(more))
    assert (problem.path, problem.kind) == ("/solid", "too_many_solids")
    assert "found 20001 solids" in problem.message


def test_doubling_definitions_are_counted_and_not_expanded(
    sphere: Any, written: Any, problems: Judge
) -> None:
    definitions: dict[str, Any] = {"d0": sphere()}
    for i in range(1, 60):
        twice = [{"type": "instance", "of": f"d{i - 1}"}] * 2
        definitions[f"d{i}"] = {"type": "union", "solids": twice}
    found = problems(written({"type": "instance", "of": "d59"}, definitions=definitions))
    assert {(p.path, p.kind) for p in found} == {
        ("/solid", "too_deep"),
        ("/solid", "too_many_solids"),
    }


def test_an_array_holds_ten_thousand_numbers(sphere: Any, written: Any, problems: Judge) -> None:
    assert problems(written(sphere(), parameters={"x": [0.5] * 10_000})) == []
    [problem] = problems(written(sphere(), parameters={"x": [0.5] * 10_001}))
    assert (problem.path, problem.kind) == ("/parameters/x", "too_long")
    assert "found 10001 numbers; expected at most 10000" in problem.message


def test_points_of_a_curve_count_together(sphere: Any, written: Any, problems: Judge) -> None:
    points = [[i, 0, 0] for i in range(3_334)]
    axis = {"type": "spline", "points": points}
    solid = {
        "type": "generalized_cylinder",
        "axis": axis,
        "contour": {"type": "circle", "radius": 1},
        "material": "bone",
    }
    [problem] = problems(written(solid))
    assert (problem.path, problem.kind) == ("/solid/axis/points", "too_long")


@pytest.mark.parametrize("levels", [190, 1_000, 100_000])
def test_a_tree_of_any_depth_is_refused_quietly(
    levels: int, sphere: Any, written: Any, problems: Judge
) -> None:
    assert [p.kind for p in problems(written(chain(sphere(), levels)))] == ["too_deep"]


@pytest.mark.parametrize("levels", [990, 1_000, 100_000])
@pytest.mark.parametrize(("left", "right"), [("[", "]"), ('{"a":', "}")])
def test_json_of_any_depth_is_refused_quietly(
    levels: int, left: str, right: str, problems: Judge
) -> None:
    text = left * levels + "1" + right * levels
    assert [p.kind for p in problems(text.encode())] == ["too_deep"]


def test_a_tree_that_contains_itself_is_refused(sphere: Any, written: Any, problems: Judge) -> None:
    ring: list[Any] = []
    ring.append(ring)
    assert [p.kind for p in problems(written(sphere(), parameters={"x": ring}))] == ["too_deep"]
    loop: dict[str, Any] = {"type": "transformed"}
    loop["solid"] = loop
    assert [p.kind for p in problems(written(loop))] == ["too_deep"]


def test_shared_values_cost_no_more_than_their_share(
    sphere: Any, written: Any, problems: Judge
) -> None:
    laugh: list[Any] = ["ha"] * 10
    for _ in range(20):
        laugh = [laugh] * 10
    [problem] = problems(written(sphere(), parameters={"x": laugh}))
    assert (problem.path, problem.kind) == ("", "too_large")


def test_very_many_problems_are_cut_short(sphere: Any, written: Any, problems: Judge) -> None:
    solids = [sphere(radius=-1, material="gold") for _ in range(2_000)]
    found = problems(written({"type": "union", "solids": solids}))
    assert len(found) == 1_001
    assert found[-1].kind == "too_many_problems"


def test_a_long_value_is_not_echoed(sphere: Any, written: Any, problems: Judge) -> None:
    text = "q" * 1_000_000
    tree = written(sphere(radius=text, material=text, cuts=text, type=text), format=text)
    found = problems(tree) + problems(written(sphere(name=text, appearance={"color": text})))
    assert found
    assert all(len(p.message) < 500 for p in found)


def test_a_body_of_a_request_is_judged_by_the_same_rules() -> None:
    tree = phantom.document.decode_json(b'{"point": [0, 0, NaN], "normal": [0, 0]}')
    with pytest.raises(InvalidInputError) as refusal:
        phantom.document.validate_model(phantom.document.Cut, tree)
    assert [(p.path, p.kind) for p in refusal.value.problems] == [
        ("/normal", "wrong_length"),
        ("/point/2", "not_finite"),
    ]


def test_problems_are_listed_in_the_order_of_their_place(
    sphere: Any, written: Any, problems: Judge
) -> None:
    solids = [sphere(radius=0) for _ in range(12)]
    paths = [p.path for p in problems(json.dumps(written({"type": "union", "solids": solids})))]
    assert paths == [f"/solid/solids/{i}/radius" for i in range(12)]
