"""Falloff, windows and focal spots against plain vector geometry."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.imaging.detection import FocalSpot, Window, lattice, source_points
from phantom.imaging.detection.falloff import falloff, geometry
from phantom.imaging.view import Detector, FloatArray, View
from phantom.scene import Phantom, load
from phantom.tracing import raster

TILTED = View(
    source=(120.0, -900.0, 40.0),
    detector=Detector(
        center=(0, 300, 0), right=(1, 0.3, 0), down=(0, 0, -1), columns=40, rows=30, pitch_mm=(9, 7)
    ),
)
STRAIGHT = View(
    source=(0.0, -1000.0, 0.0),
    detector=Detector(
        center=(0, 0, 0), right=(1, 0, 0), down=(0, 0, -1), columns=201, rows=101, pitch_mm=4
    ),
)


def test_falloff_is_the_solid_angle_of_the_pixel() -> None:
    detector = TILTED.detector
    found = falloff(TILTED, Window.whole(detector), "inverse_square_cosine")
    distance, cosine = geometry(TILTED, Window.whole(detector))
    middle = np.linalg.norm(np.subtract(TILTED.source, detector.center))
    for row, column in ((0, 0), (29, 39), (11, 23), (0, 39)):
        ray = detector.pixel(column, row) - np.asarray(TILTED.source)
        length = float(np.linalg.norm(ray))
        slant = abs(float(detector.normal @ ray)) / length
        assert distance[row, column] == pytest.approx(length, rel=1e-12)
        assert cosine[row, column] == pytest.approx(slant, rel=1e-12)
        assert found[row, column] == pytest.approx(slant * (middle / length) ** 2, rel=1e-12)


def test_straight_behind_the_source_falloff_is_the_third_power_of_the_cosine() -> None:
    found = falloff(STRAIGHT, Window.whole(STRAIGHT.detector), "inverse_square_cosine")
    x, y = np.meshgrid(4.0 * (np.arange(201) - 100), 4.0 * (np.arange(101) - 50))
    expected = (1 + (x**2 + y**2) / 1e6) ** -1.5
    assert np.allclose(found, expected, rtol=1e-13, atol=0)
    assert found[50, 100] == 1
    assert (falloff(STRAIGHT, Window.whole(STRAIGHT.detector), "none") == 1).all()


def test_a_parallel_beam_falls_off_with_its_one_angle() -> None:
    view = View(source=None, direction=(0, 1, 1), detector=STRAIGHT.detector)
    found = falloff(view, Window(3, 4, 5, 6), "inverse_square_cosine")
    assert found.shape == (5, 6)
    assert np.allclose(found, np.sqrt(0.5), rtol=1e-14)


def test_a_window_is_cut_out_of_the_whole() -> None:
    whole = falloff(TILTED, Window.whole(TILTED.detector), "inverse_square_cosine")
    part = falloff(TILTED, Window(4, 9, 11, 20), "inverse_square_cosine")
    assert (whole[4:15, 9:29] == part).all()
    detector = TILTED.detector
    grown = Window(4, 9, 11, 20).grown((6, 3), detector)
    assert grown == Window(0, 6, 21, 26)
    assert Window(25, 30, 5, 10).grown((2, 4), detector) == Window(23, 26, 7, 14)


def test_samples_lie_in_equal_parts_of_their_pixel() -> None:
    detector = TILTED.detector
    rays = lattice(detector, Window(4, 9, 11, 20), (3, 2))
    assert (rays.columns, rays.rows) == (60, 22)
    points = [
        rays.first_pixel + rays.column_step * j + rays.row_step * i
        for i in range(2)
        for j in range(3)
    ]
    assert np.mean(points, axis=0) == pytest.approx(detector.pixel(9, 4), abs=1e-9)
    assert points[1] - points[0] == pytest.approx(detector.axes[0] * 3.0)
    assert points[3] - points[0] == pytest.approx(detector.axes[1] * 3.5)
    one = lattice(detector, Window(4, 9, 11, 20))
    assert one.first_pixel == pytest.approx(detector.pixel(9, 4), abs=1e-9)


@pytest.mark.parametrize("shape", ["uniform", "gaussian"])
@pytest.mark.parametrize("points", [(2, 3), (5, 4), (9, 1)])
def test_source_points_have_the_spots_weight_middle_and_variance(
    shape: str, points: tuple[int, int]
) -> None:
    spot = FocalSpot(size_mm=(1.2, 0.6), shape=shape, points=points)  # type: ignore[arg-type]
    found = source_points(TILTED, spot)
    weights = np.array([w for w, _ in found])
    offsets = np.array([np.subtract(p, TILTED.source) for _, p in found])  # type: ignore[arg-type]
    assert len(found) == points[0] * points[1]
    assert weights.sum() == pytest.approx(1, rel=1e-12)
    assert weights @ offsets == pytest.approx([0, 0, 0], abs=1e-12)
    for axis, size, count in zip(TILTED.detector.axes, (1.2, 0.6), points, strict=True):
        along = offsets @ axis
        sigma = size / np.sqrt(12) if shape == "uniform" else size / 2.354820045
        assert weights @ along**2 == pytest.approx(sigma**2 if count > 1 else 0.0, rel=1e-9)
        if shape == "uniform":
            assert np.abs(along).max() <= size / 2
    assert np.allclose(offsets @ TILTED.detector.normal, 0, atol=1e-12)


@pytest.fixture
def block() -> Phantom:
    """A block that lets nothing through, from x = 0 on, with its near edge at y = −600 mm."""
    box = {"type": "box", "center": [100, -599, 0], "size": [200, 2, 400], "material": "m"}
    tree = {"format": "phantom/1", "name": "edge", "solid": box}
    return load({**tree, "materials": {"m": {"attenuation_per_mm": 20.0}}})


def shadow(block: Phantom, view: View, source: FloatArray) -> FloatArray:
    rays = lattice(view.detector, Window.whole(view.detector))
    lengths = raster(
        block,
        source=source,
        direction=None,
        first_pixel=rays.first_pixel,
        column_step=rays.column_step,
        row_step=rays.row_step,
        columns=rays.columns,
        rows=rays.rows,
    )
    image: FloatArray = np.exp(-20.0 * lengths[0, :, 0])
    return image


@pytest.mark.parametrize(("shape", "points"), [("uniform", 8), ("uniform", 25), ("gaussian", 25)])
def test_the_penumbra_of_an_edge_is_that_of_geometry(
    block: Phantom, shape: str, points: int
) -> None:
    view = View(
        source=(0.0, -1000.0, 0.0),
        detector=Detector(
            center=(0, 0, 0), right=(1, 0, 0), down=(0, 0, -1), columns=2001, rows=1, pitch_mm=0.005
        ),
    )
    spot = FocalSpot(size_mm=(2.0, 1.0), shape=shape, points=(points, 1))  # type: ignore[arg-type]
    image = sum(w * shadow(block, view, s) for w, s in source_points(view, spot))  # type: ignore[arg-type]
    assert not isinstance(image, int)
    # The edge's far corner, 402 mm from the source, casts the shadow of rays from the other side.
    x = 0.005 * (np.arange(2001) - 1000)
    spread = -np.diff(image)
    middle = (x[1:] + x[:-1]) / 2
    mean = float(spread @ middle)
    width = np.sqrt(float(spread @ (middle - mean) ** 2))
    sigma = 2.0 / np.sqrt(12) if shape == "uniform" else 2.0 / 2.354820045
    assert width == pytest.approx(sigma * 600 / 400, rel=0.01)
    if shape == "uniform" and points == 25:
        # From where the shadow begins to where it is full: size · (distance ratio).
        inside = np.flatnonzero((image > 1e-6) & (image < 1 - 1e-6))
        assert 0.005 * (inside[-1] - inside[0]) == pytest.approx(3.0, rel=0.05)
        crossing = [float(np.interp(-level, -image, x)) for level in (0.9, 0.1)]
        assert crossing[1] - crossing[0] == pytest.approx(0.8 * 3.0, rel=0.03)
