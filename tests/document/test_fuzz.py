"""Whatever tree is given, it is read or refused with problems, and nothing else happens."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import phantom.document
from phantom.document.solids import LEAVES, OPERATORS
from phantom.errors import InvalidDocumentError

KNEE_LIKE = json.loads((Path(__file__).parents[2] / "bench" / "knee-like.json").read_text())
TYPES = [*LEAVES, *OPERATORS, "transformed", "instance", "line", "spline", "circle", "linear"]
TYPES += ["formula", "morph", "polar", "polygon"]
FIELDS = sorted(
    {name for model in LEAVES.values() for name in model.model_fields}
    | {"solids", "solid", "of", "materials", "definitions", "points", "knots", "scale", "format"}
    | {"formula", "range", "x", "y", "forward", "inverse", "contours", "at", "radii"}
    | {"matrix", "rotate", "reference", "composition", "attenuation_per_mm", "findings", "degree"}
)
odd_numbers = st.sampled_from([float("nan"), float("inf"), 10**4000, -(10**400), 1e308, 5e-324, 0])
scalars = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | odd_numbers
    | st.text(st.characters(codec=None), max_size=5)
    | st.sampled_from([*TYPES, "bone", "a", "phantom/1", "\ud800", "x" * 300, "u**2", "u +"])
)
keys = st.sampled_from(["type", *FIELDS, "a"]) | st.text(st.characters(codec=None), max_size=3)
trees = st.recursive(
    scalars,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(keys, inner, max_size=5)
        | st.builds(
            lambda kind, rest: {**rest, "type": kind},
            st.sampled_from(TYPES),
            st.dictionaries(st.sampled_from(FIELDS), inner, max_size=5),
        )
    ),
    max_leaves=30,
)


def check(tree: Any) -> None:
    problems = []
    try:
        phantom.document.parse(tree)
    except InvalidDocumentError as error:
        problems = list(error.problems)
    for problem in problems:
        assert problem.path == "" or problem.path.startswith("/")
        assert len(problem.message) < 600
        assert f"{problem.path}{problem.kind}{problem.message}".encode()


@given(trees)
@settings(max_examples=400, deadline=None)
def test_a_random_tree_is_read_or_refused(tree: Any) -> None:
    check(tree)


@given(st.dictionaries(st.sampled_from(list(phantom.document.Document.model_fields)), trees), trees)
@settings(max_examples=400, deadline=None)
def test_a_random_document_is_read_or_refused(fields: dict[str, Any], solid: Any) -> None:
    check({"materials": {"bone": {"attenuation_per_mm": 1}}, "solid": solid, **fields})


def _places(tree: Any) -> list[tuple[Any, Any]]:
    found, stack = [], [tree]
    while stack:
        node = stack.pop()
        items = node.items() if isinstance(node, dict) else enumerate(node)
        for key, value in items:
            found.append((node, key))
            if isinstance(value, (dict, list)):
                stack.append(value)
    return found


@given(st.data())
@settings(max_examples=400, deadline=None)
def test_a_document_with_some_values_replaced_is_read_or_refused(data: st.DataObject) -> None:
    tree = copy.deepcopy(KNEE_LIKE)
    for _ in range(data.draw(st.integers(1, 3))):
        places = _places(tree)
        node, key = places[data.draw(st.integers(0, len(places) - 1))]
        node[key] = data.draw(trees)
    check(tree)


@given(st.binary(max_size=60) | st.text(max_size=60))
@settings(max_examples=300, deadline=None)
def test_random_text_is_refused(source: bytes | str) -> None:
    with pytest.raises(InvalidDocumentError, match="found"):
        phantom.document.read(source)
