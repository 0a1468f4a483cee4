"""The MTF that was asked for, measured as on a real detector."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging.detection import Blur
from phantom.imaging.detection.blur import blurred, halo, kernel, mixture, mtf, parts
from phantom.imaging.view import FloatArray

PITCH_MM = 0.14
SHAPES = ["gaussian", "lorentzian"]


def slanted_edge(size: int, degrees: float, pitch: float) -> FloatArray:
    """An edge through the middle, each pixel the value at its centre: no aperture."""
    at = (np.arange(size) - (size - 1) / 2) * pitch
    return (at[None, :] > at[:, None] * math.tan(math.radians(degrees))).astype(np.float64)


def measured_mtf(
    image: FloatArray, degrees: float, pitch: float, frequencies: FloatArray
) -> FloatArray:
    """MTF across an edge by oversampling (ISO 12233; IEC 62220-1-1): project, bin, differ."""
    rows, columns = image.shape
    across = (np.arange(columns) - (columns - 1) / 2) * pitch
    shift = (np.arange(rows) - (rows - 1) / 2) * pitch * math.tan(math.radians(degrees))
    distance = (across[None, :] - shift[:, None]) * math.cos(math.radians(degrees))
    step = pitch / 10
    reach = 40 * pitch
    inside = np.abs(distance) < reach
    bins = np.floor((distance[inside] + reach) / step).astype(int)
    count = np.bincount(bins)
    edge = np.bincount(bins, weights=image[inside]) / count
    spread = np.diff(edge)
    x = (np.arange(len(spread)) + 0.5) * step - reach
    waves = np.exp(-2j * math.pi * np.outer(frequencies, x)) @ spread
    # The bins' own width, and the difference over one step.
    return np.abs(waves) / np.abs(spread.sum()) / np.sinc(frequencies * step)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("half", [0.8, 1.6])
def test_a_slanted_edge_shows_the_mtf_asked_for(shape: str, half: float) -> None:
    blur = Blur(shape=shape, half_frequency_per_mm=half)  # type: ignore[arg-type]
    image = blurred(slanted_edge(480, 3.0, PITCH_MM), blur, (PITCH_MM, PITCH_MM))
    frequencies = np.linspace(0.05, 0.95, 19) * 0.5 / PITCH_MM
    found = measured_mtf(image[130:-130], 3.0, PITCH_MM, frequencies)
    asked = mtf(blur, frequencies)
    assert np.abs(found - asked).max() < 0.004
    seen = (frequencies < 0.9 * 0.5 / PITCH_MM) & (asked > 0.25)
    assert found[seen] == pytest.approx(asked[seen], rel=0.01)


def test_the_shapes_by_their_formulas() -> None:
    frequencies = np.array([0.0, 1.0, 2.0, 4.0])
    expected = {
        "gaussian": [1, 2**-0.25, 0.5, 2**-4.0],
        "lorentzian": [1, 0.8, 0.5, 0.2],
    }
    for shape, values in expected.items():
        blur = Blur(shape=shape, half_frequency_per_mm=2.0)  # type: ignore[arg-type]
        assert mtf(blur, frequencies) == pytest.approx(values)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("half", [0.3, 1.0, 3.0, 20.0])
def test_gaussians_add_up_to_the_mtf(shape: str, half: float) -> None:
    blur = Blur(shape=shape, half_frequency_per_mm=half)  # type: ignore[arg-type]
    frequencies = np.linspace(0, 0.5 / PITCH_MM * math.sqrt(2), 400)
    found = sum(w * np.exp(-2 * (math.pi * s * frequencies) ** 2) for w, s in mixture(blur))
    assert np.abs(found - mtf(blur, frequencies)).max() < 1e-3


@pytest.mark.parametrize("sigma", [0.0, 0.2, 0.45, 0.8, 3.0, 30.0])
def test_a_kernel_has_its_mtf_up_to_the_nyquist_frequency(sigma: float) -> None:
    taps = np.array(kernel(sigma))
    assert len(taps) % 2 == 1
    assert taps.sum() == pytest.approx(1, rel=1e-12)
    assert taps == pytest.approx(taps[::-1], abs=0)
    at = np.arange(len(taps)) - len(taps) // 2
    frequencies = np.linspace(0, 0.5, 101)
    found = np.cos(2 * math.pi * np.outer(frequencies, at)) @ taps
    missed = np.abs(found - np.exp(-2 * (math.pi * sigma * frequencies) ** 2))
    assert missed[frequencies < 0.45].max() < 2e-3
    assert missed.max() < 8e-3


def test_blur_keeps_what_is_even_and_the_sum_of_a_point() -> None:
    blur = Blur(shape="lorentzian", half_frequency_per_mm=1.2)
    assert blurred(np.full((40, 50), 7.0), blur, (0.1, 0.2)) == pytest.approx(np.full((40, 50), 7))
    point = np.zeros((301, 301))
    point[150, 150] = 1
    found = blurred(point, blur, (0.1, 0.2))
    assert found.sum() == pytest.approx(1, rel=1e-9)
    reach_down, reach_across = halo(blur, (0.1, 0.2))
    assert (found[150, : 150 - reach_across] == 0).all()
    assert (found[: 150 - reach_down, 150] == 0).all()


@pytest.mark.parametrize("shape", SHAPES)
def test_a_window_with_its_halo_is_what_the_whole_gives(shape: str) -> None:
    blur = Blur(shape=shape, half_frequency_per_mm=1.5)  # type: ignore[arg-type]
    image = np.random.default_rng(3).normal(100, 20, (200, 220))
    whole = blurred(image, blur, (PITCH_MM, PITCH_MM))
    down, across = halo(blur, (PITCH_MM, PITCH_MM))
    assert max(down, across) < 70
    top, left = max(90 - down, 0), max(100 - across, 0)
    part = blurred(image[top : 110 + down, left : 130 + across], blur, (PITCH_MM, PITCH_MM))
    assert (part[90 - top :, 100 - left :][:20, :30] == whole[90:110, 100:130]).all()


def test_a_blur_wider_than_can_be_summed_is_refused() -> None:
    with pytest.raises(InvalidInputError) as refusal:
        parts(Blur(half_frequency_per_mm=0.001), (0.1, 0.1))
    assert [p.path for p in refusal.value.problems] == [
        "/acquisition/detector/blur/half_frequency_per_mm"
    ]
