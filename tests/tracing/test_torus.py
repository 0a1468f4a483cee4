"""A generalized cylinder on a circular axis is a torus, whose quartic is known."""

import itertools

import numpy as np
import pytest

import phantom
from tests.oracles import rays, torus

R, r = 60.0, 20.0
SURFACE_MM = 1e-8
CHORD_MM = 1e-3


def arc(solid, angle_deg=360.0, tube=r, **more):
    axis = {
        "type": "arc",
        "center": [0, 0, 0],
        "normal": [0, 0, 1],
        "start": [R, 0, 0],
        "angle_deg": angle_deg,
    }
    contour = {"type": "circle", "radius": tube}
    return solid(type="generalized_cylinder", axis=axis, contour=contour, **more)


def found(phantom_, origins, directions):
    """Entry and exit of every ray, as a list of (k, 2) arrays."""
    pieces = phantom.intervals(phantom_, origins, directions)
    rows = np.stack([pieces.entry_mm, pieces.exit_mm], axis=1)
    starts = np.searchsorted(pieces.ray, np.arange(1, len(origins)))
    return np.split(rows, starts)


def assert_same_chords(truth, traced, origins, directions, tube=r):
    """None lost, none invented, and every end on the surface."""
    for i, (exact, got) in enumerate(zip(truth, traced, strict=True)):
        for entry, exit_ in exact:
            # A chord shorter than this lies within the surface tolerance of a tangent ray.
            if exit_ - entry > max(CHORD_MM, np.sqrt(8 * tube * SURFACE_MM)):
                middle = 0.5 * (entry + exit_)
                assert np.any((got[:, 0] < middle) & (got[:, 1] > middle)), f"ray {i} lost a chord"
        for entry, exit_ in got:
            middle = 0.5 * (entry + exit_)
            inside = np.any((exact[:, 0] < middle) & (exact[:, 1] > middle))
            assert inside or exit_ - entry < CHORD_MM, f"ray {i} invented a chord"
    ends = np.concatenate(
        [
            origins[i] + w * directions[i]
            for i, rows in enumerate(traced)
            for w in rows.reshape(-1, 1)
        ]
    ).reshape(-1, 3)
    assert np.abs(torus.distance(R, tube, ends)).max() <= SURFACE_MM


@pytest.mark.parametrize("tube", [6.0, 20.0, 0.90 * R, 0.97 * R, 0.99 * R])
def test_20000_random_rays_lose_no_chord_of_a_torus(solid, tube):
    rng = np.random.default_rng(1)
    count = 20_000 if tube == r else 4_000
    origins, directions = rays.through_ball(rng, count, R + tube)
    traced = found(arc(solid, tube=tube), origins, directions)
    truth = torus.chords(R, tube, origins, directions)
    assert_same_chords(truth, traced, origins, directions, tube)
    assert sum(len(t) for t in truth) > count / 4


@pytest.mark.parametrize("depth_mm", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
def test_tangent_rays_are_found_just_inside_and_missed_just_outside(solid, depth_mm):
    rng = np.random.default_rng(2)
    ring, tube_angle = rng.uniform(0, 2 * np.pi, (2, 2000))
    out = np.stack([np.cos(ring), np.sin(ring), np.zeros_like(ring)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    normal = np.cos(tube_angle)[:, None] * out + np.sin(tube_angle)[:, None] * up
    surface = R * out + r * normal
    # Along the larger circle's side of the tube, where the surface curves away along both.
    across = np.sin(tube_angle)[:, None] * out - np.cos(tube_angle)[:, None] * up
    for sign in (-1.0, 1.0):
        origins = surface + sign * depth_mm * normal - 400 * across
        lengths = phantom.path_lengths(arc(solid), origins, across)[:, 0]
        # The rest of the torus may lie on the ray too: the quartic says what remains.
        truth = np.array([np.sum(c[:, 1] - c[:, 0]) for c in torus.chords(R, r, origins, across)])
        chord = 2 * np.sqrt(2 * r * depth_mm)
        implied = np.abs(lengths - truth) * chord / (4 * r)
        assert implied.max() <= SURFACE_MM
        if sign < 0:
            assert np.all(lengths > 0.99 * chord)


@pytest.mark.parametrize("angle_deg", [-75.0, 40.0, 130.0, 270.0])
def test_an_open_arc_is_the_torus_between_its_end_planes(solid, angle_deg):
    rng = np.random.default_rng(3)
    origins, directions = rays.through_ball(rng, 6000, R + r)
    shape = arc(solid, angle_deg)
    lengths = phantom.path_lengths(shape, origins, directions)[:, 0]
    for i, exact in enumerate(torus.chords(R, r, origins, directions)):
        marks = [-_at_plane(origins[i], directions[i], a) for a in (0.0, np.radians(angle_deg))]
        total = 0.0
        for entry, exit_ in exact:
            cuts = [w for w in marks if entry < w < exit_]
            edges = np.sort([entry, *cuts, exit_])
            for a, b in itertools.pairwise(edges):
                x = origins[i] + 0.5 * (a + b) * directions[i]
                turn = np.degrees(np.arctan2(x[1], x[0])) % 360.0
                kept = turn <= angle_deg if angle_deg > 0 else turn >= 360 + angle_deg
                total += (b - a) * kept
        chord = max(total, 1e-3)
        assert abs(lengths[i] - total) * min(1.0, chord / (4 * r)) <= 2 * SURFACE_MM, i


def _at_plane(p, d, angle):
    normal = np.array([-np.sin(angle), np.cos(angle), 0.0])
    return (p @ normal) / (d @ normal)


def test_rays_in_a_section_plane_are_counted_once(solid):
    """A ray that lies in a plane shared by two segments belongs to one of them."""
    shape = arc(solid)
    knots = shape.compiled.scene.knots[:-1]
    rng = np.random.default_rng(4)
    for normal, height in zip(knots[:, :3], knots[:, 3], strict=True):
        center = normal * height + shape.compiled.scene.leaf_center[0]
        radial = np.cross(normal, [0.0, 0.0, 1.0])
        offsets = rng.uniform(-0.95 * r, 0.95 * r, 20)
        along = np.array([0.0, 0.0, 1.0])
        origins = center + (R + offsets)[:, None] * radial * np.sign(1.0) - 100 * along
        lengths = phantom.path_lengths(shape, origins, np.tile(along, (20, 1)))[:, 0]
        where = np.hypot(origins[:, 0], origins[:, 1]) - R
        truth = 2 * np.sqrt(np.maximum(r**2 - where**2, 0))
        np.testing.assert_allclose(lengths, truth, atol=2e-7)


def test_the_seam_of_a_closed_axis_is_not_seen(solid):
    """Along the tube through u = 0 the path is one piece."""
    z = np.linspace(-0.9 * r, 0.9 * r, 50)
    origins = np.stack([np.full(50, R), np.full(50, -300.0), z], axis=1)
    directions = np.tile([0.0, 1.0, 0.0], (50, 1))
    pieces = phantom.intervals(arc(solid), origins, directions)
    assert np.array_equal(pieces.ray, np.arange(50))
