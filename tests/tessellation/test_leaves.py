"""Every leaf's mesh is closed, lies within the tolerance of its surface, and has its volume."""

import itertools
import math

import numpy as np
import pytest

import phantom
from phantom.tessellation import tessellate
from tests.oracles import families, families_new, meshes


def one(shape, tolerance_mm):
    (mesh,) = tessellate(shape, tolerance_mm)
    assert meshes.open_edges(mesh.triangles) == []
    return mesh


def area_mm2(mesh):
    corners = mesh.vertices[mesh.triangles]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.linalg.norm(cross, axis=1).sum() / 2


def assert_lies_on(shape, mesh, tolerance_mm, rng, count=150):
    points, normals = meshes.samples(mesh, rng, count)
    off = meshes.off_surface_mm(shape, points, normals, tolerance_mm, rng)
    assert off.max() <= tolerance_mm


def assert_fills(shape, mesh, tolerance_mm):
    """A shell as thick as the tolerance is all by which the volumes may differ."""
    exact = meshes.volume_mm3(shape, 120).sum()
    assert abs(mesh.volume_mm3 - exact) <= tolerance_mm * area_mm2(mesh) + 3e-3 * exact


def families_of_tubes():
    """Every axis, contour, sweep and frame at least once, at fixed random draws."""
    rng = np.random.default_rng(6)
    wanted = {
        *itertools.chain(
            families_new.AXES, families_new.CONTOURS, families_new.SWEEPS, families_new.FRAMES
        )
    }
    drawn = []
    while wanted:
        new = tuple(
            str(rng.choice(kinds))
            for kinds in (
                families_new.AXES,
                families_new.CONTOURS,
                families_new.SWEEPS,
                families_new.FRAMES,
            )
        )
        if new[2].endswith("morph"):
            new = (new[0], "circle", *new[2:])
        if wanted & set(new) and families_new.allowed(new):
            wanted -= set(new)
            drawn.append(new)
    return drawn


@pytest.mark.parametrize("kinds", families_of_tubes(), ids=" / ".join)
def test_a_generalized_cylinder_of_any_kind_is_met_within_the_tolerance(kinds, solid):
    rng = np.random.default_rng(len(" ".join(kinds)))
    while True:
        try:
            shape = solid(**families_new.generalized_cylinder(rng, kinds))
            break
        except phantom.InvalidDocumentError:
            continue
    tolerance = float(rng.choice([0.5, 0.05]))
    mesh = one(shape, tolerance)
    assert_lies_on(shape, mesh, tolerance, rng)
    assert_fills(shape, mesh, tolerance)


SPHERE = {"type": "sphere", "center": [3, -4, 5], "radius": 20}
BOX = {"type": "box", "center": [1, 2, 3], "size": [4, 5, 6]}
ELLIPSOID = {"type": "ellipsoid", "center": [0, 0, 9], "semi_axes": [30, 3, 8]}
CYLINDER = {"type": "cylinder", "start": [0, 0, 0], "end": [3, 4, 12], "radius": 5}
CONE = {
    "type": "cone",
    "start": [0, 0, 0],
    "end": [0, 9, 0],
    "start_radius": 6,
    "end_radius": 2,
}
TIP = {**CONE, "end_radius": 0}
DOUBLE = {
    "type": "double_cone",
    "apex": [0, 0, 0],
    "axis": [0, 0, 1],
    "slope": 0.5,
    "cuts": [
        {"point": [0, 0, 8], "normal": [0, 0, 1]},
        {"point": [0, 0, -6], "normal": [0, 0, -1]},
    ],
}
CAP = {**SPHERE, "cuts": [{"point": [3, -4, 20], "normal": [0, 0, -1]}]}
TORUS = {
    "type": "generalized_cylinder",
    "axis": {
        "type": "arc",
        "center": [0, 0, 0],
        "normal": [0, 0, 1],
        "start": [30, 0, 0],
        "angle_deg": 360,
    },
    "contour": {"type": "circle", "radius": 10},
}
CLOSED_FORMS = {
    "sphere": (SPHERE, 4 / 3 * math.pi * 20**3),
    "box": (BOX, 120.0),
    "ellipsoid": (ELLIPSOID, 4 / 3 * math.pi * 30 * 3 * 8),
    "cylinder": (CYLINDER, math.pi * 25 * 13),
    "truncated cone": (CONE, math.pi * 9 / 3 * (36 + 12 + 4)),
    "cone": (TIP, math.pi * 9 / 3 * 36),
    "double cone": (DOUBLE, math.pi / 12 * (8**3 + 6**3)),
    "cap of a sphere": (CAP, math.pi * 5**2 * (20 - 5 / 3)),
    "torus": (TORUS, 2 * math.pi**2 * 30 * 100),
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_volumes_come_near_closed_forms_as_the_tolerance_falls(name, solid):
    leaf, exact = CLOSED_FORMS[name]
    errors = [abs(one(solid(**leaf), t).volume_mm3 - exact) / exact for t in (0.4, 0.04, 0.004)]
    assert errors[2] < 3e-3
    # A chord's height is the square of its length: a tenth of the one, a tenth of the error.
    assert errors[0] < 1e-12 or errors[2] < 0.03 * errors[0]


def quadric(signs, linear, constant, rng):
    """A quadric of these signs, turned and shifted, between six slanted planes."""
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    a = turn @ np.diag(np.array(signs) * rng.uniform(8, 25, 3) ** -2.0) @ turn.T
    b = turn @ (np.array(linear) / 20)
    at = rng.uniform(-5, 5, 3)
    g = 2 * b - 2 * a @ at
    j = at @ a @ at - 2 * b @ at + constant
    planes = [
        (sign * rng.uniform(12, 30), sign * np.eye(3)[k] + 0.2 * rng.standard_normal(3))
        for sign in (-1, 1)
        for k in range(3)
    ]
    cuts = [
        {"point": (abs(d) * n / np.linalg.norm(n)).tolist(), "normal": n.tolist()}
        for d, n in planes
    ]
    pairs = [2 * a[0, 1], 2 * a[1, 2], 2 * a[2, 0]]
    numbers = [float(x) for x in (*np.diag(a), *pairs, *g, j)]
    return {"type": "quadric", "coefficients": numbers, "cuts": cuts}, (a, b, at, constant)


SIGNS = [
    (signs, linear, constant)
    for signs in itertools.combinations_with_replacement((1, 0, -1), 3)
    for linear in ((0, 0, 0), tuple(0.7 if s == 0 else 0 for s in signs))
    for constant in (-1.0, 0.0, 0.4)
    if any(signs) or any(linear)
]


@pytest.mark.parametrize("signs", sorted({s[0] for s in SIGNS}), ids=str)
def test_quadrics_of_every_signature_between_planes_are_met_within_the_tolerance(signs, solid):
    rng = np.random.default_rng(3)
    for _, linear, constant in (s for s in SIGNS if s[0] == signs):
        leaf, (a, b, at, c) = quadric(signs, linear, constant, rng)
        try:
            shape = solid(**leaf)
        except phantom.InvalidDocumentError:
            continue  # nothing is left of it
        tolerance = 0.1
        mesh = one(shape, tolerance)
        exact = meshes.volume_mm3(shape, 120).sum()
        assert abs(mesh.volume_mm3 - exact) <= tolerance * area_mm2(mesh) + 2e-3 * exact + 1e-3
        # Each point lies on a plane, or the form is 0 within the tolerance: its value over its
        # slope is the distance, but for the bend.
        points = meshes.samples(mesh, rng, 500)[0] if exact > 1 else np.zeros((0, 3))
        normals = np.array([cut["normal"] for cut in leaf["cuts"]])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        heights = points @ normals.T - np.einsum(
            "ij,ij->i", normals, [cut["point"] for cut in leaf["cuts"]]
        )
        y = points - at
        value = np.einsum("ni,ij,nj->n", y, a, y) + 2 * y @ b + c
        slope = 2 * np.linalg.norm(y @ a + b, axis=1)
        near = np.abs(value) <= 1.1 * tolerance * (slope + np.abs(a).max() * tolerance)
        assert heights.max(initial=0) <= 0.05 * tolerance
        assert np.all(near | (np.abs(heights).min(axis=1, initial=1) <= 0.05 * tolerance))
        assert np.all(value <= 1.1 * tolerance * (slope + np.abs(a).max() * tolerance))


def test_a_cut_through_a_ring_leaves_two_discs_or_a_ring_with_a_hole(solid):
    upright = {"point": [0, 0, 0], "normal": [0, 1, 0]}
    flat = {"point": [0, 0, 2], "normal": [0, 0, 1]}
    whole = 2 * math.pi**2 * 30 * 100
    half = one(solid(**TORUS, cuts=[upright]), 0.03)
    assert half.volume_mm3 == pytest.approx(whole / 2, rel=5e-3)
    pieces = one(solid(**TORUS, cuts=[upright, flat]), 0.03)
    # The part of a disc below a chord, swept half round its centre's circle (Pappus).
    angle = 2 * math.acos(0.2)
    segment = 50 * (angle - math.sin(angle))
    assert pieces.volume_mm3 == pytest.approx(math.pi * 30 * (math.pi * 100 - segment), rel=5e-3)
    ring = one(solid(**TORUS, cuts=[flat]), 0.03)
    lid = ring.sheets == ring.sheets.max()
    corners = ring.vertices[ring.triangles[lid]]
    assert np.all(corners[..., 2] == pytest.approx(2.0, abs=1e-9))
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
    width = math.sqrt(96)
    assert areas.sum() == pytest.approx(math.pi * ((30 + width) ** 2 - (30 - width) ** 2), rel=5e-3)
    assert areas.min() >= -1e-9


def test_a_narrow_gap_in_an_outline_is_kept_by_chords_longer_than_it(solid):
    # A ring with a slit of 0.2 mm, its two faces bulging toward each other, at a tolerance of 2 mm.
    t = np.linspace(0.005, 2 * math.pi - 0.005, 60)
    points = [(20 * math.cos(a), 20 * math.sin(a)) for a in t]
    points += [(10 * math.cos(a), 10 * math.sin(a)) for a in t[::-1]]
    leaf = {
        "type": "generalized_cylinder",
        "axis": {"type": "line", "start": [0, 0, 0], "end": [0, 0, 10]},
        "contour": {
            "type": "polygon",
            "points": [[float(x) for x in p] for p in points],
            "corner_radius": 0,
        },
    }
    mesh = one(solid(**leaf), 2.0)
    assert mesh.volume_mm3 == pytest.approx(math.pi * 300 * 10, rel=0.02)


def test_a_mirror_keeps_normals_outward_and_a_scale_the_tolerance(solid):
    tube = families.generalized_cylinder(
        np.random.default_rng(2), ("spline", "polar", "shear", "rotation_minimizing")
    )
    tube = {**tube, "material": "m"}
    plain = one(solid(**tube), 0.1)
    mirrored = one(
        solid(
            type="transformed",
            solid=tube,
            matrix=[[-2, 0, 0, 5], [0, 2, 0, 0], [0, 0, 2, 0]],
        ),
        0.2,
    )
    assert mirrored.volume_mm3 == pytest.approx(8 * plain.volume_mm3, rel=1e-9)
    assert mirrored.vertices[:, 0] == pytest.approx(5 - 2 * plain.vertices[:, 0])


def test_a_frame_that_jumps_bounds_two_bodies_that_touch(solid):
    leaf = {
        "type": "generalized_cylinder",
        "axis": {
            "type": "formula",
            "x": "30*u",
            "y": "4*u**3",
            "z": "0",
            "range": [-1, 1],
        },
        "contour": {"type": "ellipse", "semi_axes": [3, 1.5]},
        "sweep": {"type": "linear", "offset": [1.0, 0.0]},
        "frame": "frenet",
    }
    shape = solid(**leaf)
    assert shape.warnings
    mesh = one(shape, 0.02)
    assert_fills(shape, mesh, 0.02)
    assert set(mesh.sheets) == {0, 1, 2}


@pytest.mark.parametrize("turn_deg", [90.0, 360 / 7])
def test_a_ring_whose_section_comes_back_turned_is_sewn_up(solid, turn_deg):
    """A square turned by a quarter meets itself corner by corner, a circle by any angle."""
    square = {"type": "polygon", "points": [[4, 4], [-4, 4], [-4, -4], [4, -4]], "corner_radius": 0}
    circle = {"type": "superellipse", "semi_axes": [4, 4], "exponent": 2}
    leaf = {
        **TORUS,
        "contour": square if turn_deg == 90.0 else circle,
        "sweep": {
            "type": "linear",
            "rotate_deg": {"knots": [[0, 0], [1, turn_deg]]},
            "shear": 0.0,
        },
    }
    mesh = one(solid(**leaf), 0.01)
    section = 64.0 if turn_deg == 90.0 else math.pi * 16
    assert mesh.volume_mm3 == pytest.approx(section * 2 * math.pi * 30, rel=2e-3)


def test_instances_share_one_tessellation_and_stand_where_they_are_put():
    fan = phantom.library.build("fan")
    _, *blades = tessellate(fan, 0.1)
    assert len(blades) == 3
    assert len({len(blade.triangles) for blade in blades}) == 1
    assert len({round(blade.volume_mm3, 6) for blade in blades}) == 1
    for blade, box in zip(blades, fan.leaf_bounds[1:], strict=True):
        assert blade.vertices.min(axis=0) == pytest.approx(box[0], abs=0.3)
        assert blade.vertices.max(axis=0) == pytest.approx(box[1], abs=0.3)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, math.nan, math.inf])
def test_a_tolerance_that_is_no_length_is_refused(solid, tolerance):
    with pytest.raises(phantom.InvalidInputError) as caught:
        tessellate(solid(**SPHERE), tolerance)
    assert [p.path for p in caught.value.problems] == ["/tolerance_mm"]


def test_a_mesh_that_would_be_too_large_is_refused(solid):
    with pytest.raises(phantom.InvalidInputError, match="larger tolerance"):
        tessellate(solid(**{**SPHERE, "radius": 1000}), 1e-6)


def test_a_tessellation_can_be_stopped_between_leaves():
    told = []
    with pytest.raises(phantom.CancelledError):
        tessellate(
            phantom.library.build("fan"),
            1.0,
            cancelled=lambda: len(told) == 2,
            progress=lambda done, total: told.append((done, total)),
        )
    assert told == [(1, 4), (2, 4)]
