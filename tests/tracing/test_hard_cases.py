"""Solids at the edge of what is valid, with closed forms where there are any."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

import phantom
from tests.oracles import quadrics, rays, torus
from tests.oracles.projection import volume

SURFACE_MM = 1e-8
UPRIGHT = {"type": "line", "start": [0, 0, -50], "end": [0, 0, 50]}
RING = {"type": "arc", "center": [0, 0, 0], "normal": [0, 0, 1], "start": [60, 0, 0]}


def polygon(points, radius=0):
    return {"type": "polygon", "points": np.asarray(points).tolist(), "corner_radius": radius}


def rectangle(w, h):
    return polygon([[w, -h], [w, h], [-w, h], [-w, -h]])


@pytest.fixture
def tube(solid):
    return lambda **parts: solid(type="generalized_cylinder", **parts)


def lengths_of(shape, origins, directions):
    return phantom.path_lengths(shape, origins, directions)[:, 0]


def assert_implied(found, wanted, reach):
    chord = np.maximum(np.minimum(found, wanted), np.sqrt(8 * reach * SURFACE_MM))
    assert (np.abs(found - wanted) * np.minimum(chord / (4 * reach), 1)).max() <= SURFACE_MM
    assert np.count_nonzero(wanted) > len(wanted) / 20


def slabs(origins, directions, half):
    """Chords of a box about the origin."""
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = ((s * np.asarray(half) - origins) / directions for s in (-1, 1))
    entry, exit_ = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
    return np.maximum(exit_ - np.maximum(entry, 0), 0)


def test_a_sharp_box(tube):
    shape = tube(axis=UPRIGHT, contour=rectangle(20, 12))
    origins, directions = rays.through_ball(np.random.default_rng(1), 20_000, 55.0)
    assert_implied(
        lengths_of(shape, origins, directions), slabs(origins, directions, (20, 12, 50)), 55
    )


@pytest.mark.parametrize("offset", [*10.0 ** np.arange(-9, -2), *-(10.0 ** np.arange(-9, -2))])
def test_rays_past_the_edge_of_a_sharp_box(tube, offset):
    """They cut a corner of ``offset`` off, or miss it by as much."""
    shape = tube(axis=UPRIGHT, contour=rectangle(20, 12))
    rng = np.random.default_rng(2)
    count = 200
    angle, rise = rng.uniform(0.1, 1.4, count), rng.uniform(-0.5, 0.5, count)
    directions = np.stack([-np.sin(angle), np.cos(angle), rise], axis=1)
    inward = -np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    edge = np.stack([0 * angle + 20, 0 * angle + 12, rng.uniform(-40, 40, count)], axis=1)
    origins = edge + offset * inward - 30 * directions
    found = lengths_of(shape, origins, directions)
    wanted = slabs(origins, directions, (20, 12, 50)) * np.linalg.norm(directions, axis=1)
    # Each end may be off by the tolerance over its sine; what is under a micrometre may be lost.
    sines = np.abs(directions[:, :2]) / np.linalg.norm(directions, axis=1)[:, None]
    allowed = SURFACE_MM * (1 / sines).sum(axis=1)
    kept = wanted > 1e-3
    assert (np.abs(found - wanted)[kept] <= allowed[kept]).all()
    assert (found[~kept] <= wanted[~kept] + allowed[~kept]).all()


def test_rays_along_the_faces_of_a_sharp_box(tube):
    shape = tube(axis=UPRIGHT, contour=rectangle(20, 12))
    depth = 10.0 ** np.arange(-7.0, 0)
    z = np.linspace(-40, 40, len(depth))
    origins = np.stack([20 - depth, 0 * depth - 100, z], axis=1)
    directions = np.tile([0.0, 1, 0], (len(depth), 1))
    assert lengths_of(shape, origins, directions) == pytest.approx(24.0, abs=4e-8)
    assert not lengths_of(shape, origins + [[2, 0, 0]] * depth[:, None], directions).any()


@pytest.mark.parametrize("total_deg", [90.0, 300.0])
def test_a_twisted_sharp_prism_keeps_its_volume(tube, total_deg):
    twist = {"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, total_deg]]}}
    shape = tube(axis=UPRIGHT, contour=rectangle(12, 8), sweep=twist)
    rng = np.random.default_rng(3)
    box = [[-15, -15, -51], [15, 15, 101]]
    found = volume(shape, rng.standard_normal(3), box, rng)
    assert found == pytest.approx(4 * 12 * 8 * 100, rel=2e-4)


def test_a_helical_tube_of_a_formula(tube):
    """V = pi r^2 times the length of the axis."""
    axis = {"type": "formula", "x": "40*cos(u)", "y": "40*sin(u)", "z": "5*u", "range": [0, 9]}
    shape = tube(axis=axis, contour={"type": "circle", "radius": 9})
    rng = np.random.default_rng(4)
    truth = np.pi * 81 * 9 * np.hypot(40, 5)
    box = [[-50, -50, -10], [50, 50, 55]]
    assert volume(shape, rng.standard_normal(3), box, rng) == pytest.approx(truth, rel=2e-4)


def test_pappus(tube):
    """An off-centre contour on a circle: V = 2 pi A times the distance of its centroid."""
    rng = np.random.default_rng(5)
    points = np.array([[25, -6], [25, 4], [8, 9], [5, -8]]) - [5, 0]
    following = np.roll(points, -1, axis=0)
    cross = points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]
    area = cross.sum() / 2
    centroid = ((points + following) * cross[:, None]).sum(axis=0) / 6 / area
    shape = tube(axis={**RING, "angle_deg": 360}, contour=polygon(points))
    # n starts along world +x: away from the centre.
    truth = 2 * np.pi * area * (60 + centroid[0])
    box = [[-81, -81, -10], [81, 81, 10]]
    assert volume(shape, rng.standard_normal(3), box, rng) == pytest.approx(truth, rel=2e-4)


def test_a_truncated_ellipsoid_of_a_formula(tube):
    """S = sqrt(1 - u^2) up to +-0.98 is a quadric between two planes."""
    axis = {"type": "line", "start": [0, 0, -49], "end": [0, 0, 49]}
    scale = {"formula": "sqrt(1 - (1.96*u - 0.98)**2)"}
    contour = {"type": "ellipse", "semi_axes": [20, 12]}
    shape = tube(axis=axis, contour=contour, sweep={"type": "linear", "scale": scale})
    truth = quadrics.of(
        {
            "type": "ellipsoid",
            "center": [0, 0, 0],
            "semi_axes": [20, 12, 50],
            "cuts": [{"point": [0, 0, s * 49], "normal": [0, 0, s]} for s in (-1, 1)],
        }
    )
    origins, directions = rays.through_ball(np.random.default_rng(6), 4000, 50.0)
    wanted = [
        np.diff(truth.chords(o, d), axis=1).sum() for o, d in zip(origins, directions, strict=True)
    ]
    assert_implied(lengths_of(shape, origins, directions), np.array(wanted, dtype=float), 50.0)


@pytest.mark.parametrize("bend", [0.67, 0.90, 0.97, 0.99])
def test_tight_rings(tube, bend):
    radius = 60.0 * bend
    shape = tube(axis={**RING, "angle_deg": 360}, contour={"type": "circle", "radius": radius})
    origins, directions = rays.through_ball(np.random.default_rng(7), 1500, 60 + radius)
    exact = torus.chords(60.0, radius, origins, directions)
    wanted = np.array([np.diff(rows, axis=1).sum() for rows in exact])
    assert_implied(lengths_of(shape, origins, directions), wanted, 60 + radius)


CLOSED = {
    "spline": {
        "type": "spline",
        "points": [[60, 0, 0], [0, 55, 8], [-60, 0, -4], [0, -65, 3]],
        "closed": True,
    },
    "formula": {
        "type": "formula",
        "x": "(60+4*cos(3*u))*cos(u)",
        "y": "(60+4*cos(3*u))*sin(u)",
        "z": "6*sin(2*u)",
        "range": [0, 2 * np.pi],
        "closed": True,
    },
}


@pytest.mark.parametrize("name", CLOSED)
def test_a_seam_leaves_no_mark(tube, name):
    """Lengths run on smoothly across the plane of the seam, and nothing is counted twice."""
    shape = tube(axis=CLOSED[name], contour=polygon([[9, 0], [-5, 8], [-7, -6]]))
    start = {"spline": [60.0, 0, 0], "formula": [64.0, 0, 0]}[name]
    count = 400
    y = np.linspace(-1e-3, 1e-3, count)
    origins = np.array(start) + np.stack([0 * y + 1.3, y, 0 * y - 100], axis=1)
    directions = np.tile([0.0, 0, 1], (count, 1))
    found = lengths_of(shape, origins, directions)
    assert found.min() > 1
    assert np.abs(np.diff(found, 2)).max() < 1e-7
    pieces = phantom.intervals(shape, origins, directions)
    assert np.bincount(pieces.ray).max() == 1


def test_rays_in_the_planes_between_segments(tube):
    """A ray in a section's own plane has the section's own chord."""
    shape = tube(axis={**RING, "angle_deg": 170}, contour={"type": "circle", "radius": 15})
    angle = np.radians(170 * np.arange(1, 64) / 64)
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    up = np.tile([0.0, 0, 1], (len(angle), 1))
    for across in (0.0, 5.0, 14.0):
        chord = 2 * np.sqrt(15**2 - across**2)
        found = lengths_of(shape, (60 + across) * out - 100 * up, up)
        assert found == pytest.approx(chord, abs=2e-7)
        found = lengths_of(shape, across * up + 200 * out, -out)
        assert found == pytest.approx(chord, abs=2e-7)


@pytest.mark.parametrize("name", CLOSED)
def test_sources_inside(tube, name):
    """A ray from within and its reverse make up the whole line."""
    shape = tube(axis=CLOSED[name], contour={"type": "circle", "radius": 12})
    rng = np.random.default_rng(8)
    low, high = shape.bounds
    inside = rng.uniform(low, high, (6000, 3))
    inside = inside[phantom.materials_at(shape, inside)[:, 0] == 1]
    directions = rays.unit(rng.standard_normal(inside.shape))
    halves = sum(lengths_of(shape, inside, s * directions) for s in (-1, 1))
    whole = lengths_of(shape, inside - 400 * directions, directions)
    assert_implied(halves, whole, 80.0)
    first = phantom.intervals(shape, inside, directions)
    assert set(first.ray[first.entry_mm == 0]) == set(range(len(inside)))


def pitch_for(gap, radius=10.0, around=40.0):
    """Pitch of a helix whose coils are ``gap`` apart."""

    def nearest(pitch):
        rise = pitch / (2 * np.pi)
        found = minimize_scalar(
            lambda t: (2 * around * np.sin(t / 2)) ** 2 + (rise * t) ** 2,
            bounds=(1.2 * np.pi, 2.6 * np.pi),
            method="bounded",
            options={"xatol": 1e-12},
        )
        return np.sqrt(found.fun) - 2 * radius

    return brentq(lambda pitch: nearest(pitch) - gap, 19, 23, xtol=1e-13)


def coils(pitch):
    helix = {"type": "helix", "center": [0, 0, 0], "axis": [0, 0, 1], "start": [40, 0, 0]}
    return {
        "axis": {**helix, "pitch": pitch, "turns": 2.5},
        "contour": {"type": "circle", "radius": 10},
    }


SLOW = pytest.mark.nightly


@pytest.mark.parametrize(
    "gap", [1e-3, pytest.param(1e-5, marks=SLOW), pytest.param(-5e-7, marks=SLOW)]
)
def test_coils_that_nearly_touch(tube, gap):
    tube(**coils(pitch_for(gap)))


@pytest.mark.parametrize("gap", [-2e-6, -1e-5, -1e-3])
def test_coils_that_overlap_are_refused(tube, gap):
    with pytest.raises(phantom.InvalidDocumentError, match=r"runs into itself.* u = .*mm inside"):
        tube(**coils(pitch_for(gap)))


CIRCLE = {"type": "circle", "radius": 10}
BEND = np.radians(63)
ACCEPTED = {
    "an axis with an inflection": {
        "axis": {
            "type": "formula",
            "x": "10*sin(0.04*u)",
            "y": "0",
            "z": "u",
            "range": [-70, 70],
        },
        "contour": CIRCLE,
    },
    "wide on the outer side only": {
        # Curvature 1/60, and up to 80 mm from the axis, away from its centre.
        "axis": {**RING, "angle_deg": 300},
        "contour": {"type": "circle", "radius": 25},
        "sweep": {"type": "linear", "offset": [55, 0]},
    },
    "a bend of 63 degrees after a wide straight part": {
        "axis": {
            "type": "spline",
            "points": [
                *[[0, 0, z] for z in range(-100, 1, 20)],
                *[
                    [45 * (1 - np.cos(a)), 0, 45 * np.sin(a)]
                    for a in np.linspace(0, BEND, 7)[1:].tolist()
                ],
            ],
        },
        "contour": {"type": "circle", "radius": 1},
        "sweep": {
            "type": "linear",
            "scale": {"knots": [[0, 60], [0.35, 58], [0.6, 35], [0.8, 24], [1, 24]]},
        },
    },
}


@pytest.mark.parametrize("name", ACCEPTED)
def test_hard_but_valid(tube, name):
    shape = tube(**ACCEPTED[name])
    low, high = shape.bounds
    origins, directions = rays.through_ball(
        np.random.default_rng(9), 3000, np.linalg.norm(high - low) / 2, 0.5 * (low + high)
    )
    ahead = lengths_of(shape, origins, directions)
    far = 4 * np.linalg.norm(high - low)
    back = lengths_of(shape, origins + far * directions, -directions)
    assert_implied(ahead, back, 2 * far)
