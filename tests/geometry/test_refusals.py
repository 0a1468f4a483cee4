"""What is not a solid is refused, with the place and the figure; nothing of it is traced."""

import json
import re

import numpy as np
import pytest

import phantom
from phantom.cli import main


def document(*solids, definitions=None):
    solid = solids[0] if len(solids) == 1 else {"type": "union", "solids": list(solids)}
    return {
        "format": "phantom/1",
        "name": "refused",
        "materials": {"m": {"attenuation_per_mm": 0.01}},
        "definitions": definitions or {},
        "solid": solid,
    }


def tube(**parts):
    leaf = {
        "type": "generalized_cylinder",
        "material": "m",
        "axis": {"type": "line", "start": [0, 0, -40], "end": [0, 0, 40]},
        "contour": {"type": "circle", "radius": 8},
    }
    return {**leaf, **parts}


def arc(radius=20.0, angle_deg=120.0, **parts):
    axis = {
        "type": "arc",
        "center": [0, 0, 0],
        "normal": [0, 0, 1],
        "start": [radius, 0, 0],
        "angle_deg": angle_deg,
    }
    return tube(axis=axis, **parts)


def spline(*points, **more):
    return {"type": "spline", "points": [list(map(float, p)) for p in points], **more}


def problems(tree):
    with pytest.raises(phantom.InvalidDocumentError) as refused:
        phantom.load(tree)
    return refused.value.problems


def only(tree):
    found = problems(tree)
    assert len(found) == 1, [str(p) for p in found]
    return found[0]


# An axis that runs into a point and back out of it stops there: a cusp.
CUSP = {"type": "bspline", "degree": 2, "control_points": [[0, 0, 0], [0, 0, 40], [0, 0, 0]]}
SEMICUBIC = [
    [float(x), float(y), 0.0]
    for x, y in (
        # Bezier points of s^3 and s^2 by polar forms: products of the three arguments.
        (60 * a * b * c, 40 * (a * b + b * c + c * a) / 3)
        for a, b, c in ((-0.37,) * 3, (-0.37, -0.37, 0.63), (-0.37, 0.63, 0.63), (0.63,) * 3)
    )
]
EDGED = {"type": "bspline", "degree": 1, "control_points": [[0, 0, 0], [0, 0, 40], [30, 0, 80]]}
LEAN = {
    "type": "bspline",
    "degree": 3,
    "control_points": [[0, 0, 0], [0, 0, 30], [20, 0, 60], [60, 0, 60]],
}
RING = spline([40, 0, 0], [0, 40, 0], [-40, 0, 0], [0, -40, 0], closed=True)

REFUSED = {
    "an axis that turns back": (tube(axis=CUSP), "/solid/axis", "irregular_axis", r"u = 0\.5"),
    "an axis that turns back between samples": (
        tube(axis={**CUSP, "control_points": [[0, 0, 0], [0, 0, 40], [0, 0, 10]]}),
        "/solid/axis",
        "irregular_axis",
        r"u = 0\.571",
    ),
    "an axis that turns back, in a plane": (
        # a(u) = (60 s^3, 40 s^2) about s = u - 0.37: a cusp, where both derivatives vanish.
        tube(axis={"type": "bspline", "degree": 3, "control_points": SEMICUBIC}),
        "/solid/axis",
        "irregular_axis",
        r"u = 0\.37",
    ),
    "an axis with a corner": (
        tube(axis=EDGED),
        "/solid/axis",
        "tangent_jump",
        r"36\.9 degrees at once at u = 0\.5",
    ),
    "a scale through zero": (
        tube(sweep={"type": "linear", "scale": {"knots": [[0, 1], [1, -1]]}}),
        "/solid/sweep",
        "singular_sweep",
        r"u = 0\.5",
    ),
    "a scale that ends in a point": (
        tube(sweep={"type": "linear", "scale": {"knots": [[0, 1], [1, 0]]}}),
        "/solid/sweep",
        "singular_sweep",
        r"u = 1",
    ),
    "a section flat to a thousandth": (
        tube(sweep={"type": "linear", "scale": [1, 0.0009]}),
        "/solid/sweep",
        "singular_sweep",
        r"0\.0009 of the largest.*at least 0\.001",
    ),
    "a profile that dips below zero between its knots": (
        tube(
            sweep={"type": "linear", "scale": {"knots": [[0, 2], [0.4, 0.05], [0.6, 0.05], [1, 2]]}}
        ),
        "/solid/sweep",
        "singular_sweep",
        r"singular near u",
    ),
    "a shear without end": (
        tube(sweep={"type": "linear", "shear": 2000}),
        "/solid/sweep",
        "singular_sweep",
        r"singular near u",
    ),
    "a tube thicker than its bend": (
        arc(20, contour={"type": "circle", "radius": 21}),
        "/solid",
        "local_overlap",
        r"curvature x extent = 1\.05\).*expected less than 1",
    ),
    "a tube as thick as its bend": (
        arc(20, contour={"type": "circle", "radius": 20}),
        "/solid",
        "local_overlap",
        r"curvature x extent = 1\)",
    ),
    "a section moved past the centre of its bend": (
        arc(20, frame={"up": [0, 0, 1]}, sweep={"type": "linear", "offset": [0, -13]}),
        "/solid",
        "local_overlap",
        r"reaches 21 mm toward the centre of curvature, which is 20 mm away",
    ),
    "a tight place in a long axis": (
        tube(
            axis={
                "type": "bspline",
                "degree": 2,
                "control_points": [[0, 0, 0], [0, 0, 100], [8, 0, 0]],
            }
        ),
        "/solid",
        "local_overlap",
        r"folds into itself at u = 0\.499",
    ),
    "up along a line": (
        tube(frame={"up": [0, 0, 2]}),
        "/solid/frame/up",
        "up_parallel",
        r"parallel to the axis at u = ",
    ),
    "up along the axis in one place": (
        arc(60, 150, frame={"up": [-1, 1, 0]}),
        "/solid/frame/up",
        "up_parallel",
        r"u = 0\.3",
    ),
    "a spline that crosses itself": (
        tube(contour={"type": "spline", "points": [[10, 10], [-10, -10], [10, -10], [-10, 10]]}),
        "/solid/contour",
        "crossing_contour",
        r"crosses itself near \(.*\) mm",
    ),
    "a polygon that crosses itself": (
        tube(
            contour={
                "type": "polygon",
                "points": [[10, 10], [-10, -10], [10, -10], [-10, 10]],
                "corner_radius": 0.5,
            }
        ),
        "/solid/contour",
        "crossing_contour",
        r"crosses itself near",
    ),
    "radii whose curve runs through the origin": (
        tube(contour={"type": "polar", "radii": [20, 0.5, 0.5, 0.5, 20, 20]}),
        "/solid/contour/radii",
        "crossing_contour",
        r"reaches r = -?[0-9.e-]+ mm at theta = .*expected r > 0",
    ),
    "corners rounder than their edges are long": (
        tube(
            contour={
                "type": "polygon",
                "points": [[10, 10], [-10, 10], [-10, -10], [10, -10]],
                "corner_radius": 10.5,
            }
        ),
        "/solid/contour/corner_radius",
        "corner_radius",
        r"need 21 mm of the edge after corner \d, which is 20 mm long",
    ),
    "a seam that stays open": (
        tube(axis=RING, sweep={"type": "linear", "scale": {"knots": [[0, 1], [1, 0.9]]}}),
        "/solid/sweep",
        "open_seam",
        r"differ by 0\.8 mm; expected at most 1e-09",
    ),
    "a twist that does not come round": (
        tube(
            axis=RING,
            contour={"type": "ellipse", "semi_axes": [8, 5]},
            sweep={"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, 90]]}},
        ),
        "/solid/sweep",
        "open_seam",
        r"differ by",
    ),
    "a cylinder without ends": (
        {"type": "quadric", "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, 0, -100], "material": "m"},
        "/solid",
        "unbounded",
        r"for ever along \[0, 0, -?1\]|for ever along \[-?0, -?0, -?1\]",
    ),
    "a cylinder with one end": (
        {
            "type": "quadric",
            "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, 0, -100],
            "cuts": [{"point": [0, 0, 5], "normal": [0, 0, 1]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"\[-?0, -?0, -1\]",
    ),
    "an oblique cylinder with one end": (
        {
            "type": "quadric",
            # |x|^2 - (k.x)^2 <= 100 with k = (1, 2, 3) / sqrt(14), and rounding in it.
            "coefficients": [
                13 / 14,
                10 / 14,
                5 / 14,
                -4 / 14,
                -12 / 14,
                -6 / 14,
                0.1,
                0.4,
                -0.3,
                -100,
            ],
            "cuts": [{"point": [0, 0, 5], "normal": [1, 2, 3]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"for ever along",
    ),
    "a paraboloid": (
        {"type": "quadric", "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, -9, 0], "material": "m"},
        "/solid",
        "unbounded",
        r"\[-?0, -?0, 1\]",
    ),
    "a half space": (
        {"type": "quadric", "coefficients": [0, 0, 0, 0, 0, 0, 1, 0, 0, 0], "material": "m"},
        "/solid",
        "unbounded",
        r"for ever",
    ),
    "a hyperboloid cut along itself": (
        {
            "type": "quadric",
            "coefficients": [1, 1, -1, 0, 0, 0, 0, 0, 0, -100],
            "cuts": [{"point": [5, 0, 0], "normal": [1, 0, 0]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"for ever",
    ),
    "a double cone cut on one side": (
        {
            "type": "double_cone",
            "apex": [0, 0, 0],
            "axis": [0, 0, 1],
            "slope": 0.5,
            "cuts": [{"point": [0, 0, 9], "normal": [0, 0, 1]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"for ever along",
    ),
    "the outside of a sphere": (
        {"type": "quadric", "coefficients": [-1, -1, -1, 0, 0, 0, 0, 0, 0, 100], "material": "m"},
        "/solid",
        "unbounded",
        r"for ever along",
    ),
    "an ellipsoid of nothing": (
        {"type": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, 100], "material": "m"},
        "/solid",
        "empty",
        r"nothing is left",
    ),
    "a sphere cut away": (
        {
            "type": "sphere",
            "center": [0, 0, 0],
            "radius": 10,
            "cuts": [{"point": [0, 0, -10.5], "normal": [0, 0, 1]}],
            "material": "m",
        },
        "/solid",
        "empty",
        r"nothing is left",
    ),
    "a sphere between cuts that leave nothing": (
        {
            "type": "sphere",
            "center": [0, 0, 0],
            "radius": 10,
            "cuts": [
                {"point": [0, 0, 1], "normal": [0, 0, -1]},
                {"point": [0, 0, -1], "normal": [0, 0.1, 1]},
                {"point": [0, 5, 0], "normal": [0, -1, 0]},
            ],
            "material": "m",
        },
        "/solid",
        "empty",
        r"nothing is left",
    ),
}


@pytest.mark.parametrize("name", REFUSED, ids=lambda name: name.replace(" ", "-"))
def test_refused_with_place_and_figure(name):
    solid, path, kind, message = REFUSED[name]
    found = only(document(solid))
    assert (found.path, found.kind) == (path, kind), str(found)
    assert re.search(message, found.message), str(found)
    assert "expected" in found.message


@pytest.mark.parametrize("name", REFUSED, ids=lambda name: name.replace(" ", "-"))
def test_refused_wherever_it_stands(name):
    """Deep in a tree and in definitions, used or not, with the path of the field itself."""
    solid, path, kind, _ = REFUSED[name]
    rest = path.removeprefix("/solid")
    box = {"type": "box", "center": [0, 0, 0], "size": [1, 1, 1], "material": "m"}
    deep = {"type": "transformed", "solid": {"type": "union", "solids": [box, solid]}, "scale": 1.5}
    tree = document(box, deep, definitions={"unused": solid})
    found = {(p.path, p.kind) for p in problems(tree)}
    wanted = {("/solid/solids/1/solid/solids/1" + rest, kind), ("/definitions/unused" + rest, kind)}
    assert found == wanted


def test_all_are_told_at_once():
    solids = [solid for solid, *_ in REFUSED.values()]
    found = [(p.path, p.kind) for p in problems(document(*solids))]
    wanted = [
        (f"/solid/solids/{i}" + path.removeprefix("/solid"), kind)
        for i, (_, path, kind, _) in enumerate(REFUSED.values())
    ]
    assert sorted(found) == sorted(wanted)


def test_an_instance_is_told_of_where_it_is_defined():
    bad, path, kind, _ = REFUSED["a tube thicker than its bend"]
    uses = [{"type": "instance", "of": "bad", "name": name} for name in ("a", "b")]
    found = only(document(*uses, definitions={"bad": bad}))
    assert (found.path, found.kind) == ("/definitions/bad" + path.removeprefix("/solid"), kind)


ACCEPTED = {
    "a tube just thinner than its bend": arc(20, contour={"type": "circle", "radius": 19.8}),
    "a section far out on the outer side": arc(
        20,
        frame={"up": [0, 0, 1]},
        contour={"type": "circle", "radius": 15},
        sweep={"type": "linear", "offset": [0, 30]},
    ),
    "an axis with an inflection": tube(
        axis=spline([0, 0, -60], [9, 0, -20], [-9, 0, 20], [0, 0, 60]),
        contour={"type": "ellipse", "semi_axes": [6, 4]},
    ),
    "a blunt tip": tube(sweep={"type": "linear", "scale": {"knots": [[0, 1], [1, 0.0011]]}}),
    "an up frame that leans far over": tube(axis=LEAN, frame={"up": [0, 1, 0]}),
    "a twist by half a turn of an ellipse on a ring": tube(
        axis=RING,
        contour={"type": "ellipse", "semi_axes": [8, 5]},
        sweep={"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, 180]]}},
    ),
    "a mirror on a ring": tube(
        axis=RING,
        contour={"type": "superellipse", "semi_axes": [8, 5], "exponent": 4},
        sweep={"type": "linear", "scale": [-1, 1]},
    ),
    "arcs that fill their edges": tube(
        contour={
            "type": "polygon",
            "points": [[10, 10], [-10, 10], [-10, -10], [10, -10]],
            "corner_radius": 9.999,
        }
    ),
    "a paraboloid with a lid": {
        "type": "quadric",
        "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, -9, 0],
        "cuts": [{"point": [0, 0, 30], "normal": [1, 0, 3]}],
        "material": "m",
    },
    "a half of a double cone": {
        "type": "double_cone",
        "apex": [0, 0, 0],
        "axis": [0, 0, 1],
        "slope": 0.5,
        "cuts": [
            {"point": [0, 0, 9], "normal": [0, 0, 1]},
            {"point": [0, 0, 0], "normal": [0, 0, -1]},
        ],
        "material": "m",
    },
    "a slab of a half space": {
        "type": "quadric",
        "coefficients": [0, 0, 0, 0, 0, 0, 1, 0, 0, 0],
        "cuts": [
            {"point": [-5, 0, 0], "normal": [-1, 0, 0]},
            {"point": [0, 5, 0], "normal": [0, 1, 0]},
            {"point": [0, -5, 0], "normal": [0, -1, 0]},
            {"point": [0, 0, 5], "normal": [0, 0, 1]},
            {"point": [0, 0, -5], "normal": [0, 0, -1]},
        ],
        "material": "m",
    },
}


@pytest.mark.parametrize("name", ACCEPTED, ids=lambda name: name.replace(" ", "-"))
def test_accepted_though_near_the_edge(name):
    shape = phantom.load(document(ACCEPTED[name]))
    middle = shape.bounds.mean(axis=0)
    rng = np.random.default_rng(71)
    aims = rng.uniform(*shape.bounds, (400, 3))
    origins = middle + 500 * np.array([0.6, 0.0, 0.8])
    lengths = phantom.path_lengths(shape, np.tile(origins, (400, 1)), aims - origins)
    assert np.isfinite(lengths).all()
    assert np.count_nonzero(lengths) > 20


def test_nothing_is_drawn_from_a_refused_document(tmp_path, capsys, monkeypatch):
    source, picture = tmp_path / "bad.json", tmp_path / "bad.png"
    source.write_text(json.dumps(document(REFUSED["a seam that stays open"][0])))
    command = ["phantom", "radiograph", str(source), "--view", "ap", "-o", str(picture)]
    monkeypatch.setattr("sys.argv", command)
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code not in (0, None)
    assert not picture.exists()
    assert "/solid/sweep" in capsys.readouterr().err
