"""Solids near the edge of what is refused."""

import numpy as np
import pytest

import phantom
from tests.oracles.tubes import RING, arc, document, formula_axis, spline, tube

LEAN = {
    "type": "bspline",
    "degree": 3,
    "control_points": [[0, 0, 0], [0, 0, 30], [20, 0, 60], [60, 0, 60]],
}
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


@pytest.mark.parametrize("gap_mm", [0.5, 1e-3])
def test_a_ring_that_nearly_closes(gap_mm):
    """Its two ends face each other over a gap, and do not meet."""
    angle = 360 - np.degrees(gap_mm / 50)
    phantom.load(document(arc(60, angle, contour={"type": "circle", "radius": 10})))


def test_a_body_that_passes_itself():
    """A figure of eight, steep enough that its strands pass 2 mm apart."""
    axis = formula_axis("60*sin(u)", "60*sin(u)*cos(u)", "7*u", [-1, 4])
    phantom.load(document(tube(axis=axis, contour={"type": "circle", "radius": 10})))
