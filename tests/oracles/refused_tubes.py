"""Generalized cylinders that are no solids: tree, path, kind, and what is told of the place.

By what is wrong: the axis and its frame, the section, or the body as a whole.
"""

from tests.oracles.tubes import (
    RING,
    arc,
    formula_axis,
    formula_contour,
    linear,
    spline,
    tube,
)

TURN = [0, 6.283185307179586]
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
HOOK = spline(
    [0, 0, -60],
    [0, 0, -20],
    [0, 0, 20],
    [14, 0, 45],
    [40, 0, 45],
    [52, 0, 20],
    [40, 0, 0],
    [20, 0, -2],
    [7, 0, -2],
)
MEETING = r"u = .* mm inside it at u = "

AXES = {
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
    "an axis said to be closed": (
        tube(axis=formula_axis("60*cos(u)", "60*sin(u)", "0.1*u", TURN, closed=True)),
        "/solid/axis/closed",
        "open_axis",
        r"0\.6283 mm",
    ),
    "an axis that is undefined": (
        tube(axis=formula_axis("0", "sqrt(u-0.5)", "50*u", [0, 1])),
        "/solid/axis/y",
        "undefined",
        r"u = 0",
    ),
    "an axis of formulas with a corner": (
        tube(axis=formula_axis("20*abs(u)", "0", "50*u", [-1, 1])),
        "/solid/axis",
        "tangent_jump",
        # Twice the arc tangent of 20 / 50.
        r"43\.6 degrees at once at u = 0",
    ),
    "an axis that stops": (
        tube(axis=formula_axis("0", "0", "50*u**3", [-1, 1])),
        "/solid/axis",
        "irregular_axis",
        r"u = -?[0-9.e-]+ ",
    ),
    "an axis that stops and turns": (
        tube(axis=formula_axis("30*u**2", "0", "50*u**3", [-1, 1])),
        "/solid/axis",
        "irregular_axis",
        r"u = -?[0-9.e-]+ ",
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
}

SECTIONS = {
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
    "a formula that is singular inside": (
        tube(sweep=linear(scale={"formula": "(u-0.25)**2"})),
        "/solid/sweep",
        "singular_sweep",
        r"u = 0\.25",
    ),
    "a matrix that is singular inside": (
        tube(sweep=linear(matrix=[[1, {"formula": "2*u"}, 0], [1, 1, 0], [0, 0, 1]])),
        "/solid/sweep",
        "singular_sweep",
        r"u = 0\.5",
    ),
    "a pair that does not invert": (
        tube(
            contour={"type": "circle", "radius": 10},
            sweep={
                "type": "formula",
                "forward": ["x*(1+u)", "y"],
                "inverse": ["x/(1+0.9*u)", "y"],
            },
        ),
        "/solid/sweep/inverse/0",
        "not_inverse",
        # 10 * 2 / 1.9 - 10
        r"at u = 1 .* comes back 0\.526 mm off",
    ),
    "an undefined profile": (
        tube(sweep=linear(scale={"formula": "1+log(u-0.2)"})),
        "/solid/sweep/scale/formula",
        "undefined",
        r"u = 0",
    ),
    "a contour of formulas that crosses itself": (
        tube(contour=formula_contour("10*sin(2*v)", "15*sin(v)")),
        "/solid/contour",
        "crossing_contour",
        r"crosses itself near",
    ),
    "an open contour": (
        tube(contour=formula_contour("10*cos(v)", "10*sin(v)", [0, 6.2])),
        "/solid/contour",
        "open_contour",
        # A chord of the circle: 20 sin(pi - 3.1).
        r"ends 0\.8316 mm from where it starts",
    ),
    "a polar formula that is not periodic": (
        tube(contour={"type": "polar", "formula": "10 + 0.1*theta"}),
        "/solid/contour/formula",
        "open_contour",
        r"r\(2 pi\) = 10\.6283 mm",
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
}

BODIES = {
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
    "a body through a body": (
        tube(axis=formula_axis("60*sin(u)", "60*sin(u)*cos(u)", "3*u", [-1, 4])),
        "/solid",
        "global_overlap",
        MEETING,
    ),
    "an end in its own side": (
        # A thin hook: it comes round and pokes into its own shank from the side.
        tube(axis=HOOK),
        "/solid",
        "global_overlap",
        MEETING,
    ),
    "an end in an end": (
        tube(axis=formula_axis("60*cos(u)", "60*sin(u)", "0.3*u", [0, 6.4])),
        "/solid",
        "global_overlap",
        MEETING,
    ),
}
