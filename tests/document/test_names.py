"""Names lead somewhere, labels are single, and what can surface has a material."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import phantom.document
from phantom.errors import Problem

Judge = Callable[[object], list[Problem]]


def instance(of: str, **fields: Any) -> dict[str, Any]:
    return {"type": "instance", "of": of, **fields}


def operator(kind: str, *solids: Any) -> dict[str, Any]:
    return {"type": kind, "solids": list(solids)}


def test_a_material_must_be_defined(sphere: Any, written: Any, problems: Judge) -> None:
    [problem] = problems(written(operator("union", sphere(), sphere(material="bon"))))
    assert (problem.path, problem.kind) == ("/solid/solids/1/material", "undefined_material")
    assert problem.message == "found 'bon'; expected one of the materials: 'bone'"


def test_an_instance_must_be_of_a_definition(sphere: Any, written: Any, problems: Judge) -> None:
    [problem] = problems(written(instance("blad"), definitions={"blade": sphere()}))
    assert (problem.path, problem.kind) == ("/solid/of", "undefined_definition")
    assert "found 'blad'; expected one of the definitions: 'blade'" in problem.message


def test_no_definition_contains_itself(sphere: Any, written: Any, problems: Judge) -> None:
    definitions = {"a": operator("union", sphere(), instance("b")), "b": instance("a")}
    [problem] = problems(written(sphere(), definitions=definitions))
    assert (problem.path, problem.kind) == ("/definitions/b/of", "cyclic_instance")
    assert "'a' → 'b' → 'a'" in problem.message


def test_a_definition_of_itself_is_a_circle(written: Any, problems: Judge) -> None:
    [problem] = problems(written(instance("a"), definitions={"a": instance("a")}))
    assert (problem.path, problem.kind) == ("/definitions/a/of", "cyclic_instance")


def test_unused_definitions_are_judged_too(sphere: Any, written: Any, problems: Judge) -> None:
    definitions = {"a/b": sphere(radius=-1, material="gold")}
    assert [p.path for p in problems(written(sphere(), definitions=definitions))] == [
        "/definitions/a~1b/material",
        "/definitions/a~1b/radius",
    ]


@pytest.mark.parametrize("kind", ["difference", "intersection"])
def test_only_the_right_of_a_difference_or_intersection_needs_no_material(
    kind: str, sphere: Any, written: Any, problems: Judge
) -> None:
    bare = sphere(material=None)
    assert problems(written(operator(kind, sphere(), bare, bare))) == []
    [problem] = problems(written(operator(kind, bare, sphere())))
    assert (problem.path, problem.kind) == ("/solid/solids/0/material", "missing_material")


@pytest.mark.parametrize("kind", ["union", "overlap", "replace"])
def test_both_sides_of_the_other_operators_need_a_material(
    kind: str, sphere: Any, written: Any, problems: Judge
) -> None:
    [problem] = problems(written(operator(kind, sphere(), sphere(material=None))))
    assert (problem.path, problem.kind) == ("/solid/solids/1/material", "missing_material")


def test_all_below_the_right_of_a_difference_is_hidden(
    sphere: Any, written: Any, problems: Judge
) -> None:
    bare = sphere(material=None)
    hole = {"type": "transformed", "solid": operator("union", bare, bare)}
    assert problems(written(operator("difference", sphere(), hole))) == []


def test_a_definition_may_be_hidden_in_one_use_and_refused_in_another(
    sphere: Any, written: Any, problems: Judge
) -> None:
    definitions = {"ball": sphere(material=None)}
    hidden = operator("difference", sphere(), instance("ball"))
    assert problems(written(hidden, definitions=definitions)) == []
    shown = operator("union", hidden, instance("ball"))
    [problem] = problems(written(shown, definitions=definitions))
    assert (problem.path, problem.kind) == ("/definitions/ball/material", "missing_material")
    assert "through /solid/solids/1" in problem.message


def test_equal_labels_are_refused(sphere: Any, written: Any, problems: Judge) -> None:
    [problem] = problems(written(operator("union", sphere(name="a"), sphere(name="a"))))
    assert (problem.path, problem.kind) == ("/solid/solids/1/name", "repeated_label")
    assert "found the label 'a', that of /solid/solids/0 too" in problem.message


def test_instances_are_told_apart_by_their_names(
    sphere: Any, written: Any, problems: Judge
) -> None:
    definitions = {"blade": sphere(name="leaf")}
    named = operator("union", instance("blade", name="one"), instance("blade", name="two"))
    assert problems(written(named, definitions=definitions)) == []
    [problem] = problems(
        written(operator("union", instance("blade"), instance("blade")), definitions=definitions)
    )
    assert (problem.path, problem.kind) == ("/solid/solids/1", "repeated_label")


def test_equal_labels_within_a_definition_are_told_where_they_are_written(
    sphere: Any, written: Any, problems: Judge
) -> None:
    definitions = {"pair": operator("union", sphere(name="a"), sphere(name="a"))}
    [problem] = problems(written(instance("pair"), definitions=definitions))
    assert problem.path == "/definitions/pair/solids/1/name"


def test_leaves_without_any_name_have_no_label_to_share(
    sphere: Any, written: Any, problems: Judge
) -> None:
    assert problems(written(operator("union", sphere(), sphere()))) == []


def test_a_hidden_unnamed_leaf_shares_no_label(sphere: Any, written: Any, problems: Judge) -> None:
    solid = operator("difference", sphere(), sphere(material=None))
    assert problems(written({"type": "transformed", "name": "femur", "solid": solid})) == []


def test_a_finding_names_leaves_that_are_there(sphere: Any, written: Any, problems: Judge) -> None:
    findings = [{"name": "lump", "kind": "mass", "leaves": ["a", "b"], "size_mm": 4}]
    [problem] = problems(written(sphere(name="a"), findings=findings))
    assert (problem.path, problem.kind) == ("/findings/0/leaves/1", "undefined_leaf")


def test_a_label_is_the_names_from_the_root() -> None:
    assert phantom.document.label_of(["leg", None, "femur"]) == "leg/femur"


@pytest.mark.parametrize("code", ["72696002", {"value": "72696002"}, {"value": 1, "scheme": "SCT"}])
def test_a_header_code_has_a_value_a_scheme_and_a_meaning(
    sphere: Any, written: Any, problems: Judge, code: Any
) -> None:
    anatomy = {"codes": {"AnatomicRegionSequence": code, "mine": 5}}
    [problem] = problems(written(sphere(), anatomy=anatomy))
    assert problem.path == "/anatomy/codes/AnatomicRegionSequence"
    assert "meaning, scheme, value" in problem.message
