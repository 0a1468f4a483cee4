"""The range of a box against many points in it, and epipolar lines against projected points."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.imaging import Detector, View, projection
from phantom.imaging.stereo import eyes
from phantom.stereo import Stereo, fundamental_matrix
from phantom.stereo.disparity import differences

RNG = np.random.default_rng(1985)
CENTER = np.array([20.0, -30.0, 10.0])


def tilted(*, parallel: bool = False, mirrored: bool = False) -> View:
    """A view in a random pose, its tube off the detector's axis."""
    frame, _ = np.linalg.qr(RNG.normal(size=(3, 3)))
    right, down = frame[:, 0], frame[:, 1]
    normal = np.cross(right, down) * (-1 if mirrored else 1)
    toward = normal + 0.1 * right + 0.05 * down
    detector = Detector(
        center=CENTER + 120 * toward,
        right=right,
        down=down,
        columns=301,
        rows=200,
        pitch_mm=(0.2, 0.35),
    )
    if parallel:
        return View(source=None, direction=toward, detector=detector)
    return View(source=CENTER - 900 * toward, detector=detector)


def matrices(view: View, **fields: float) -> tuple[np.ndarray, np.ndarray]:
    stereo = Stereo(**fields)
    assert isinstance(stereo.separation, float)
    found = eyes(view, stereo, stereo.separation, CENTER)
    return projection(found.left).matrix, projection(found.right).matrix


def projected(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    found = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    return found[:, :2] / found[:, 2:]


SHIFT, ROTATE = {"baseline_mm": 80.0}, {"method": "rotate", "angle_deg": 8.0}
CASES = [
    pytest.param(tilted(mirrored=mirrored), fields, id=f"{name}-{'behind' if mirrored else 'tube'}")
    for name, fields in (("shift", SHIFT), ("rotate", ROTATE))
    for mirrored in (False, True)
]
CASES.append(pytest.param(tilted(parallel=True), ROTATE, id="rotate-parallel"))


@pytest.mark.parametrize(("view", "fields"), CASES)
@pytest.mark.parametrize("axis", [0, 1])
def test_the_range_of_a_box_is_that_of_its_points(view, fields, axis) -> None:
    left, right = matrices(view, **fields)
    for _ in range(10):
        low = CENTER + RNG.uniform(-60, 20, 3)
        box = np.stack([low, low + RNG.uniform(0.5, 60, 3)])
        share = np.linspace(0, 1, 41)
        grid = np.stack(np.meshgrid(share, share, share), axis=-1).reshape(-1, 3)
        points = box[0] + grid * (box[1] - box[0])
        sampled = (projected(left, points) - projected(right, points))[:, axis]
        found = differences(box[np.newaxis], left, right, axis=axis)
        assert found[0] <= sampled.min() + 1e-9
        assert found[1] >= sampled.max() - 1e-9
        slack = 1e-9 + 0.002 * (sampled.max() - sampled.min())
        assert found[0] >= sampled.min() - slack
        assert found[1] <= sampled.max() + slack


def test_a_plate_in_the_plane_of_the_screen_has_its_extreme_between_its_edges() -> None:
    """The surface of no disparity of turned eyes is a circle, so a plate meets it in the middle."""
    view = View(
        source=[0, -900, 0],
        detector=Detector(
            center=[0, 100, 0], right=[1, 0, 0], down=[0, 0, -1], columns=100, rows=100, pitch_mm=1
        ),
    )
    found = eyes(view, Stereo(**ROTATE), 8.0, np.zeros(3))
    cameras = projection(found.left).matrix, projection(found.right).matrix
    plate = np.array([[[-80.0, 0.0, -1.0], [80.0, 0.0, 1.0]]])
    low, high = differences(plate, *cameras, axis=0)
    corner = np.array([[80.0, 0.0, 1.0]])
    at_corner = (projected(cameras[0], corner) - projected(cameras[1], corner))[0, 0]
    assert abs(at_corner) > 0.5
    assert min(abs(low), abs(high)) <= 1e-9, "in the middle of the plate there is none"


@pytest.mark.parametrize(("view", "fields"), CASES)
def test_both_images_of_a_point_lie_on_its_epipolar_line(view, fields) -> None:
    left, right = matrices(view, **fields)
    matrix = fundamental_matrix(left, right)
    points = CENTER + RNG.uniform(-80, 80, (200, 3))
    one, other = (np.column_stack([projected(m, points), np.ones(200)]) for m in (left, right))
    for lines, images in ((one @ matrix.T, other), (other @ matrix, one)):
        away = np.einsum("ij,ij->i", lines, images) / np.hypot(lines[:, 0], lines[:, 1])
        assert np.abs(away).max() <= 1e-6
    assert np.linalg.matrix_rank(matrix, tol=1e-9) == 2


@pytest.mark.parametrize(("view", "fields"), CASES)
def test_only_a_shift_has_no_vertical_disparity(view, fields) -> None:
    left, right = matrices(view, **fields)
    points = CENTER + RNG.uniform(-80, 80, (200, 3))
    rows = (projected(left, points) - projected(right, points))[:, 1]
    if "baseline_mm" in fields:
        assert np.abs(rows).max() <= 1e-9
    elif view.source is not None:
        assert np.abs(rows).max() > 0.1


@pytest.mark.parametrize(("view", "fields"), CASES)
def test_the_isocentre_is_where_it_was_and_in_the_screen(view, fields) -> None:
    left, right = matrices(view, **fields)
    at = [projected(m, CENTER[np.newaxis])[0] for m in (projection(view).matrix, left, right)]
    np.testing.assert_allclose(at[1], at[0], atol=1e-9)
    np.testing.assert_allclose(at[2], at[0], atol=1e-9)


def test_one_eye_has_no_epipolar_lines() -> None:
    left, _ = matrices(tilted(), **SHIFT)
    assert fundamental_matrix(left, left) is None


def test_a_box_that_reaches_an_eye_has_no_range() -> None:
    view = tilted()
    left, right = matrices(view, **SHIFT)
    source = np.asarray(view.source)
    assert (
        differences(np.stack([source - 50, source + 50])[np.newaxis], left, right, axis=0) is None
    )
