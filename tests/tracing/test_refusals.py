"""What is not a solid is refused, with the place, u or v, and the figure."""

import numpy as np
import pytest

import phantom

LINE = {"type": "line", "start": [0, 0, 0], "end": [0, 0, 100]}
RING = {"type": "arc", "center": [0, 0, 0], "normal": [0, 0, 1], "start": [60, 0, 0]}
CIRCLE = {"type": "circle", "radius": 10}
TURN = [0, 2 * np.pi]


def formula_axis(x, y, z, span, **more):
    return {"type": "formula", "x": x, "y": y, "z": z, "range": span, **more}


def linear(**parts):
    return {"type": "linear", **parts}


def formula_contour(x, y, span=TURN):
    return {"type": "formula", "x": x, "y": y, "range": span}


def inverse(x, y):
    return {"type": "formula", "forward": ["x*(1+u)", "y"], "inverse": [x, y]}


REFUSED = {
    "a sweep that is singular at an end": (
        {"axis": LINE, "contour": CIRCLE, "sweep": linear(scale={"knots": [[0, 1], [1, 0]]})},
        "/solid/sweep",
        r"u = 1\b.*1e-?0?3|u = 1\b",
    ),
    "a formula that is singular inside": (
        {"axis": LINE, "contour": CIRCLE, "sweep": linear(scale={"formula": "(u-0.25)**2"})},
        "/solid/sweep",
        r"u = 0\.2[45]",
    ),
    "a matrix that is singular inside": (
        {
            "axis": LINE,
            "contour": CIRCLE,
            "sweep": linear(matrix=[[1, {"formula": "2*u"}, 0], [1, 1, 0], [0, 0, 1]]),
        },
        "/solid/sweep",
        r"u = 0\.(5|49|50)",
    ),
    "a pair that does not invert": (
        {"axis": LINE, "contour": CIRCLE, "sweep": inverse("x/(1+0.9*u)", "y")},
        "/solid/sweep/inverse",
        r"u = .* mm",
    ),
    "a contour that crosses itself": (
        {"axis": LINE, "contour": formula_contour("10*sin(2*v)", "15*sin(v)")},
        "/solid/contour",
        r"cross",
    ),
    "a polygon that crosses itself": (
        {
            "axis": LINE,
            "contour": {
                "type": "polygon",
                "points": [[0, 0], [10, 10], [10, 0], [0, 10]],
                "corner_radius": 0,
            },
        },
        "/solid/contour",
        r"cross",
    ),
    "an open contour": (
        {"axis": LINE, "contour": formula_contour("10*cos(v)", "10*sin(v)", [0, 6.2])},
        "/solid/contour",
        r"v = |mm",
    ),
    "a polar formula that is not periodic": (
        {"axis": LINE, "contour": {"type": "polar", "formula": "10 + 0.1*theta"}},
        "/solid/contour",
        r"0\.62",
    ),
    "an axis said to be closed": (
        {
            "axis": formula_axis("60*cos(u)", "60*sin(u)", "0.1*u", TURN, closed=True),
            "contour": CIRCLE,
        },
        "/solid/axis",
        r"0\.62",
    ),
    "a formula that is undefined": (
        {"axis": formula_axis("0", "sqrt(u-0.5)", "50*u", [0, 1]), "contour": CIRCLE},
        "/solid/axis",
        r"u = 0",
    ),
    "an undefined profile": (
        {"axis": LINE, "contour": CIRCLE, "sweep": linear(scale={"formula": "1+log(u-0.2)"})},
        "/solid/sweep",
        r"u = 0",
    ),
    "a tangent jump": (
        {"axis": formula_axis("20*abs(u)", "0", "50*u", [-1, 1]), "contour": CIRCLE},
        "/solid/axis",
        r"u = -?[0-9.e-]+",
    ),
    "an axis that stops": (
        {"axis": formula_axis("0", "0", "50*u**3", [-1, 1]), "contour": CIRCLE},
        "/solid/axis",
        r"u = -?[0-9.e-]+",
    ),
    "an axis that stops and turns": (
        {"axis": formula_axis("30*u**2", "0", "50*u**3", [-1, 1]), "contour": CIRCLE},
        "/solid/axis",
        r"u = -?[0-9.e-]+",
    ),
    "a section that reaches the centre of curvature": (
        {"axis": {**RING, "angle_deg": 90}, "contour": {"type": "circle", "radius": 61}},
        "/solid",
        r"u = .*1\.017",
    ),
    "a section that is swept to the centre of curvature": (
        {"axis": {**RING, "angle_deg": 90}, "contour": CIRCLE, "sweep": linear(offset=[-52, 0])},
        "/solid",
        r"u = .*1\.033",
    ),
    "a body through a body": (
        {
            "axis": formula_axis("60*sin(u)", "60*sin(u)*cos(u)", "3*u", [-1, 4]),
            "contour": CIRCLE,
        },
        "/solid",
        r"u = .*mm inside it at u = ",
    ),
    "an end in its own side": (
        # A thin hook: it comes round and pokes into its own shank from the side.
        {
            "axis": {
                "type": "spline",
                "points": [
                    [0, 0, -60],
                    [0, 0, -20],
                    [0, 0, 20],
                    [14, 0, 45],
                    [40, 0, 45],
                    [52, 0, 20],
                    [40, 0, 0],
                    [20, 0, -2],
                    [7, 0, -2],
                ],
            },
            "contour": {"type": "circle", "radius": 8},
        },
        "/solid",
        r"u = .*mm inside it at u = ",
    ),
    "an end in an end": (
        {"axis": formula_axis("60*cos(u)", "60*sin(u)", "0.3*u", [0, 6.4]), "contour": CIRCLE},
        "/solid",
        r"u = .*mm inside it at u = ",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_with_the_place_and_the_figure(solid, name):
    leaf, path, words = REFUSED[name]
    with pytest.raises(phantom.InvalidDocumentError, match=words) as refusal:
        solid(type="generalized_cylinder", **leaf)
    assert any(problem.path.startswith(path) for problem in refusal.value.problems)


@pytest.mark.parametrize("gap_mm", [0.5, 1e-3])
def test_a_ring_that_nearly_closes_is_a_solid(solid, gap_mm):
    """Its two ends face each other over a gap, and do not meet."""
    angle = 360 - np.degrees(gap_mm / 50)
    solid(
        type="generalized_cylinder",
        axis={**RING, "angle_deg": angle},
        contour=CIRCLE,
    )


def test_a_body_that_passes_itself_is_a_solid(solid):
    """The figure of eight, steep enough that its strands pass 2 mm apart."""
    axis = formula_axis("60*sin(u)", "60*sin(u)*cos(u)", "7*u", [-1, 4])
    solid(type="generalized_cylinder", axis=axis, contour=CIRCLE)
