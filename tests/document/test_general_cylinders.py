"""Formulas, matrices and morphs in a generalized cylinder are read, or refused at their place."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import pytest

import phantom.document as doc
from phantom.errors import Problem

Tree = dict[str, Any]
Judge = Callable[[object], list[Problem]]
Make = Callable[..., Tree]

CIRCLE = {"type": "circle", "radius": 2}
FORMULA_AXIS = {"type": "formula", "x": "u", "y": "0", "z": "u**2", "range": [-1, 3]}
ROWS = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


@pytest.fixture
def cylinder(written: Callable[..., Tree]) -> Make:
    """A document of one generalized cylinder; None takes a field away."""

    def make(**fields: Any) -> Tree:
        body: Tree = {
            "type": "generalized_cylinder",
            "material": "bone",
            "axis": {"type": "line", "start": [0, 0, 0], "end": [0, 0, 9]},
            "contour": CIRCLE,
            **fields,
        }
        return written({key: value for key, value in body.items() if value is not None})

    return make


def morph(*at: float) -> Tree:
    return {"type": "morph", "contours": [{"at": u, "contour": CIRCLE} for u in at]}


def linear(**fields: Any) -> Tree:
    return {"type": "linear", **fields}


def polar(**fields: Any) -> Tree:
    return {"type": "polar", **fields}


def matrix(row: int, column: int, value: Any) -> Tree:
    rows = copy.deepcopy(ROWS)
    rows[row][column] = value
    return linear(matrix=rows)


KNOTS = {"knots": [[-1, 1], [0, 2], [3, 1]]}


@pytest.mark.parametrize(
    "fields",
    [
        {"axis": FORMULA_AXIS},
        {"axis": {**FORMULA_AXIS, "closed": True}},
        {"axis": FORMULA_AXIS, "sweep": linear(scale=KNOTS)},
        {"axis": FORMULA_AXIS, "sweep": matrix(0, 1, KNOTS)},
        {"axis": FORMULA_AXIS, "sweep": morph(-1, 3), "contour": None},
        {"sweep": morph(0, 0.5, 1), "contour": None},
        {"sweep": linear(scale={"formula": "1 + u/2"})},
        {"sweep": linear(scale=[{"formula": "1 + u/2"}, 2], rotate_deg={"formula": "90*u"})},
        {"sweep": linear(offset=[{"formula": "sin(pi*u)"}, {"knots": [[0, 0], [1, 2]]}])},
        {"sweep": linear(matrix=ROWS)},
        {"sweep": matrix(2, 0, {"formula": "u**2"})},
        {"sweep": {"type": "formula", "forward": ["x*2", "y+u"], "inverse": ["x/2", "y-u"]}},
        {"contour": polar(formula="5 + cos(3*theta)")},
        {"contour": {"type": "polygon", "points": [[0, 0], [1, 0], [0, 1]], "corner_radius": 0}},
    ],
)
def test_what_is_read_says_the_same_when_written_again(
    fields: Tree, cylinder: Make, problems: Judge
) -> None:
    tree = cylinder(**fields)
    assert problems(tree) == []
    document = doc.parse(tree)
    assert doc.parse(document.model_dump(mode="json")) == document
    assert doc.read(document) == document


def test_the_kinds_of_sweep_and_profile_are_told_apart(cylinder: Make) -> None:
    def solid(**fields: Any) -> Any:
        return doc.parse(cylinder(**fields)).solid

    assert isinstance(solid().sweep, doc.LinearSweep)
    assert isinstance(solid(sweep=linear(matrix=ROWS)).sweep, doc.MatrixSweep)
    assert isinstance(solid(sweep=morph(0, 1), contour=None).sweep, doc.MorphSweep)
    scale = [{"formula": "u + 1"}, {"knots": [[0, 1], [1, 2]]}]
    sweep = solid(sweep=linear(scale=scale)).sweep
    assert sweep.scale == (
        doc.FormulaProfile(formula="u + 1"),
        doc.KnotProfile(knots=((0, 1), (1, 2))),
    )
    assert doc.parameter_range(solid().axis) == (0, 1)
    assert doc.parameter_range(solid(axis=FORMULA_AXIS).axis) == (-1, 3)


REFUSED: list[tuple[Tree, str, str, str]] = [
    # fields, path below the cylinder, kind, words of the message
    ({"axis": {**FORMULA_AXIS, "x": "u +"}}, "/axis/x", "bad_formula", "the end at column 4"),
    ({"axis": {**FORMULA_AXIS, "y": "v"}}, "/axis/y", "bad_formula", "expected u, pi or a fun"),
    ({"axis": {**FORMULA_AXIS, "z": 3}}, "/axis/z", "not_a_string", "found 3"),
    (
        {"axis": {**FORMULA_AXIS, "z": "u" * 2_001}},
        "/axis/z",
        "wrong_length",
        "found 2001 characters; expected at most 2000",
    ),
    ({"axis": {**FORMULA_AXIS, "range": [1, 1]}}, "/axis/range", "bad_range", "found 1 to 1"),
    ({"axis": {**FORMULA_AXIS, "range": [3, -1]}}, "/axis/range", "bad_range", "at least 3e-06"),
    ({"axis": {**FORMULA_AXIS, "range": [0, 1e9]}}, "/axis/range/1", "out_of_range", "1e+07"),
    ({"axis": {**FORMULA_AXIS, "range": [0]}}, "/axis/range", "wrong_length", "expected 2"),
    (
        {"contour": {"type": "formula", "x": "u", "y": "v", "range": [0, 1]}},
        "/contour/x",
        "bad_formula",
        "expected v, pi",
    ),
    ({"contour": polar()}, "/contour/radii", "missing", "expected radii or formula"),
    (
        {"contour": polar(radii=[1, 1, 1], formula="2")},
        "/contour/formula",
        "conflict",
        "not both",
    ),
    ({"contour": polar(formula="r")}, "/contour/formula", "bad_formula", "expected theta, pi"),
    ({"contour": None}, "/contour", "missing", "a contour, or a sweep that morphs"),
    ({"sweep": morph(0, 1)}, "/contour", "conflict", "found a contour too"),
    ({"contour": None, "sweep": morph(0)}, "/sweep/contours", "wrong_length", "at least 2"),
    ({"contour": None, "sweep": morph(0, 1, 1)}, "/sweep/contours/2/at", "bad_knots", "1 after 1"),
    (
        {"contour": None, "sweep": morph(0.1, 1)},
        "/sweep/contours/0/at",
        "bad_knots",
        "first contour at exactly 0",
    ),
    (
        {"contour": None, "sweep": morph(-1, 1), "axis": FORMULA_AXIS},
        "/sweep/contours/1/at",
        "bad_knots",
        "found u = 1; expected the last contour at exactly 3",
    ),
    (
        {"contour": None, "sweep": {"type": "morph", "contours": [{"at": 0}, {"at": 1}]}},
        "/sweep/contours/0/contour",
        "missing",
        "missing",
    ),
    (
        {"axis": FORMULA_AXIS, "sweep": linear(shear={"knots": [[-1, 0], [1, 0]]})},
        "/sweep/shear/knots/1/0",
        "bad_knots",
        "last knot at exactly 3",
    ),
    (
        {"sweep": matrix(1, 1, {"knots": [[0.5, 1], [1, 1]]})},
        "/sweep/matrix/1/1/knots/0/0",
        "bad_knots",
        "first knot at exactly 0",
    ),
    ({"sweep": matrix(0, 2, 1)}, "/sweep/matrix/0/2", "bad_matrix", "found 1; expected the number"),
    ({"sweep": matrix(2, 2, {"formula": "1"})}, "/sweep/matrix/2/2", "bad_matrix", "a profile"),
    ({"sweep": linear(matrix=ROWS[:2])}, "/sweep/matrix", "wrong_length", "expected 3"),
    ({"sweep": linear(matrix=ROWS, shear=1)}, "/sweep/shear", "unknown_field", "not known here"),
    (
        {"sweep": linear(shear={"formula": "x"})},
        "/sweep/shear/formula",
        "bad_formula",
        "expected u, pi",
    ),
    (
        {"sweep": linear(shear={"formula": "u", "knots": []})},
        "/sweep/shear",
        "not_a_number",
        "with either knots or formula",
    ),
    ({"sweep": linear(scale=[{}, 1])}, "/sweep/scale/0", "not_a_number", "an object with 0 fields"),
    (
        {"sweep": {"type": "formula", "forward": ["x", "y"]}},
        "/sweep/inverse",
        "missing",
        "missing",
    ),
    (
        {"sweep": {"type": "formula", "forward": ["x", "y"], "inverse": ["x", "v"]}},
        "/sweep/inverse/1",
        "bad_formula",
        "expected x, y, u, pi",
    ),
    (
        {"sweep": {"type": "formula", "forward": ["x"], "inverse": ["x", "y"]}},
        "/sweep/forward",
        "wrong_length",
        "found 1 value; expected 2",
    ),
]


@pytest.mark.parametrize(("fields", "below", "kind", "said"), REFUSED)
def test_a_bad_field_is_refused_at_its_place(
    fields: Tree, below: str, kind: str, said: str, cylinder: Make, problems: Judge
) -> None:
    found = problems(cylinder(**fields))
    assert (found[0].path, found[0].kind) == (f"/solid{below}", kind)
    assert said in found[0].message


def test_every_end_that_is_missed_is_told_at_once(cylinder: Make, problems: Judge) -> None:
    short = {"knots": [[0.1, 1], [0.9, 1]]}
    found = problems(cylinder(sweep=linear(scale=[short, 1], offset=[0, short])))
    assert [p.path for p in found] == [
        f"/solid/sweep/{place}/knots/{i}/0" for place in ("offset/1", "scale/0") for i in (0, 1)
    ]
