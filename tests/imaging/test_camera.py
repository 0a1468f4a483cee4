"""The projection matrix, against the pinhole itself: source, point and pixel on one line."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.geometry.vectors import box_corners
from phantom.imaging import Detector, View, projection

RNG = np.random.default_rng(1993)


def random_view(*, parallel: bool = False, mirrored: bool = False) -> View:
    """A tilted, off-axis view; ``mirrored`` ones are seen from behind the detector."""
    frame, _ = np.linalg.qr(RNG.normal(size=(3, 3)))
    right, down = frame[:, 0], frame[:, 1]
    normal = np.cross(right, down) * (-1 if mirrored else 1)
    center = RNG.uniform(-100, 100, 3)
    toward = normal + 0.3 * RNG.normal() * right + 0.2 * RNG.normal() * down
    detector = Detector(
        center=center,
        right=right * 2.5,
        down=down * 0.1,
        columns=int(RNG.integers(20, 400)),
        rows=int(RNG.integers(20, 400)),
        pitch_mm=tuple(RNG.uniform(0.1, 1.0, 2)),
    )
    if parallel:
        return View(source=None, direction=toward, detector=detector)
    return View(source=center - 900 * toward, detector=detector)


VIEWS = [
    pytest.param(random_view(parallel=parallel, mirrored=mirrored), id=f"{kind}-{side}-{i}")
    for i in range(5)
    for parallel, kind in ((False, "point"), (True, "parallel"))
    for mirrored, side in ((False, "direct"), (True, "mirrored"))
]


@pytest.mark.parametrize("view", VIEWS)
def test_a_point_on_the_way_to_a_pixel_falls_on_that_pixel(view: View) -> None:
    camera = projection(view)
    for _ in range(20):
        column, row = RNG.uniform(-50, 450, 2)
        pixel = view.detector.pixel(column, row)
        start = pixel - 800 * np.asarray(view.direction) if view.source is None else view.source
        point = start + RNG.uniform(0.2, 0.95) * (pixel - start)
        np.testing.assert_allclose(camera.project(point[None])[0], (column, row), atol=1e-8)


@pytest.mark.parametrize("view", VIEWS)
def test_the_matrix_comes_apart_into_a_camera_and_a_proper_rotation(view: View) -> None:
    camera = projection(view)
    np.testing.assert_allclose(camera.rotation @ camera.rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(camera.rotation) == pytest.approx(1, abs=1e-12)
    assert camera.intrinsics[2].tolist() == [0, 0, 1]
    assert camera.intrinsics[1, 0] == camera.intrinsics[0, 1] == 0
    if view.source is not None:
        whole = camera.intrinsics @ np.column_stack([camera.rotation, camera.translation])
        np.testing.assert_allclose(camera.matrix, whole, rtol=1e-12)
        np.testing.assert_allclose(camera.depth_mm(np.array([view.source])), 0, atol=1e-9)


@pytest.mark.parametrize("view", VIEWS)
def test_only_a_mirrored_picture_has_a_negative_focal_length(view: View) -> None:
    beam = view.direction if view.source is None else np.subtract(view.detector.center, view.source)
    direct = float(np.cross(view.detector.right, view.detector.down) @ np.asarray(beam)) > 0
    assert (projection(view).intrinsics[0, 0] > 0) == direct
    assert projection(view).intrinsics[1, 1] > 0


def test_a_square_in_the_plane_of_a_point_is_magnified_as_said() -> None:
    view = random_view()
    camera = projection(view)
    point = np.asarray(view.source) + 0.6 * np.subtract(view.detector.center, view.source)
    right, down = view.detector.axes
    moved = camera.project(np.stack([point, point + 7 * right, point + 7 * down]))
    magnification = camera.magnification(point)
    assert magnification == pytest.approx(1 / 0.6)
    widths = np.linalg.norm(moved[1:] - moved[0], axis=1) * view.detector.pitch_xy_mm
    np.testing.assert_allclose(widths, 7 * magnification, rtol=1e-9)


def test_a_parallel_beam_magnifies_nothing() -> None:
    assert projection(random_view(parallel=True)).magnification(np.zeros(3)) == 1.0


def test_a_point_at_or_behind_the_source_has_no_image() -> None:
    view = random_view()
    source, away = np.asarray(view.source), np.subtract(view.source, view.detector.center)
    camera = projection(view)
    assert np.isnan(camera.project(np.stack([source + away, source + 0.1 * away]))).all()
    assert camera.magnification(source + away) is None


def test_the_middle_of_the_grid_is_the_centre_and_pixels_lie_at_whole_numbers() -> None:
    detector = Detector(
        center=[5, 6, 7], right=[1, 0, 0], down=[0, 0, -1], columns=5, rows=4, pitch_mm=[2, 3]
    )
    assert detector.pixel(2, 1.5).tolist() == [5, 6, 7]
    assert detector.pixel(0, 0).tolist() == [5 - 2 * 2, 6, 7 + 1.5 * 3]
    view = View(source=[5, -900, 7], detector=detector)
    found = projection(view).project(np.array([detector.pixel(4, 3), detector.pixel(0, 0)]))
    np.testing.assert_allclose(found, [[4, 3], [0, 0]], atol=1e-9)


def test_a_box_has_eight_corners() -> None:
    corners = box_corners(np.array([[0.0, 1, 2], [10, 11, 12]]))
    assert len({tuple(c) for c in corners.tolist()}) == 8
    assert corners.min(axis=0).tolist() == [0, 1, 2]
    assert corners.max(axis=0).tolist() == [10, 11, 12]
