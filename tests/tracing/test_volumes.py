"""Volumes by Pappus and by quadrature; chords and crossings of random lines."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from scipy.special import ellipe

import phantom
from phantom.tracing import measure
from tests.oracles import cylinders, projection, rays

BONE = {
    "type": "generalized_cylinder",
    "axis": {
        "type": "bspline",
        "degree": 3,
        "control_points": [
            [2, 0, -95],
            [-4, 6, -60],
            [3, 9, -20],
            [6, 10, 25],
            [0, 2, 60],
            [-12, -3, 95],
        ],
    },
    "contour": {"type": "polar", "radii": [13.5, 12.8, 12.5, 13.1, 14.2, 14.0, 12.2, 12.9]},
    "sweep": {
        "type": "linear",
        "scale": [
            {"knots": [[0, 1.9], [0.25, 1.15], [0.5, 1], [0.75, 1.1], [1, 1.6]]},
            {"knots": [[0, 1.5], [0.3, 1.05], [0.7, 0.95], [1, 1.4]]},
        ],
        "rotate_deg": {"knots": [[0, 0], [1, 40]]},
        "offset": [{"knots": [[0, 2], [0.5, -1], [1, 3]]}, -1.5],
    },
}
BOX = [[-29, -26, -100], [30, 20, 104]]


@pytest.fixture(scope="module")
def bone(solid):
    return solid(**BONE)


def test_the_volume_of_a_bone_from_twenty_directions(bone):
    rng = np.random.default_rng(51)
    wanted = cylinders.volume(BONE)
    directions = [*np.eye(3), *rays.unit(rng.standard_normal((17, 3)))]
    found = np.array([projection.volume(bone, d, BOX, rng, 45_000, 0.13) for d in directions])
    assert np.abs(found / wanted - 1).max() <= 1e-5


def test_the_volume_of_a_bone_with_a_spline_section(solid):
    """A C2 axis through points, and a section whose centroid is far from the axis."""
    leaf = {
        **BONE,
        "axis": {"type": "spline", "points": [[0, 0, -60], [9, 3, -20], [7, -4, 25], [-6, 0, 60]]},
        "contour": {"type": "spline", "points": [[17, 2], [6, 12], [-7, 9], [-9, -6], [4, -11]]},
        "sweep": {
            "type": "linear",
            "scale": {"knots": [[0, 1.2], [0.6, 0.8], [1, 1]]},
            "shear": 0.3,
        },
        "frame": {"up": [0, 1, 0.1]},
    }
    wanted = cylinders.volume(leaf)
    shape, rng = solid(**leaf), np.random.default_rng(52)
    box = [[-17, -15, -68], [20, 23, 69]]
    for d in rays.unit(rng.standard_normal((3, 3))):
        assert abs(projection.volume(shape, d, box, rng) / wanted - 1) <= 2e-5


def ring(angle_deg, offset, radius=11.0, big=50.0, **more):
    return {
        "type": "generalized_cylinder",
        "axis": {
            "type": "arc",
            "center": [0, 0, 0],
            "normal": [0, 0, 1],
            "start": [big, 0, 0],
            "angle_deg": angle_deg,
        },
        "contour": {"type": "circle", "radius": radius},
        "sweep": {"type": "linear", "offset": offset},
        **more,
    }


@pytest.mark.parametrize("angle_deg", [360.0, -360.0, 200.0, -75.0])
@pytest.mark.parametrize("outward", [18.0, -18.0])
def test_pappus(solid, angle_deg, outward):
    """V = A (R + c) angle, c the way of the centroid from the axis, outward positive."""
    big, radius = 50.0, 11.0
    # In the frame up = +z, n is +z and b = t x n points outward for turns about +z.
    side = outward if angle_deg > 0 else -outward
    shape = solid(**ring(angle_deg, [0.0, side], frame={"up": [0, 0, 1]}))
    wanted = np.pi * radius**2 * (big + outward) * np.radians(abs(angle_deg))
    rng = np.random.default_rng(53)
    reach = big + outward + radius
    box = [[-reach, -reach, -radius], [reach, reach, radius]]
    for d in ([0.2, 0.3, 1.0], [1.0, 0.2, 0.15]):
        assert abs(projection.volume(shape, d, box, rng) / wanted - 1) <= 2e-5


def test_pappus_with_a_section_off_the_axis_by_its_own_contour(solid):
    """A polar contour whose centroid is off the origin, in the paper's frame: n points inward."""
    leaf = ring(
        360.0,
        [0, 0],
        contour={"type": "polar", "radii": [18, 15, 11, 9, 8, 9, 11, 15]},
        frame="frenet",
        sweep={"type": "linear"},
    )
    theta = 2 * np.pi * np.arange(8) / 8
    r = CubicSpline([*theta, 2 * np.pi], [18, 15, 11, 9, 8, 9, 11, 15, 18], bc_type="periodic")
    area = quad(lambda a: r(a) ** 2 / 2, 0, 2 * np.pi, epsabs=1e-10, limit=200)[0]
    first = quad(lambda a: r(a) ** 3 * np.cos(a) / 3, 0, 2 * np.pi, epsabs=1e-10, limit=200)[0]
    wanted = 2 * np.pi * (50 * area - first)
    assert wanted < 0.95 * 2 * np.pi * 50 * area
    box = [[-60, -60, -18], [60, 60, 18]]
    found = projection.volume(solid(**leaf), [0.3, 0.5, 1], box, np.random.default_rng(54))
    assert abs(found / wanted - 1) <= 2e-5


@pytest.mark.parametrize("turns", [2.3, -0.7])
@pytest.mark.parametrize("frame", ["rotation_minimizing", "frenet"])
def test_a_helical_tube(solid, turns, frame):
    """V = pi r^2 times the helix' length, for a circle about the axis."""
    big, pitch, radius = 30.0, 45.0, 9.0
    shape = solid(
        type="generalized_cylinder",
        axis={
            "type": "helix",
            "center": [1, 2, 3],
            "axis": [0, 0, 3],
            "start": [1 + big, 2, -40],
            "pitch": pitch,
            "turns": turns,
        },
        contour={"type": "circle", "radius": radius},
        frame=frame,
    )
    length = np.hypot(2 * np.pi * big, pitch) * abs(turns)
    rng = np.random.default_rng(55)
    box = [[-39, -38, -50], [41, 42, abs(turns) * pitch - 30]]
    for d in ([1, 0.3, 0.1], [0.2, 0.1, 1]):
        found = projection.volume(shape, d, box, rng)
        assert abs(found / (np.pi * radius**2 * length) - 1) <= 2e-5


def test_chords_of_random_lines_through_a_torus(solid):
    """Over a bounding sphere the mean chord is V / (pi R^2), that of ends S / (2 pi R^2).

    Both within five standard errors of 400,000 lines.
    """
    big, radius = 50.0, 11.0
    shape = solid(**ring(360.0, [0, 0]))
    reach = big + radius + 1
    volume, surface = 2 * np.pi**2 * big * radius**2, 4 * np.pi**2 * big * radius
    origins, directions = rays.through_ball(np.random.default_rng(56), 400_000, reach)
    pieces = phantom.intervals(shape, origins, directions)
    chords = np.bincount(
        pieces.ray, weights=pieces.exit_mm - pieces.entry_mm, minlength=len(origins)
    )
    ends = 2.0 * np.bincount(pieces.ray, minlength=len(origins))
    for found, wanted in ((chords, volume), (ends, surface / 2)):
        error = found.std() / np.sqrt(len(found))
        assert abs(found.mean() - wanted / (np.pi * reach**2)) <= 5 * error


def test_mean_chord_of_a_convex_body(solid):
    """Lines that meet a convex body have the mean chord 4 V / S."""
    a, c = 40.0, 15.0
    shape = solid(type="ellipsoid", center=[1, 2, 3], semi_axes=[a, a, c])
    origins, directions = rays.through_ball(np.random.default_rng(57), 300_000, 40.0, (1, 2, 3))
    lengths = phantom.path_lengths(shape, origins, directions)[:, 0]
    lengths = lengths[lengths > 0]
    e = np.sqrt(1 - (c / a) ** 2)
    surface = 2 * np.pi * a**2 * (1 + (1 - e**2) / e * np.arctanh(e))
    wanted = 4 * (4 / 3 * np.pi * a * a * c) / surface
    assert abs(lengths.mean() - wanted) <= 5 * lengths.std() / np.sqrt(len(lengths))


def test_crossings_of_an_elliptic_tube(solid):
    """Its surface, by an elliptic integral, is what random lines count."""
    a, b, length = 20.0, 8.0, 90.0
    shape = solid(
        type="generalized_cylinder",
        axis={"type": "line", "start": [0, 0, -length / 2], "end": [0, 0, length / 2]},
        contour={"type": "ellipse", "semi_axes": [a, b]},
    )
    perimeter = 4 * a * ellipe(1 - (b / a) ** 2)
    surface = perimeter * length + 2 * np.pi * a * b
    reach = np.hypot(a, length / 2) + 0.5
    origins, directions = rays.through_ball(np.random.default_rng(58), 300_000, reach)
    pieces = phantom.intervals(shape, origins, directions)
    ends = 2.0 * np.bincount(pieces.ray, minlength=len(origins))
    wanted = 2 * surface / (4 * np.pi * reach**2)
    assert abs(ends.mean() - wanted) <= 5 * ends.std() / np.sqrt(len(ends))


@pytest.mark.parametrize("leaf", [BONE, ring(200.0, [0, 5.0])], ids=["bone", "ring"])
def test_the_measure_of_a_phantom_holds_its_promise(solid, leaf):
    """One in a thousand, with an estimate that is not far from the truth."""
    found = measure(solid(**leaf))
    wanted = cylinders.volume(leaf)
    assert abs(found.volume_mm3 / wanted - 1) <= 1e-3
    assert abs(found.volume_mm3 / wanted - 1) <= max(3 * found.relative_error, 2e-4)
