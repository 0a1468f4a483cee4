"""What a ray sees first, against the intervals of X-rays and against points alone."""

import json
import math

import numpy as np
import pytest

import phantom
from phantom.errors import InvalidInputError
from phantom.tracing.hits import HitRaster
from phantom.visible.rendering import view_of
from tests.oracles import documents, families, families_new, naive_new, rays, surfaces

MATERIALS = {m: {"attenuation_per_mm": 0.01} for m in (*documents.MATERIALS, "m")}

EMPTY = 11
"""A seed whose tube and ball do not meet in their intersection."""


def loaded(solid):
    tree = {
        "format": "phantom/1",
        "name": "t",
        "materials": MATERIALS,
        "solid": solid,
    }
    tree = json.loads(json.dumps(tree))
    return tree, phantom.load(tree)


def random_solid(seed):
    rng = np.random.default_rng(seed)
    if seed % 3 == 0:
        return documents.tree(rng, 3)
    if seed % 3 == 1:
        kinds = ("spline", families.CONTOURS[seed % 6], families.SWEEPS[seed % 8], "up")
        tube = families.generalized_cylinder(rng, kinds)
    else:
        tube = families_new.generalized_cylinder(rng, families_new.any_kinds(rng))
    tube = {**tube, "material": "m"}
    ball = {"type": "sphere", "center": [0, 0, 0], "radius": 40.0, "material": "bone"}
    operator = documents.OPERATORS[seed % 5]
    return {"type": operator, "solids": [tube, ball]}


def through(shape, seed, count):
    """Random lines through the ball about a phantom's box."""
    low, high = shape.bounds
    rng = np.random.default_rng(seed)
    return rays.through_ball(rng, count, 0.45 * np.linalg.norm(high - low), 0.5 * (low + high))


@pytest.mark.parametrize("seed", [s for s in range(20) if s != EMPTY])
def test_first_hit_is_where_the_first_interval_begins(seed):
    _, shape = loaded(random_solid(seed))
    origins, directions = through(shape, seed, 3000)
    hits = phantom.first_hits(shape, origins, directions)
    pieces = phantom.intervals(shape, origins, directions)
    first = np.full(len(origins), np.inf)
    np.minimum.at(first, pieces.ray, pieces.entry_mm)
    np.testing.assert_array_equal(hits.distance_mm, first)
    met = np.isfinite(first)
    assert met.sum() > 100
    # The leaf that is seen is the first of those that the interval keeps.
    for ray in np.flatnonzero(met)[:200]:
        rows = (pieces.ray == ray) & (pieces.entry_mm == first[ray])
        assert hits.leaf[ray] in pieces.leaf[rows]
    assert np.all(hits.leaf[~met] == -1)
    assert np.isnan(hits.normal[~met]).all()


@pytest.mark.parametrize("seed", range(EMPTY))
def test_normals_are_the_numeric_gradients_of_a_solid_known_by_its_points(seed):
    tree, shape = loaded(random_solid(seed))
    twin = naive_new.Twin(tree)
    origins, directions = through(shape, seed, 3000)
    hits = phantom.first_hits(shape, origins, directions)
    facing = -(hits.normal * directions).sum(axis=1)
    chosen = np.flatnonzero(facing > 0.35)[:100]
    points = (origins + hits.distance_mm[:, None] * directions)[chosen]
    expected, smooth = surfaces.normals(
        lambda x: twin.survivors(x).any(axis=1), points, directions[chosen]
    )
    assert smooth.mean() > 0.6
    assert smooth.sum() > 30
    found = hits.normal[chosen]
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(found[smooth], expected[smooth], rtol=0, atol=1e-6)


CONTOURS = {
    "circle": ({"type": "circle", "radius": 9.0}, lambda v: (9 * np.cos(v), 9 * np.sin(v))),
    "ellipse": (
        {"type": "ellipse", "semi_axes": [11.0, 6.0]},
        lambda v: (11 * np.cos(v), 6 * np.sin(v)),
    ),
    "polar": (
        {"type": "polar", "formula": "9 + 2*cos(3*theta)"},
        lambda v: ((9 + 2 * np.cos(3 * v)) * np.cos(v), (9 + 2 * np.cos(3 * v)) * np.sin(v)),
    ),
    "formula": (
        {"type": "formula", "x": "8*cos(v) + cos(2*v)", "y": "9*sin(v)", "range": [0, 2 * math.pi]},
        lambda v: (8 * np.cos(v) + np.cos(2 * v), 9 * np.sin(v)),
    ),
}


@pytest.mark.parametrize("frame", ["rotation_minimizing", "frenet", {"up": [0.2, 1.0, 0.1]}])
@pytest.mark.parametrize("kind", CONTOURS)
def test_normal_and_parameters_are_those_of_the_papers_surface(kind, frame):
    contour, place = CONTOURS[kind]
    tube = {
        "type": "generalized_cylinder",
        "axis": {"type": "helix", "center": [0, 0, 0], "axis": [0, 0, 1], "start": [50, 0, -40],
                 "pitch": 90.0, "turns": 0.8},
        "contour": contour,
        "sweep": {"type": "linear", "scale": {"knots": [[0, 1.2], [0.4, 0.7], [1, 1.0]]},
                  "rotate_deg": {"knots": [[0, 0], [1, 70]]}, "shear": 0.2},
        "frame": frame,
        "material": "m",
    }  # fmt: skip
    tree, shape = loaded(tube)
    solid = naive_new.Solid(tree["solid"])
    origins, directions = rays.through_ball(np.random.default_rng(5), 4000, 80.0)
    hits = phantom.first_hits(shape, origins, directions)
    side = ~np.isnan(hits.uv[:, 1])
    assert side.sum() > 400

    def gamma(u, v):
        """a(u) + c_n n + c_b b, the paper's equation 1."""
        matrix, offset = solid.section.matrix(u)
        plane = np.einsum("nij,nj->ni", matrix, np.stack(place(v), axis=1)) + offset
        n = solid.normal(u)
        b = np.cross(solid.axis.tangent(u), n)
        return solid.axis(u) + plane[:, :1] * n + plane[:, 1:] * b

    u, v = hits.uv[side].T
    points = origins[side] + hits.distance_mm[side, None] * directions[side]
    np.testing.assert_allclose(gamma(u, v), points, rtol=0, atol=1e-7)
    h = 1e-4
    keep = (u > 2 * h) & (u < 1 - 2 * h)
    u, v = u[keep], v[keep]

    def slope(a, b):
        near = gamma(u + a, v + b) - gamma(u - a, v - b)
        far = gamma(u + 2 * a, v + 2 * b) - gamma(u - 2 * a, v - 2 * b)
        return 8 * near - far

    expected = rays.unit(np.cross(slope(0, h), slope(h, 0)))
    outward = np.sign((expected * hits.normal[side][keep]).sum(axis=1))
    # One orientation throughout: the paper's product points the same way everywhere.
    assert len(np.unique(outward)) == 1
    np.testing.assert_allclose(hits.normal[side][keep], outward[0] * expected, rtol=0, atol=1e-6)


def test_flat_ends_have_the_tangent_as_their_normal():
    arc = {"type": "arc", "center": [0, 0, 0], "normal": [0, 0, 1], "start": [30, 0, 0],
           "angle_deg": 90}  # fmt: skip
    tube = {"type": "generalized_cylinder", "axis": arc, "contour": {"type": "circle", "radius": 5},
            "material": "m"}  # fmt: skip
    _, shape = loaded(tube)
    hits = phantom.first_hits(shape, [[31, -50, 1], [-50, 29, 2]], [[0, 1, 0], [1, 0, 0]])
    np.testing.assert_allclose(hits.normal, [[0, -1, 0], [-1, 0, 0]], rtol=0, atol=1e-9)
    np.testing.assert_allclose(hits.uv[:, 0], [0, 1], rtol=0, atol=1e-12)
    assert np.isnan(hits.uv[:, 1]).all()
    np.testing.assert_allclose(hits.distance_mm, [50, 50], rtol=0, atol=1e-9)


def test_the_step_where_a_frame_jumps_is_flat():
    """At the inflection of x**3 a disc off the axis jumps from one side to the other."""
    tube = {
        "type": "generalized_cylinder",
        "axis": {"type": "formula", "x": "u", "y": "u**3 / 3000", "z": "0", "range": [-40, 40]},
        "contour": {"type": "circle", "radius": 1.0},
        "sweep": {"type": "linear", "offset": [8.0, 0]},
        "frame": "frenet",
        "material": "m",
    }
    _, shape = loaded(tube)
    hits = phantom.first_hits(shape, [[-9, 8, 0.3], [9, -8, 0.3]], [[1, 0, 0], [-1, 0, 0]])
    np.testing.assert_allclose(hits.distance_mm, [9, 9], rtol=0, atol=1e-9)
    np.testing.assert_allclose(hits.normal, [[-1, 0, 0], [1, 0, 0]], rtol=0, atol=1e-9)
    assert np.isnan(hits.uv[:, 1]).all()


def ball(radius, material="bone", x=0.0, **more):
    return {"type": "sphere", "center": [x, 0, 0], "radius": radius, "material": material, **more}


def test_a_difference_shows_the_right_solids_normal_flipped():
    """A hollow cut by a ball into a ball: its wall shows the left solid's material."""
    tree = {"type": "difference", "solids": [ball(20, name="left"), ball(10, x=20, name="right")]}
    _, shape = loaded(tree)
    hits = phantom.first_hits(shape, [[100, 1, 0]], [[-1, 0, 0]])
    wall = 20 - math.sqrt(100 - 1)
    assert hits.distance_mm[0] == pytest.approx(100 - wall, abs=1e-9)
    outward = np.array([wall - 20, 1, 0]) / 10
    np.testing.assert_allclose(hits.normal[0], -outward, rtol=0, atol=1e-12)
    assert hits.leaf_names[hits.leaf[0]] == "left"
    assert hits.leaf_names[hits.surface_leaf[0]] == "right"


def test_two_faces_that_coincide_leave_no_sliver_to_see():
    """A box less a box that shares its front face to the last bit or so: the hollow is seen."""
    outer = {"type": "box", "center": [0, 0, 0], "size": [0.3, 0.3, 0.3], "material": "bone"}
    # 0.1 + 0.05 and 0.15 differ by rounding.
    inner = {"type": "box", "center": [0.1, 0, 0], "size": [0.1, 0.1, 0.1], "material": "bone"}
    _, shape = loaded({"type": "difference", "solids": [outer, inner]})
    hits = phantom.first_hits(shape, [[5, 0.01, 0.02]], [[-1, 0, 0]])
    assert hits.distance_mm[0] == pytest.approx(4.95, abs=1e-12)
    np.testing.assert_allclose(hits.normal[0], [1, 0, 0], rtol=0, atol=1e-12)


def test_an_eye_in_a_solid_sees_its_wall_from_within():
    tree = {"type": "difference", "solids": [ball(20), ball(5)]}
    _, shape = loaded(tree)
    hits = phantom.first_hits(shape, [[10, 0, 0]] * 2, [[1, 0, 0], [-1, 0, 0]])
    assert hits.inside.all()
    np.testing.assert_allclose(hits.distance_mm, [10, 5], rtol=0, atol=1e-12)
    # Out of the solid, so along the ray in both cases.
    np.testing.assert_allclose(hits.normal, [[1, 0, 0], [-1, 0, 0]], rtol=0, atol=1e-12)
    assert list(hits.leaf) == [0, 0]


def test_what_is_hidden_is_looked_through():
    """A core kept by replace, in flesh; and the hole that a hidden core leaves."""
    body = {"type": "replace", "solids": [ball(20, "soft", name="flesh"), ball(8, name="core")]}
    _, shape = loaded(body)
    ray = [[50, 0, 0]], [[-1, 0, 0]]
    distances = {
        hide: phantom.first_hits(shape, *ray, hide=hide).distance_mm[0]
        for hide in ((), ("soft",), ("flesh",), ("core",), ("soft", "bone"))
    }
    assert distances == pytest.approx(
        {(): 30, ("soft",): 42, ("flesh",): 42, ("core",): 30, ("soft", "bone"): np.inf}
    )
    within = phantom.first_hits(shape, [[0, 0, 0]], [[1, 0, 0]], hide=["core"])
    assert within.distance_mm[0] == pytest.approx(8)
    np.testing.assert_allclose(within.normal[0], [-1, 0, 0], rtol=0, atol=1e-12)
    with pytest.raises(InvalidInputError) as refused:
        phantom.first_hits(shape, *ray, hide=["soft", "skin"])
    assert [p.path for p in refused.value.problems] == ["/hide/1"]


@pytest.mark.parametrize("seed", [0, 3, 4, 8, 10, 13, 14, 16])
def test_a_picture_s_rays_see_what_free_rays_see(seed):
    """Whole tiles at once against one ray by one; from afar, in parallel, and from within."""
    _, shape = loaded(random_solid(seed))
    low, high = shape.bounds
    middle, size = 0.5 * (low + high), float(np.linalg.norm(high - low))
    rng = np.random.default_rng(seed)
    away = rays.unit(rng.standard_normal(3))
    shown = np.ones(len(shape.leaf_names), dtype=np.uint8)
    for eye, lens in (
        (middle + 1.5 * size * away, {"field_of_view_deg": 40}),
        (middle + 1.5 * size * away, {"parallel_width_mm": 1.1 * size}),
        (middle + 0.05 * size * away, {"field_of_view_deg": 100}),
    ):
        target = middle - 0.1 * size * away
        camera = phantom.Camera(
            eye=eye, target=target, up=(0.3, 0.2, 1), columns=150, rows=40, **lens
        )
        found, hits = HitRaster(shape, view_of(shape, camera), 40, 150, shown).rows(0, 40)
        origins, directions = camera.rays(np.arange(150)[None, :], np.arange(40)[:, None])
        one_by_one = phantom.first_hits(shape, origins.reshape(-1, 3), directions.reshape(-1, 3))
        expected = one_by_one.distance_mm.reshape(40, 150)
        # An implied displacement of 1e-8 mm: more along the ray where it grazes, and a sliver of
        # a chord that one of the two does not see.
        same = np.isfinite(found) == np.isfinite(expected)
        assert same.mean() > 0.9995
        both = np.isfinite(found) & np.isfinite(expected)
        assert both.sum() > 15
        ways = directions.reshape(40, 150, 3)[both]
        sine = np.abs((one_by_one.normal.reshape(40, 150, 3)[both] * ways).sum(axis=-1))
        off = np.abs(found[both] - expected[both]) * sine
        assert np.mean(off > 2e-8) < 0.0005
        for column, name in ((0, "surface_leaf"), (1, "leaf")):
            free = getattr(one_by_one, name).reshape(40, 150)[both]
            assert np.mean(hits[both][:, column] != free) < 0.0005
