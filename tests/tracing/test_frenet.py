"""The paper's frame where the curvature vanishes (section III.B), seen by where the section lies.

The section is a small disc pushed along n, so that a point tells where n points.
"""

import numpy as np
import pytest

import phantom

PUSH, RADIUS = 8.0, 1.0


def document(axis, **more):
    leaf = {
        "type": "generalized_cylinder",
        "material": "m",
        "axis": axis,
        "contour": {"type": "circle", "radius": RADIUS},
        "sweep": {"type": "linear", "offset": [PUSH, 0]},
        "frame": "frenet",
        **more,
    }
    return {
        "format": "phantom/1",
        "name": "frenet",
        "materials": {"m": {"attenuation_per_mm": 0.01}},
        "solid": leaf,
    }


def axis(x, y, z, start, end):
    return {"type": "formula", "x": x, "y": y, "z": z, "range": [start, end]}


def here(loaded, point, n):
    """Say whether the disc lies at ``point + PUSH n`` and not on the other side."""
    n = np.asarray(n, dtype=float) / np.linalg.norm(n)
    points = np.array([point + PUSH * n, point - PUSH * n])
    return phantom.materials_at(loaded, points)[:, 0].tolist() == [1, 0]


def test_at_an_inflection_n_changes_sides_and_a_warning_says_so():
    loaded = phantom.load(document(axis("u", "u**3 / 3000", "0", -40, 40)))
    for u in (-30.0, -10.0, -1.0, 1.0, 10.0, 30.0):
        slope = u**2 / 1000
        n = np.sign(u) * np.array([-slope, 1.0, 0.0])
        assert here(loaded, np.array([u, u**3 / 3000, 0.0]), n), u
    (warning,) = loaded.warnings
    assert warning == "/solid: the frenet frame jumps by 180 degrees at u = 0"


def test_where_the_curvature_only_touches_zero_n_stays():
    loaded = phantom.load(document(axis("u", "u**4 / 300000", "0", -40, 40)))
    for u in (-20.0, -0.5, 0.5, 20.0):
        slope = 4 * u**3 / 300000
        assert here(loaded, np.array([u, u**4 / 300000, 0.0]), [-slope, 1.0, 0.0]), u
    assert loaded.warnings == ()


def test_a_straight_end_takes_the_frame_of_its_neighbour():
    loaded = phantom.load(document(axis("u", "0 if u < 0 else u**3 / 3000", "0", -40, 40)))
    for u in (-39.0, -20.0, -0.1):
        assert here(loaded, np.array([u, 0.0, 0.0]), [0.0, 1.0, 0.0]), u


def test_between_two_bends_n_turns_evenly_by_the_shorter_angle():
    """Before the stretch n is -y, after it -z: a quarter turn, linear in u."""
    shape = axis(
        "u", "u**3 / 3000 if u < 0 else 0", "-(u - 30)**3 / 3000 if u > 30 else 0", -30, 60
    )
    loaded = phantom.load(document(shape))
    for u in (0.5, 7.5, 15.0, 22.5, 29.5):
        angle = np.pi / 2 * u / 30
        n = [0.0, -np.cos(angle), -np.sin(angle)]
        assert here(loaded, np.array([u, 0.0, 0.0]), n), u
    assert loaded.warnings == ()


def test_an_axis_that_is_straight_throughout_is_framed_as_rotation_minimizing():
    line = {"type": "line", "start": [0, 0, 0], "end": [0, 0, 50]}
    loaded = phantom.load(document(line))
    assert here(loaded, np.array([0.0, 0.0, 25.0]), [1.0, 0.0, 0.0])


def test_a_helix_has_its_normal_toward_its_axis():
    helix = {
        "type": "helix",
        "center": [0, 0, 0],
        "axis": [0, 0, 1],
        "start": [40, 0, 0],
        "pitch": 30,
        "turns": 2,
    }
    loaded = phantom.load(document(helix))
    for u in (0.05, 0.4, 0.8):
        angle = 4 * np.pi * u
        point = np.array([40 * np.cos(angle), 40 * np.sin(angle), 60 * u])
        assert here(loaded, point, -np.array([np.cos(angle), np.sin(angle), 0.0])), u


def test_a_frame_that_whirls_is_reported_in_words():
    loaded = phantom.load(document(axis("u", "u**3 / 3000", "u**2 / 2000", -40, 40)))
    (warning,) = loaded.warnings
    assert "the frenet frame turns by" in warning
    assert "nearly straight" in warning


@pytest.mark.parametrize("frame", ["rotation_minimizing", {"up": [0, 0, 1]}])
def test_other_frames_do_not_mind_an_inflection(frame):
    loaded = phantom.load(document(axis("u", "u**3 / 3000", "0", -40, 40), frame=frame))
    assert loaded.warnings == ()
