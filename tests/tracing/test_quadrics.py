"""Quadrics against the quadratic formula in 80-bit arithmetic."""

import numpy as np
import pytest

import phantom
from tests.oracles import quadrics, rays
from tests.oracles.naive import quadric_membership

SURFACE_MM = 1e-11

LEAVES = {
    "sphere": {"type": "sphere", "center": [3, -4, 5], "radius": 31.7},
    "half a sphere": {
        "type": "sphere",
        "center": [3, -4, 5],
        "radius": 31.7,
        "cuts": [{"point": [3, -4, 9], "normal": [1, 2, 3]}],
    },
    "ellipsoid": {"type": "ellipsoid", "center": [-7, 2, 1], "semi_axes": [40, 12, 23.5]},
    "flat ellipsoid": {"type": "ellipsoid", "center": [-7, 2, 1], "semi_axes": [40, 0.3, 23.5]},
    "slice of an ellipsoid": {
        "type": "ellipsoid",
        "center": [-7, 2, 1],
        "semi_axes": [40, 12, 23.5],
        "cuts": [
            {"point": [3, 0, 0], "normal": [1, 0.1, 0]},
            {"point": [-20, 0, 0], "normal": [-1, 0, 0.2]},
        ],
    },
    "cylinder": {"type": "cylinder", "start": [-20, -10, -30], "end": [15, 12, 25], "radius": 13},
    "wire": {"type": "cylinder", "start": [-20, -10, -30], "end": [15, 12, 25], "radius": 0.6},
    "elliptic cylinder": {
        "type": "cylinder",
        "start": [-20, -10, -30],
        "end": [15, 12, 25],
        "semi_axes": [21, 9],
        "up": [0.3, 1, 0.2],
    },
    "cone": {
        "type": "cone",
        "start": [10, -10, -25],
        "end": [-12, 12, 25],
        "start_radius": 22,
        "end_radius": 5,
    },
    "cone with a tip": {
        "type": "cone",
        "start": [10, -10, -25],
        "end": [-12, 12, 25],
        "start_radius": 0,
        "end_radius": 20,
    },
    "double cone": {
        "type": "double_cone",
        "apex": [1, 2, 3],
        "axis": [0.2, 0.3, 1],
        "slope": 0.7,
        "cuts": [
            {"point": [5, 7, 28], "normal": [0.2, 0.3, 1]},
            {"point": [-3, -4, -20], "normal": [0, -0.3, -1]},
        ],
    },
    "box": {"type": "box", "center": [1, -2, 3], "size": [41, 17, 33.3]},
    "box without a corner": {
        "type": "box",
        "center": [1, -2, 3],
        "size": [41, 17, 33.3],
        "cuts": [{"point": [15, 2, 15], "normal": [1, 1, 1]}],
    },
    "oblique ellipsoid": {
        "type": "quadric",
        # Positive definite: x.A.x - 2 x.A.c <= 900 - c.A.c with c about (4, -3, 6).
        "coefficients": [1.0, 2.5, 1.5, 0.8, -0.6, 0.5, -12.0, 15.4, -23.8, -600.0],
    },
    "hyperboloid of one sheet": {
        "type": "quadric",
        "coefficients": [1, 1.5, -0.6, 0.1, 0, 0, -2, 1, 3, -100],
        "cuts": [
            {"point": [0, 0, 28], "normal": [0.1, 0, 1]},
            {"point": [0, 0, -21], "normal": [0, 0.2, -1]},
        ],
    },
    "hyperboloid of two sheets": {
        "type": "quadric",
        "coefficients": [1, 1.5, -0.9, 0.1, 0, 0, 0, 0, 0, 60],
        "cuts": [
            {"point": [0, 0, 28], "normal": [0.1, 0, 1]},
            {"point": [0, 0, -21], "normal": [0, 0.2, -1]},
        ],
    },
    "paraboloid": {
        "type": "quadric",
        "coefficients": [1, 0.7, 0, 0.2, 0, 0, 0, 0, -12, -30],
        "cuts": [{"point": [0, 0, 30], "normal": [0.1, 0.1, 1]}],
    },
    "parabolic cylinder": {
        "type": "quadric",
        "coefficients": [1, 0, 0, 0, 0, 0, 0, 0, -20, -30],
        "cuts": [
            {"point": [0, 0, 30], "normal": [0.1, 0.1, 1]},
            {"point": [0, 22, 0], "normal": [0, 1, 0]},
            {"point": [0, -25, 0], "normal": [0, -1, 0.1]},
        ],
    },
}


@pytest.fixture(params=LEAVES, ids=lambda name: name.replace(" ", "-"))
def leaf(request):
    return LEAVES[request.param]


def check(shape, truth, origins, directions, reach=60.0):
    """Every end lies on the surface, and every chord has its length."""
    pieces = phantom.intervals(shape, origins, directions)
    unit = rays.unit(directions.astype(np.longdouble))
    exact = [truth.chords(o, d) for o, d in zip(origins, directions, strict=True)]
    for distance in (pieces.entry_mm, pieces.exit_mm):
        seen = distance > 0
        ray = pieces.ray[seen]
        points = origins[ray].astype(np.longdouble) + distance[seen, None] * unit[ray]
        assert truth.surface_gap(points).max(initial=0) <= SURFACE_MM
    lengths = phantom.path_lengths(shape, origins, directions)[:, 0]
    wanted = np.array([(rows[:, 1] - rows[:, 0]).sum() for rows in exact])
    # Tangent, the chord of a sphere of the reach: err c / 4R is how far the surface is off.
    chord = np.maximum(np.minimum(lengths, wanted), np.sqrt(8 * reach * SURFACE_MM))
    implied = np.abs(lengths - wanted) * np.minimum(chord / (4 * reach), 1)
    assert implied.max() <= SURFACE_MM
    return wanted


def test_random_lines(solid, leaf):
    origins, directions = rays.through_ball(np.random.default_rng(11), 3000, 45.0)
    wanted = check(solid(**leaf), quadrics.of(leaf), origins, directions)
    assert np.count_nonzero(wanted) > 10


def test_sources_inside_see_only_what_is_in_front(solid, leaf):
    rng = np.random.default_rng(12)
    origins = rng.uniform(-30, 30, (2000, 3))
    directions = rays.unit(rng.standard_normal((2000, 3)))
    check(solid(**leaf), quadrics.of(leaf), origins, directions)


def test_sources_ten_metres_away(solid, leaf):
    rng = np.random.default_rng(13)
    aims = rng.uniform(-35, 35, (2000, 3))
    origins = 1e4 * rays.unit(rng.standard_normal((2000, 3)))
    check(solid(**leaf), quadrics.of(leaf), origins, aims - origins)


def test_rays_along_the_axes_of_the_world(solid, leaf):
    rng = np.random.default_rng(14)
    for axis in np.eye(3):
        for sign in (-1.0, 1.0):
            origins = rng.uniform(-35, 35, (300, 3)) * (1 - axis) - sign * 200 * axis
            directions = np.tile(sign * axis, (300, 1))
            check(solid(**leaf), quadrics.of(leaf), origins, directions)


@pytest.mark.parametrize("depth_mm", [1e-2, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10])
def test_tangent_rays_of_a_sphere(solid, depth_mm):
    leaf = LEAVES["sphere"]
    rng = np.random.default_rng(15)
    normal = rays.unit(rng.standard_normal((1000, 3)))
    along = rays.unit(np.cross(normal, rng.standard_normal((1000, 3))))
    center, radius = np.array(leaf["center"]), leaf["radius"]
    shape, truth = solid(**leaf), quadrics.of(leaf)
    inside = check(shape, truth, center + (radius - depth_mm) * normal - 300 * along, along)
    outside = check(shape, truth, center + (radius + depth_mm) * normal - 300 * along, along)
    assert np.all(inside > 0)
    assert np.all(outside == 0)


def test_rays_in_the_faces_of_a_box_do_not_leak(solid):
    """A ray in a face sees the box or does not; it never sees a part."""
    shape = solid(type="box", center=[0, 0, 0], size=[20, 20, 20])
    steps = np.linspace(-9, 9, 40)
    origins = np.stack([np.full(40, 10.0), steps, np.full(40, -50.0)], axis=1)
    lengths = phantom.path_lengths(shape, origins, np.tile([0.0, 0, 1], (40, 1)))[:, 0]
    assert set(np.unique(lengths)) <= {0.0, 20.0}


@pytest.mark.parametrize(
    "matrix",
    [
        [[0, -2, 0, 5], [2, 0, 0, -3], [0, 0, 2, 1]],
        [[-1, 0, 0, 5], [0, 1, 0, -3], [0, 0, 1, 1]],
    ],
)
def test_cuts_move_with_their_leaf(solid, leaf, matrix):
    """A moved leaf seen by moved rays is the leaf."""
    origins, directions = rays.through_ball(np.random.default_rng(16), 500, 45.0)
    matrix = np.array(matrix, dtype=float)
    a, t = matrix[:, :3], matrix[:, 3]
    moved = solid(
        type="transformed", solid={"material": "m", **leaf}, matrix=[list(r) for r in matrix]
    )
    scale = np.cbrt(abs(np.linalg.det(a)))
    lengths = phantom.path_lengths(moved, origins @ a.T + t, directions @ a.T)[:, 0]
    truth = quadrics.of(leaf)
    for i in range(len(origins)):
        wanted = np.diff(truth.chords(origins[i], directions[i]), axis=1).sum() * scale
        assert abs(lengths[i] - wanted) * min(1, max(wanted, 1e-4) / 240) <= 2 * SURFACE_MM


def test_bounds_hold_every_tip(solid):
    """The tip of a cone is where its form and its slope are both 0, to rounding."""
    rng = np.random.default_rng(18)
    for _ in range(100):
        start, end = rng.uniform(-40, 40, (2, 3))
        radius = rng.uniform(1, 30)
        ends = {"start": start.tolist(), "end": end.tolist()}
        cone = solid(type="cone", **ends, start_radius=0, end_radius=radius)
        other = {"start": end.tolist(), "end": start.tolist()}
        back = solid(type="cone", **other, start_radius=radius, end_radius=0)
        # A disc of normal k reaches r sqrt(1 - k_i^2) along axis i.
        k = (end - start) / np.linalg.norm(end - start)
        reach = radius * np.sqrt(1 - k**2)
        low, high = np.minimum(start, end - reach), np.maximum(start, end + reach)
        for shape in (cone, back):
            np.testing.assert_allclose(shape.bounds, [low, high], atol=2e-6)


def random_quadric(rng):
    """Small whole numbers, so that cones, cylinders and pairs of planes come up; and some cuts."""
    coefficients = rng.integers(-2, 3, 10) * rng.integers(0, 2, 10)
    coefficients[9] *= 50
    coefficients[6:9] *= rng.integers(1, 8)
    if not coefficients[:9].any():
        coefficients[0] = 1
    shift = rng.choice([0.0, 310.0]) * rng.uniform(-1, 1, 3)
    moved = np.array(coefficients, dtype=float)
    a, b, c, d, e, f = moved[:6]
    matrix = np.array([[a, d / 2, f / 2], [d / 2, b, e / 2], [f / 2, e / 2, c]])
    moved[9] += shift @ matrix @ shift - moved[6:9] @ shift
    moved[6:9] -= 2 * matrix @ shift
    cuts = []
    while len(cuts) < rng.integers(0, 9):
        normal = rng.integers(-2, 3, 3).astype(float)
        if normal.any():
            point = shift + normal * rng.uniform(2, 12)
            cuts.append({"point": point.tolist(), "normal": normal.tolist()})
    return {"type": "quadric", "coefficients": moved.tolist(), "cuts": cuts}, shift


def test_bounds_hold_every_quadric_and_endless_ones_are_refused(solid):
    rng = np.random.default_rng(17)
    near = rng.uniform(-40, 40, (3000, 3))
    far = 4e3 * rays.unit(rng.standard_normal((20_000, 3)))
    accepted = 0
    for _ in range(400):
        leaf, shift = random_quadric(rng)
        inside = quadric_membership(leaf)

        def left(points, inside=inside, leaf=leaf, shift=shift):
            kept = inside(points + shift)
            for cut in leaf["cuts"]:
                kept &= (points + shift - cut["point"]) @ np.array(cut["normal"]) <= 0
            return points[kept] + shift

        try:
            shape = solid(**leaf)
        except phantom.InvalidDocumentError as refused:
            (problem,) = refused.problems
            if problem.kind == "empty":
                assert len(left(near)) == 0, leaf
            continue
        accepted += 1
        low, high = shape.bounds
        found = left(near)
        assert np.all((found >= low - 1e-6) & (found <= high + 1e-6)), leaf
        if np.abs(shape.bounds - shift).max() < 3e3:
            assert len(left(far)) == 0, leaf
        origins, directions = rays.through_ball(rng, 60, 30.0, shift)
        lengths = phantom.path_lengths(shape, origins, directions)[:, 0]
        truth = quadrics.of(leaf)
        wanted = [
            np.diff(truth.chords(o, d), axis=1).sum()
            for o, d in zip(origins, directions, strict=True)
        ]
        np.testing.assert_allclose(lengths, np.array(wanted, float), atol=1e-6, err_msg=str(leaf))
    assert accepted > 30
