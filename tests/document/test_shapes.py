"""Each rule of a leaf, an axis, a contour, a sweep or a transform refuses at its place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from phantom.errors import Problem

Tree = dict[str, Any]
Judge = Callable[[object], list[Problem]]

LEAVES: dict[str, Tree] = {
    "sphere": {"center": [0, 0, 0], "radius": 1},
    "ellipsoid": {"center": [0, 0, 0], "semi_axes": [1, 2, 3]},
    "cylinder": {"start": [0, 0, 0], "end": [0, 0, 1], "radius": 1},
    "cone": {"start": [0, 0, 0], "end": [0, 0, 1], "start_radius": 1, "end_radius": 0},
    "double_cone": {
        "apex": [0, 0, 0],
        "axis": [0, 0, 1],
        "slope": 1,
        "cuts": [{"point": [0, 0, 1], "normal": [0, 0, 1]}],
    },
    "box": {"center": [0, 0, 0], "size": [1, 1, 1]},
    "quadric": {"coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, -1]},
    "generalized_cylinder": {
        "axis": {"type": "line", "start": [0, 0, 0], "end": [0, 0, 1]},
        "contour": {"type": "circle", "radius": 1},
    },
}
AXES: dict[str, Tree] = {
    "line": {"start": [0, 0, 0], "end": [0, 0, 1]},
    "spline": {"points": [[0, 0, 0], [0, 0, 1], [0, 1, 2]]},
    "bspline": {"control_points": [[0, 0, 0], [0, 0, 1], [0, 1, 2]], "degree": 2},
    "arc": {"center": [0, 0, 0], "normal": [0, 0, 1], "start": [5, 0, 0], "angle_deg": 90},
    "formula": {"x": "5*cos(u)", "y": "5*sin(u)", "z": "u/2", "range": [0, 12.5]},
    "helix": {"center": [0, 0, 0], "axis": [0, 0, 1], "start": [5, 0, 0], "pitch": 3, "turns": -2},
}
CONTOURS: dict[str, Tree] = {
    "circle": {"radius": 1},
    "ellipse": {"semi_axes": [1, 2]},
    "superellipse": {"semi_axes": [1, 2], "exponent": 4},
    "polygon": {"points": [[0, 0], [1, 0], [0, 1]], "corner_radius": 0.1},
    "spline": {"points": [[1, 0], [0, 1], [-1, -1]]},
    "polar": {"radii": [1, 1, 1, 2]},
    "formula": {"x": "2*cos(v)", "y": "sin(v)", "range": [-3.2, 3.2]},
}
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
CIRCLES = [{"at": at, "contour": {"type": "circle", "radius": 1 + at}} for at in (0, 0.25, 1)]
SWEEPS: dict[str, Tree] = {
    "linear": {},
    "morph": {"contours": CIRCLES},
    "formula": {"forward": ["x + y*u", "y"], "inverse": ["x - y*u", "y"]},
}


@pytest.fixture
def whole(written: Callable[..., Tree]) -> Callable[[str, str, Tree], Tree]:
    """A document in which one part of a kind has fields changed (None: taken away)."""

    def make(part: str, kind: str, changes: Tree) -> Tree:
        table = {"solid": LEAVES, "axis": AXES, "contour": CONTOURS, "sweep": SWEEPS}.get(part, {})
        made = {"type": kind, **table.get(kind, {}), **changes}
        made = {key: value for key, value in made.items() if value is not None}
        if part == "solid":
            return written({"material": "bone", **made})
        body = {
            "type": "generalized_cylinder",
            "material": "bone",
            **LEAVES["generalized_cylinder"],
        }
        if made["type"] == "morph":
            del body["contour"]
        return written({**body, part: made})

    return make


@pytest.mark.parametrize(
    ("part", "kind"),
    [
        *(("solid", kind) for kind in LEAVES),
        *(("axis", kind) for kind in AXES),
        *(("contour", kind) for kind in CONTOURS),
        *(("sweep", kind) for kind in SWEEPS),
    ],
)
def test_every_shape_is_read(part: str, kind: str, whole: Any, problems: Judge) -> None:
    assert problems(whole(part, kind, {})) == []


UP = [0, 0, 1]
REFUSED: list[tuple[str, str, Tree, str, str, str]] = [
    # part, kind, changes, path below the part, kind of problem, words of the message
    ("solid", "sphere", {"radius": 0}, "/radius", "out_of_range", "found 0; expected at least"),
    ("solid", "sphere", {"radius": -3}, "/radius", "out_of_range", "found -3"),
    ("solid", "sphere", {"radius": True}, "/radius", "not_a_number", "found true"),
    ("solid", "sphere", {"radius": "3"}, "/radius", "not_a_number", "found '3'; expected a number"),
    ("solid", "sphere", {"radius": 1e9}, "/radius", "out_of_range", "at most 1e+07"),
    ("solid", "sphere", {"radius": None}, "/radius", "missing", "missing"),
    ("solid", "sphere", {"radiu": 1}, "/radiu", "unknown_field", "not known"),
    (
        "solid",
        "sphere",
        {"center": [0, 0]},
        "/center",
        "wrong_length",
        "found 2 values; expected 3",
    ),
    ("solid", "sphere", {"center": []}, "/center", "wrong_length", "found 0 values; expected 3"),
    ("solid", "sphere", {"center": [0] * 4}, "/center", "wrong_length", "found 4 values"),
    ("solid", "sphere", {"center": {"x": 0}}, "/center", "not_an_array", "found an object"),
    ("solid", "sphere", {"name": ""}, "/name", "wrong_length", "found 0 characters"),
    ("solid", "sphere", {"name": 7}, "/name", "not_a_string", "found 7; expected a string"),
    ("solid", "sphere", {"material": 7}, "/material", "not_a_string", "found 7"),
    ("solid", "ellipsoid", {"semi_axes": [1, 0, 1]}, "/semi_axes/1", "out_of_range", "found 0"),
    ("solid", "box", {"size": [1, 1, -1]}, "/size/2", "out_of_range", "found -1"),
    ("solid", "cylinder", {"end": [0, 0, 0]}, "/end", "degenerate", "found the point of start"),
    ("solid", "cylinder", {"radius": None}, "/radius", "missing", "radius, or semi_axes with up"),
    ("solid", "cylinder", {"semi_axes": [1, 2]}, "/semi_axes", "conflict", "not both"),
    ("solid", "cylinder", {"up": [1, 0, 0]}, "/up", "conflict", "up without semi_axes"),
    (
        "solid",
        "cylinder",
        {"radius": None, "semi_axes": [1, 2]},
        "/up",
        "missing",
        "expected up beside semi_axes",
    ),
    (
        "solid",
        "cylinder",
        {"radius": None, "semi_axes": [1, 2], "up": [0, 0, -2]},
        "/up",
        "degenerate",
        "parallel to the axis",
    ),
    (
        "solid",
        "cylinder",
        {"radius": None, "semi_axes": [1, 2], "up": [0, 0, 0]},
        "/up",
        "zero_vector",
        "expected a direction",
    ),
    ("solid", "cone", {"end": [0, 0, 0]}, "/end", "degenerate", "start"),
    ("solid", "cone", {"start_radius": -1}, "/start_radius", "out_of_range", "at least 0"),
    ("solid", "cone", {"start_radius": 0}, "/end_radius", "out_of_range", "0 at both ends"),
    ("solid", "double_cone", {"cuts": None}, "/cuts", "unbounded", "expected cuts"),
    ("solid", "double_cone", {"cuts": []}, "/cuts", "unbounded", "expected cuts"),
    ("solid", "double_cone", {"axis": [0, 0, 0]}, "/axis", "zero_vector", "expected a direction"),
    ("solid", "double_cone", {"slope": 0}, "/slope", "out_of_range", "found 0"),
    (
        "solid",
        "sphere",
        {"cuts": [{"point": [0, 0, 0], "normal": [0, 0, 0]}]},
        "/cuts/0/normal",
        "zero_vector",
        "expected a direction",
    ),
    ("solid", "quadric", {"coefficients": [1] * 9}, "/coefficients", "wrong_length", "expected 10"),
    ("solid", "quadric", {"coefficients": [0] * 9 + [1]}, "/coefficients", "degenerate", "A to I"),
    (
        "solid",
        "sphere",
        {"appearance": {"ambient": 0.5, "diffuse": 0.5}},
        "/appearance",
        "out_of_range",
        "= 1.2; expected at most 1",
    ),
    (
        "solid",
        "sphere",
        {"appearance": {"color": [0, 0, 2]}},
        "/appearance/color/2",
        "out_of_range",
        "at most 1",
    ),
    ("axis", "line", {"end": [0, 0, 0]}, "/end", "degenerate", "apart from start"),
    ("axis", "spline", {"points": [[0, 0, 0]]}, "/points", "wrong_length", "at least 2"),
    (
        "axis",
        "spline",
        {"points": [[0, 0, 0], [1, 0, 0]], "closed": True},
        "/points",
        "wrong_length",
        "expected 3 or more on a closed axis",
    ),
    (
        "axis",
        "spline",
        {"points": [[0, 0, 0], [1, 0, 0], [1, 0, 0]]},
        "/points/2",
        "equal_points",
        "same point as points/1",
    ),
    (
        "axis",
        "spline",
        {"points": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0]], "closed": True},
        "/points/3",
        "equal_points",
        "not to repeat it",
    ),
    ("axis", "spline", {"closed": "yes"}, "/closed", "not_a_boolean", "expected true or false"),
    ("axis", "bspline", {"degree": 0}, "/degree", "out_of_range", "at least 1"),
    ("axis", "bspline", {"degree": 3}, "/degree", "out_of_range", "degree 3 with 3 control"),
    ("axis", "bspline", {"degree": 1.5}, "/degree", "not_an_integer", "a whole number"),
    ("axis", "arc", {"start": [5, 0, 1]}, "/start", "out_of_plane", "1 mm off the plane"),
    ("axis", "arc", {"start": [0, 0, 0]}, "/start", "degenerate", "found the centre"),
    ("axis", "arc", {"angle_deg": 0}, "/angle_deg", "out_of_range", "not 0"),
    ("axis", "arc", {"angle_deg": 361}, "/angle_deg", "out_of_range", "at most 360"),
    ("axis", "arc", {"normal": [0, 0, 0]}, "/normal", "zero_vector", "expected a direction"),
    ("axis", "helix", {"turns": 0}, "/turns", "out_of_range", "not 0"),
    ("axis", "helix", {"start": [0, 0, 9]}, "/start", "degenerate", "on the helix's own axis"),
    ("axis", "helix", {"axis": [0, 0, 0]}, "/axis", "zero_vector", "expected a direction"),
    ("axis", "knot", {}, "/type", "unknown_type", "found 'knot'; expected one of line, spline"),
    ("contour", "circle", {"radius": 0}, "/radius", "out_of_range", "found 0"),
    ("contour", "ellipse", {"semi_axes": [1, 0]}, "/semi_axes/1", "out_of_range", "found 0"),
    ("contour", "superellipse", {"exponent": 1.9}, "/exponent", "out_of_range", "at least 2"),
    ("contour", "superellipse", {"exponent": 21}, "/exponent", "out_of_range", "at most 20"),
    ("contour", "polygon", {"points": [[0, 0], [1, 0]]}, "/points", "wrong_length", "at least 3"),
    ("contour", "polygon", {"corner_radius": None}, "/corner_radius", "missing", "missing"),
    ("contour", "polygon", {"corner_radius": -1}, "/corner_radius", "out_of_range", "found -1"),
    (
        "contour",
        "polygon",
        {"corner_radius": 1e-9},
        "/corner_radius",
        "out_of_range",
        "found 1e-09; expected 0 or at least 1e-06",
    ),
    (
        "contour",
        "polygon",
        {"points": [[0, 0], [1, 0], [1, 0], [0, 1]]},
        "/points/2",
        "equal_points",
        "same point",
    ),
    ("contour", "spline", {"points": [[0, 0], [1, 0]]}, "/points", "wrong_length", "at least 3"),
    ("contour", "polar", {"radii": [1, 1]}, "/radii", "wrong_length", "at least 3"),
    ("contour", "polar", {"radii": [1, -1, 1]}, "/radii/1", "out_of_range", "found -1"),
    ("sweep", "bend", {}, "/type", "unknown_type", "'bend'; expected one of linear, morph, form"),
    ("sweep", "matrix", {}, "/type", "unknown_type", "found 'matrix'; expected one of linear"),
    ("sweep", "linear", {"scale": "big"}, "/scale", "not_a_number", "found 'big'"),
    ("sweep", "linear", {"scale": [1, True]}, "/scale/1", "not_a_number", "found true"),
    ("sweep", "linear", {"offset": [1]}, "/offset", "wrong_length", "found 1 value; expected 2"),
    (
        "sweep",
        "linear",
        {"rotate_deg": {"knots": [[0, 1]]}},
        "/rotate_deg/knots",
        "wrong_length",
        "at least 2",
    ),
    (
        "sweep",
        "linear",
        {"rotate_deg": {"knots": [[0, 1], [0.5, 1], [0.5, 2], [1, 0]]}},
        "/rotate_deg/knots/2/0",
        "bad_knots",
        "u = 0.5 after 0.5",
    ),
    (
        "sweep",
        "linear",
        {"scale": [{"knots": [[0.1, 1], [1, 0]]}, 1]},
        "/scale/0/knots/0/0",
        "bad_knots",
        "first knot at exactly 0",
    ),
    (
        "sweep",
        "linear",
        {"shear": {"knots": [[0, 1], [0.9, 0]]}},
        "/shear/knots/1/0",
        "bad_knots",
        "last knot at exactly 1",
    ),
]


@pytest.mark.parametrize(
    ("part", "kind", "changes", "below", "word", "said"),
    REFUSED,
    ids=[f"{row[0]}-{row[1]}-{i}" for i, row in enumerate(REFUSED)],
)
def test_a_bad_part_is_refused_at_its_place(
    part: str,
    kind: str,
    changes: Tree,
    below: str,
    word: str,
    said: str,
    whole: Any,
    problems: Judge,
) -> None:
    [problem] = problems(whole(part, kind, changes))
    path = ("/solid" if part == "solid" else f"/solid/{part}") + below
    assert (problem.path, problem.kind) == (path, word)
    assert said in problem.message


@pytest.mark.parametrize(
    ("frame", "path", "kind"),
    [
        ("frent", "/solid/frame", "unknown_value"),
        (3, "/solid/frame", "wrong_shape"),
        ({"up": [0, 0, 0]}, "/solid/frame/up", "zero_vector"),
        ({}, "/solid/frame/up", "missing"),
    ],
)
def test_a_bad_frame_is_refused(
    frame: object, path: str, kind: str, written: Any, problems: Judge
) -> None:
    body = {"type": "generalized_cylinder", "material": "bone", **LEAVES["generalized_cylinder"]}
    [problem] = problems(written({**body, "frame": frame}))
    assert (problem.path, problem.kind) == (path, kind)


TURN = [[0, -2, 0, 5], [2, 0, 0, 0], [0, 0, 2, 0]]
MIRROR = [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]


@pytest.mark.parametrize(
    "change",
    [{}, {"scale": 2}, {"matrix": TURN}, {"matrix": MIRROR}, {"translate": [1, 2, 3]}],
)
def test_similarities_and_mirrors_are_transforms(
    change: Tree, sphere: Any, written: Any, problems: Judge
) -> None:
    assert problems(written({"type": "transformed", "solid": sphere(), **change})) == []


@pytest.mark.parametrize(
    ("change", "path", "kind", "said"),
    [
        ({"scale": 0}, "/solid/scale", "out_of_range", "found 0"),
        ({"scale": -1}, "/solid/scale", "out_of_range", "found -1"),
        (
            {"rotate": {"axis": [0, 0, 0], "angle_deg": 3}},
            "/solid/rotate/axis",
            "zero_vector",
            "a direction",
        ),
        ({"rotate": {"axis": UP}}, "/solid/rotate/angle_deg", "missing", "missing"),
        ({"matrix": TURN, "scale": 2}, "/solid/matrix", "conflict", "found scale too"),
        ({"matrix": TURN[:2]}, "/solid/matrix", "wrong_length", "expected 3"),
        ({"matrix": [[0] * 4] * 3}, "/solid/matrix", "out_of_range", "found a scale of 0"),
        (
            {"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1.001, 0]]},
            "/solid/matrix",
            "not_a_similarity",
            "expected a similarity",
        ),
        (
            {"matrix": [[1, 1e-8, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]},
            "/solid/matrix",
            "not_a_similarity",
            "expected a similarity",
        ),
    ],
)
def test_a_bad_transform_is_refused(
    change: Tree, path: str, kind: str, said: str, sphere: Any, written: Any, problems: Judge
) -> None:
    [problem] = problems(written({"type": "transformed", "solid": sphere(), **change}))
    assert (problem.path, problem.kind) == (path, kind)
    assert said in problem.message


def test_an_operator_needs_two_solids(sphere: Any, written: Any, problems: Judge) -> None:
    [problem] = problems(written({"type": "overlap", "solids": [sphere()]}))
    assert (problem.path, problem.kind) == ("/solid/solids", "wrong_length")


def test_a_bad_element_does_not_make_its_array_short(
    sphere: Any, written: Any, problems: Judge
) -> None:
    solids = [sphere(), sphere(radius=0)]
    [problem] = problems(written({"type": "overlap", "solids": solids}))
    assert problem.path == "/solid/solids/1/radius"
