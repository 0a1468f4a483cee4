"""What must not change: turned rays, moved worlds, other words for one solid."""

import copy
import json

import numpy as np
import pytest

import phantom
from tests.oracles import documents, families, rays
from tests.oracles.cylinders import Axis
from tests.oracles.naive import turn

SURFACE_MM = 1e-8

KINDS = [
    ("line", "superellipse", "all", "rotation_minimizing"),
    ("spline", "polar", "two scales", "rotation_minimizing"),
    ("closed spline", "spline", "offset", "rotation_minimizing"),
    ("bspline 3", "polygon", "rotate", "up"),
    ("arc", "ellipse", "shear", "frenet"),
    ("closed arc", "polar", "rotate", "up"),
    ("helix", "circle", "scale", "frenet"),
]


def bone(kinds, seed=61):
    rng = np.random.default_rng(seed)
    leaf = {"material": "bone", **families.generalized_cylinder(rng, kinds)}
    return json.loads(json.dumps(leaf))


def lines(leaf, count=1500, seed=62):
    rng = np.random.default_rng(seed)
    _, directions = rays.through_ball(rng, count, 90.0)
    near = Axis(leaf["axis"])(rng.random(count)) + rng.normal(0, 7, (count, 3))
    return near - 270 * directions, directions


def lengths(solid, origins, directions, definitions=None):
    document = documents.document(solid, definitions)
    return phantom.path_lengths(phantom.load(document), origins, directions)[:, 0]


def assert_same(found, wanted, surface_mm=2 * SURFACE_MM, reach=250.0):
    """Two ways to trace one solid may each be off by the surface tolerance."""
    chord = np.maximum(np.minimum(found, wanted), np.sqrt(8 * reach * surface_mm))
    implied = np.abs(found - wanted) * np.minimum(chord / (4 * reach), 1)
    assert implied.max() <= surface_mm
    assert np.count_nonzero(wanted) > len(wanted) / 4


@pytest.fixture(params=KINDS, ids="-".join)
def leaf(request):
    return bone(request.param)


def test_a_ray_sees_the_same_from_either_end(leaf):
    origins, directions = lines(leaf)
    ahead = lengths(leaf, origins, directions)
    back = lengths(leaf, origins + 600 * directions, -directions)
    assert_same(ahead, back)


def test_a_source_may_move_along_its_ray(leaf):
    origins, directions = lines(leaf)
    near = lengths(leaf, origins, directions)
    for shift in (-3000.0, -17.3, 40.0):
        assert_same(lengths(leaf, origins + shift * directions, directions), near)


def test_a_ray_is_the_sum_of_its_two_halves(leaf):
    origins, directions = lines(leaf)
    whole = lengths(leaf, origins, directions)
    middle = origins + 270 * directions
    halves = [lengths(leaf, middle, s * directions) for s in (1, -1)]
    assert_same(halves[0] + halves[1], whole)


def test_the_length_of_a_direction_means_nothing(leaf):
    origins, directions = lines(leaf)
    wanted = lengths(leaf, origins, directions)
    for scale in (1e-9, 3.7, 1e12):
        assert_same(lengths(leaf, origins, scale * directions), wanted)


def test_everything_may_be_moved(leaf):
    origins, directions = lines(leaf)
    wanted = lengths(leaf, origins, directions)
    r = turn([1, -2, 0.5], 77)
    about, shift = np.array([5.0, -6, 7]), np.array([30.0, 40, -20])
    moved = {
        "type": "transformed",
        "solid": leaf,
        "scale": 1.3,
        "rotate": {"axis": [1, -2, 0.5], "angle_deg": 77, "about": about.tolist()},
        "translate": shift.tolist(),
    }
    there = (1.3 * origins - about) @ r.T + about + shift
    assert_same(lengths(moved, there, directions @ r.T) / 1.3, wanted)
    # The same by a matrix, and undone by one.
    offset = about - r @ about + shift
    matrix = [[*row, float(t)] for row, t in zip((1.3 * r).tolist(), offset, strict=True)]
    moved = {"type": "transformed", "solid": leaf, "matrix": matrix}
    assert_same(lengths(moved, there, directions @ r.T) / 1.3, wanted)
    undone = {
        "type": "transformed",
        "solid": moved,
        "matrix": [
            [*row, float(t)]
            for row, t in zip((r.T / 1.3).tolist(), -r.T @ offset / 1.3, strict=True)
        ],
    }
    assert_same(lengths(undone, origins, directions), wanted)


def test_everything_may_be_mirrored(leaf):
    origins, directions = lines(leaf)
    wanted = lengths(leaf, origins, directions)
    k = rays.unit(np.array([0.3, -0.5, 1.0]))
    mirror = np.eye(3) - 2 * np.outer(k, k)
    matrix = [[*row, t] for row, t in zip(mirror.tolist(), (4.0, 5.0, -6.0), strict=True)]
    moved = {"type": "transformed", "solid": leaf, "matrix": matrix}
    found = lengths(moved, origins @ mirror.T + [4.0, 5.0, -6.0], directions @ mirror.T)
    assert_same(found, wanted)


@pytest.mark.parametrize("scale", [1e-2, 30.0])
def test_sizes_may_change(leaf, scale):
    """Small things are as exact as large ones; large ones as exact in mm."""
    origins, directions = lines(leaf, 500)
    wanted = lengths(leaf, origins, directions)
    moved = {"type": "transformed", "solid": leaf, "scale": scale}
    found = lengths(moved, scale * origins, directions)
    if scale < 1:
        assert_same(found / scale, wanted, surface_mm=SURFACE_MM * (1 + 1 / scale))
    else:
        assert_same(found, scale * wanted, SURFACE_MM * (1 + scale), reach=250.0 * scale)


def test_an_instance_is_what_it_stands_for(leaf):
    origins, directions = lines(leaf)
    wanted = lengths(leaf, origins, directions)
    found = lengths({"type": "instance", "of": "bone"}, origins, directions, {"bone": leaf})
    np.testing.assert_array_equal(found, wanted)
    nested = {"one": leaf, "two": {"type": "instance", "of": "one"}}
    found = lengths({"type": "instance", "of": "two"}, origins, directions, nested)
    np.testing.assert_array_equal(found, wanted)


def test_a_moved_instance_leaves_the_others_alone(leaf):
    origins, directions = lines(leaf)
    twin = {
        "type": "overlap",
        "solids": [
            {"type": "instance", "of": "bone"},
            {
                "type": "transformed",
                "solid": {"type": "instance", "of": "bone"},
                "translate": [400, 0, 0],
            },
        ],
    }
    wanted = lengths(leaf, origins, directions)
    wanted = wanted + lengths(leaf, origins - np.array([400.0, 0, 0]), directions)
    assert_same(lengths(twin, origins, directions, {"bone": leaf}), wanted)


def reparametrised(**axis):
    """A twisted, tapering, sheared solid on an axis; only its axis is said in other words."""
    return {
        "type": "generalized_cylinder",
        "material": "bone",
        "axis": axis,
        "contour": {"type": "polar", "radii": [12, 10, 9, 11, 8]},
        "sweep": {
            "type": "linear",
            "scale": [{"knots": [[0, 1], [1, 0.6]]}, 1.1],
            "rotate_deg": {"knots": [[0, 0], [1, 80]]},
            "shear": 0.2,
            "offset": [{"knots": [[0, 0], [1, 5]]}, -2],
        },
    }


START, END = np.array([-5.0, 8.0, -50.0]), np.array([10.0, -3.0, 60.0])


@pytest.mark.parametrize(
    "other",
    [
        {"type": "spline", "points": [START.tolist(), END.tolist()]},
        {
            "type": "spline",
            "points": [(START + s * (END - START)).tolist() for s in (0, 0.2, 0.3, 0.75, 1)],
        },
        {"type": "bspline", "degree": 1, "control_points": [START.tolist(), END.tolist()]},
        {
            "type": "bspline",
            "degree": 3,
            "control_points": [(START + s * (END - START)).tolist() for s in (0, 1 / 3, 2 / 3, 1)],
        },
    ],
    ids=["two points", "five points", "degree 1", "degree 3"],
)
def test_a_line_by_any_other_name(other):
    line = reparametrised(type="line", start=START.tolist(), end=END.tolist())
    origins, directions = lines(line)
    wanted = lengths(line, origins, directions)
    assert_same(lengths(reparametrised(**other), origins, directions), wanted)


def test_a_bspline_of_one_piece_is_a_spline_of_three_points():
    """Three points give one parabola through them; so do three control points."""
    a, b, c = np.array([[0.0, 0, -60], [14, 3, 0], [0, 6, 60]])
    middle = 0.25 * a + 0.5 * b + 0.25 * c
    points = [a.tolist(), middle.tolist(), c.tolist()]
    bezier = reparametrised(
        type="bspline", degree=2, control_points=[a.tolist(), b.tolist(), c.tolist()]
    )
    spline = reparametrised(type="spline", points=points)
    origins, directions = lines(bezier)
    wanted = lengths(bezier, origins, directions)
    assert_same(lengths(spline, origins, directions), wanted)


def test_a_reversed_axis():
    """Backwards, with every profile turned round: t and b change sign, and with b the contour."""
    forth = {
        "type": "generalized_cylinder",
        "material": "bone",
        "axis": {"type": "spline", "points": [[0, 0, -60], [9, 4, -20], [6, -5, 25], [-4, 0, 60]]},
        "contour": {"type": "polar", "radii": [12, 10, 9, 11, 8]},
        "sweep": {
            "type": "linear",
            "scale": {"knots": [[0, 1.2], [0.3, 0.7], [1, 1]]},
            "rotate_deg": {"knots": [[0, 0], [1, 80]]},
            "offset": [{"knots": [[0, 0], [1, 5]]}, {"knots": [[0, 3], [1, -2]]}],
        },
        "frame": {"up": [1, 0.2, 0]},
    }
    back = copy.deepcopy(forth)
    back["axis"]["points"].reverse()
    radii = forth["contour"]["radii"]
    back["contour"]["radii"] = [radii[-k % len(radii)] for k in range(len(radii))]
    back["sweep"]["scale"] = {"knots": [[0, 1], [0.7, 0.7], [1, 1.2]]}
    back["sweep"]["rotate_deg"] = {"knots": [[0, -80], [1, 0]]}
    back["sweep"]["offset"] = [{"knots": [[0, 5], [1, 0]]}, {"knots": [[0, 2], [1, -3]]}]
    origins, directions = lines(forth)
    assert_same(lengths(back, origins, directions), lengths(forth, origins, directions))


def test_an_arc_in_two_parts():
    """Two halves that share an end plane are the whole, with nothing lost or twice between."""

    def part(start_deg, angle_deg, low, high):
        a = np.radians(start_deg)
        return {
            "type": "generalized_cylinder",
            "material": "bone",
            "axis": {
                "type": "arc",
                "center": [0, 0, 0],
                "normal": [0, 0, 1],
                "start": [55 * np.cos(a), 55 * np.sin(a), 0],
                "angle_deg": angle_deg,
            },
            "contour": {"type": "ellipse", "semi_axes": [14, 9]},
            "sweep": {"type": "linear", "scale": {"knots": [[0, low], [1, high]]}},
            "frame": "frenet",
        }

    whole = part(10, 170, 0.7, 1.4)
    halves = {"type": "overlap", "solids": [part(10, 85, 0.7, 1.05), part(95, 85, 1.05, 1.4)]}
    origins, directions = lines(whole, 4000)
    assert_same(lengths(halves, origins, directions), lengths(whole, origins, directions))


def test_the_seam_of_a_closed_axis_may_be_anywhere():
    points = np.array(
        [[70, 0, 5], [30, 55, -4], [-40, 60, 0], [-70, -5, 8], [-25, -60, 0], [45, -50, 2]]
    )
    shapes = [
        {
            "type": "generalized_cylinder",
            "material": "bone",
            "axis": {
                "type": "spline",
                "points": np.roll(points, -k, axis=0).tolist(),
                "closed": True,
            },
            "contour": {"type": "superellipse", "semi_axes": [12, 7], "exponent": 3},
            "frame": {"up": [0, 0, 1]},
        }
        for k in (0, 1, 4)
    ]
    origins, directions = lines(shapes[0], 3000)
    wanted = lengths(shapes[0], origins, directions)
    for other in shapes[1:]:
        assert_same(lengths(other, origins, directions), wanted)


def test_many_rays_at_once_are_as_each_alone(leaf):
    origins, directions = lines(leaf, 5000)
    document = documents.document(leaf)
    shape = phantom.load(document)
    together = phantom.path_lengths(shape, origins, directions)
    pick = np.arange(0, 5000, 97)
    alone = [
        phantom.path_lengths(shape, origins[i : i + 1], directions[i : i + 1])[0] for i in pick
    ]
    np.testing.assert_array_equal(together[pick], alone)
    pieces = phantom.intervals(shape, origins, directions)
    total = np.bincount(pieces.ray, pieces.exit_mm - pieces.entry_mm, minlength=len(origins))
    np.testing.assert_allclose(total, together[:, 0], atol=1e-9)
    assert np.all(np.diff(pieces.ray) >= 0)
    same = np.diff(pieces.ray) == 0
    assert np.all(pieces.exit_mm >= pieces.entry_mm)
    assert np.all(pieces.entry_mm[1:][same] >= pieces.entry_mm[:-1][same])
