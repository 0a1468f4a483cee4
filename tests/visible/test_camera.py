"""Cameras: where points fall, which pose a word means, and what is refused."""

import numpy as np
import pytest

import phantom
from phantom.errors import InvalidInputError
from phantom.visible import CAMERA_NAMES

BOX = np.array([[-30.0, -20, -90], [50, 40, 110]])


def refused(call, **fields):
    with pytest.raises(InvalidInputError) as error:
        call(**fields)
    return [(p.path, p.kind) for p in error.value.problems]


@pytest.mark.parametrize("lens", [{"field_of_view_deg": 40}, {"parallel_width_mm": 30}, {}])
def test_a_point_on_a_pixels_ray_is_seen_in_that_pixel(lens):
    camera = phantom.Camera(
        eye=(3, -80, 20), target=(1, 2, 3), up=(0.1, 0, 1), columns=40, rows=30, **lens
    )
    rng = np.random.default_rng(1)
    columns, rows = rng.uniform(-5, 45, 50), rng.uniform(-5, 35, 50)
    origins, directions = camera.rays(columns, rows)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-15)
    along = rng.uniform(1, 300, 50)
    pixels, depth = camera.project(origins + along[:, None] * directions)
    np.testing.assert_allclose(pixels, np.stack([columns, rows], axis=1), atol=1e-10)
    np.testing.assert_allclose(depth, along * (directions @ camera.axes[2]), atol=1e-10)


def test_the_field_of_view_is_the_angle_between_the_edges():
    camera = phantom.Camera(
        eye=(0, -10, 0), target=(0, 0, 0), field_of_view_deg=60, columns=8, rows=4
    )
    _, (left, right) = camera.rays(np.array([-0.5, 7.5]), np.array([1.5, 1.5]))
    assert np.degrees(np.arccos(left @ right)) == pytest.approx(60)
    wide = phantom.Camera(
        eye=(0, -10, 0), target=(0, 0, 0), parallel_width_mm=12, columns=8, rows=4
    )
    (left, right), _ = wide.rays(np.array([-0.5, 7.5]), np.array([1.5, 1.5]))
    assert np.linalg.norm(right - left) == pytest.approx(12)


def test_what_is_at_or_behind_the_eye_has_no_pixel():
    camera = phantom.Camera(eye=(0, 0, 0), target=(0, 1, 0))
    pixels, depth = camera.project(np.array([[0, -1.0, 0], [1, 0, 0], [0, 2, 0]]))
    assert np.isnan(pixels).all(axis=1).tolist() == [True, True, False]
    assert depth.tolist() == [-1, 0, 2]


POSES = {
    # What is at the picture's right, at its bottom, and nearest to the eye.
    "front": ((1, 0, 0), (0, 0, -1), (0, -1, 0)),
    "back": ((-1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "left": ((0, 1, 0), (0, 0, -1), (1, 0, 0)),
    "right": ((0, -1, 0), (0, 0, -1), (-1, 0, 0)),
    "top": ((1, 0, 0), (0, -1, 0), (0, 0, 1)),
    "bottom": ((1, 0, 0), (0, 1, 0), (0, 0, -1)),
}


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", POSES)
def test_a_word_shows_the_side_it_names(name, parallel):
    camera = phantom.preset_camera(BOX, name, parallel=parallel)
    right, down, near = POSES[name]
    middle = BOX.mean(axis=0)
    found, depth = camera.project(middle + np.array([(0, 0, 0), right, down, near], dtype=float))
    assert found[0] == pytest.approx([511.5, 511.5])
    assert found[1][0] > 511.5
    assert found[2][1] > 511.5
    assert depth[3] == pytest.approx(depth[0] - 1)


@pytest.mark.parametrize("word", ["ap", "left_lateral", "right_lateral"])
def test_a_clinical_word_shows_the_side_of_the_x_ray_view(word):
    """The same axes on the light box: right and down of picture and radiograph agree."""
    ball = {"type": "sphere", "center": [0, 0, 0], "radius": 9.0, "material": "m"}
    shape = phantom.load({"format": "phantom/1", "name": "t", "solid": ball,
                          "materials": {"m": {"attenuation_per_mm": 0.1}}})  # fmt: skip
    view = phantom.preset_view(shape, word)
    right, down, _ = phantom.preset_camera(BOX, word).axes
    np.testing.assert_allclose(right, view.detector.right, atol=1e-12)
    np.testing.assert_allclose(down, view.detector.down, atol=1e-12)


@pytest.mark.parametrize("shape", [(64, 64), (96, 48), (40, 90)])
@pytest.mark.parametrize("parallel", [False, True])
def test_everything_is_in_the_picture_and_little_room_is_wasted(shape, parallel):
    corners = np.array([BOX[[i, j, k], [0, 1, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    for name in CAMERA_NAMES:
        camera = phantom.preset_camera(
            BOX, name, columns=shape[0], rows=shape[1], parallel=parallel
        )
        found, _ = camera.project(corners)
        assert np.all(found > -0.5)
        assert np.all(found < np.array(shape) - 0.5)
        assert np.max(np.ptp(found, axis=0) / shape) > 0.85


def test_zoom_enlarges_about_the_middle():
    near, far = (phantom.CameraPreset(zoom=z).camera(BOX) for z in (2.0, 1.0))
    point = BOX.mean(axis=0) + np.array([1.0, 2, 3])
    (one, _), (two, _) = near.project(point), far.project(point)
    np.testing.assert_allclose(one - 511.5, 2 * (two - 511.5), rtol=1e-12)


def test_azimuth_and_elevation_say_where_the_eye_is():
    camera = phantom.CameraPreset(azimuth_deg=90, elevation_deg=30).camera(BOX)
    away = np.subtract(camera.eye, camera.target)
    np.testing.assert_allclose(away / np.linalg.norm(away), [np.sqrt(0.75), 0, 0.5], atol=1e-12)


def test_what_no_camera_can_do_is_refused():
    point = {"eye": (1, 2, 3), "target": (4, 5, 6)}
    camera = phantom.Camera
    assert refused(camera, eye=(1, 2, 3), target=(1, 2, 3)) == [("/camera/target", "eye_is_target")]
    assert refused(camera, **point, up=(2, 2, 2)) == [("/camera/up", "parallel_up")]
    assert refused(camera, eye=(0, 0, 9), target=(0, 0, 0)) == [("/camera/up", "parallel_up")]
    assert refused(camera, **point, up=(0, 0, 0)) == [("/camera/up", "zero_vector")]
    both = {"field_of_view_deg": 20, "parallel_width_mm": 10}
    assert refused(camera, **point, **both) == [("/camera/parallel_width_mm", "contradiction")]
    assert refused(camera, **point, columns=0)[0][0] == "/camera/columns"
    assert refused(camera, **point, columns=16000, rows=16000) == [("/camera/rows", "too_large")]
    preset = phantom.CameraPreset
    assert refused(preset, preset="front", azimuth_deg=3) == [
        ("/camera/azimuth_deg", "contradiction")
    ]
    assert refused(preset, parallel=True, field_of_view_deg=3) == [
        ("/camera/field_of_view_deg", "contradiction")
    ]
    assert refused(preset, preset="sideways")[0][0] == "/camera/preset"
