"""A ball in a block is seen as its chords, its photons and the display's standard say."""

from __future__ import annotations

import math

import numpy as np
import pytest

import phantom
from phantom.errors import InvalidInputError
from phantom.imaging import Acquisition, Gsdf, Presentation, visibility

BLOCK_PER_MM, BALL_PER_MM, RADIUS_MM = 0.02, 0.05, 6.0


def _block(with_ball, radius_mm=RADIUS_MM, center=(4, 0, -3)):
    solids = [
        {"type": "box", "center": [0, 0, 0], "size": [50, 30, 50], "material": "block"},
        {
            "type": "sphere",
            "name": "ball",
            "center": [*center],
            "radius": radius_mm,
            "material": "ball",
        },
    ]
    ball = [{"name": "lump", "leaves": ["ball"], "center": [*center], "size_mm": 2 * radius_mm}]
    return phantom.load(
        {
            "format": "phantom/1",
            "materials": {
                "block": {"attenuation_per_mm": BLOCK_PER_MM},
                "ball": {"attenuation_per_mm": BALL_PER_MM},
            },
            "solid": {"type": "replace", "solids": solids} if with_ball else solids[0],
            "findings": ball if with_ball else [],
        }
    )


@pytest.fixture(scope="module")
def pair():
    return _block(True), _block(False)


@pytest.fixture(scope="module")
def view():
    """A parallel beam along y, 120 pixels of 0.5 mm."""
    return phantom.View(
        source=None,
        direction=[0, 1, 0],
        detector=phantom.Detector(
            center=[0, 50, 0], right=[1, 0, 0], down=[0, 0, -1], columns=120, rows=120, pitch_mm=0.5
        ),
    )


def _chords():
    """Chords of the ball over the pixels that it covers."""
    at = (np.arange(120) - 59.5) * 0.5
    x, z = np.meshgrid(at - 4, -at + 3)
    square = RADIUS_MM**2 - x**2 - z**2
    return 2 * np.sqrt(square[square > 0])


def test_contrast_is_the_mean_of_what_the_chords_take_away(pair, view):
    (found,) = visibility(*pair, view)
    taken = np.exp(-(BALL_PER_MM - BLOCK_PER_MM) * _chords()) - 1
    assert found.finding == "lump"
    assert found.pixels == len(taken)
    assert found.contrast == pytest.approx(taken.mean(), rel=1e-9)
    assert found.contrast_to_noise is None
    assert found.jnd is None


def test_contrast_over_noise_follows_from_the_photons(pair, view):
    """A counting detector's noise is the root of its mean."""
    counting = phantom.DetectorModel(response="photon_counting")
    exposure = Acquisition(detector_air_kerma_ugy=2.5, detector=counting)
    (found,) = visibility(*pair, view, acquisition=exposure)
    quiet = Acquisition(detector_air_kerma_ugy=2.5, detector=counting, quantum_noise="off")
    photons = phantom.radiograph(pair[1], view, acquisition=quiet).signal[60, 60]
    taken = np.exp(-(BALL_PER_MM - BLOCK_PER_MM) * _chords()) - 1
    expected = taken.mean() * photons / math.sqrt(photons)
    # 24 x 24 pixels tell a standard deviation to 3 %, one in 1.5 million beyond 5 of these.
    assert found.contrast_to_noise == pytest.approx(expected, rel=0.15)


def test_noise_is_told_even_where_a_finding_covers_one_pixel(view):
    """From 16 x 16 pixels around it, which tell a standard deviation to 4.4 %."""
    ill = _block(True, radius_mm=0.2, center=(4.25, 0, -3.25))
    counting = phantom.DetectorModel(response="photon_counting")
    exposure = Acquisition(detector_air_kerma_ugy=2.5, detector=counting)
    (found,) = visibility(ill, _block(False), view, acquisition=exposure)
    quiet = Acquisition(detector_air_kerma_ugy=2.5, detector=counting, quantum_noise="off")
    photons = phantom.radiograph(ill, view, acquisition=quiet).signal[60, 60]
    assert found.pixels == 1
    taken = math.exp(-(BALL_PER_MM - BLOCK_PER_MM) * 0.4) - 1
    assert found.contrast == pytest.approx(taken, rel=1e-9)
    assert found.contrast_to_noise == pytest.approx(taken * math.sqrt(photons), rel=0.2)


def test_noticeable_differences_are_those_of_the_standard_display(pair, view):
    """From 0.05 to 3993.404 cd/m2 lie 1022 JNDs (PS3.14, table B-1), even in P-values."""
    display = Gsdf(l_min_cd_m2=0.05, l_max_cd_m2=3993.404, l_ambient_cd_m2=0.0)
    shown = Presentation(
        mode="window", scope="fixed", window_center=1.0, window_width=2.0, bits=16, gsdf=display
    )
    (found,) = visibility(*pair, view, presentation=shown)
    darker = (BALL_PER_MM - BLOCK_PER_MM) * _chords().mean() / 2.0
    assert found.jnd == pytest.approx(1022 * darker, rel=2e-3)


def test_a_finding_beside_the_field_is_not_seen(pair, view):
    aside = view.model_copy(
        update={"detector": view.detector.model_copy(update={"center": (200.0, 50.0, 0.0)})}
    )
    (found,) = visibility(*pair, aside)
    assert found == ("lump", 0, None, None, None)


def test_a_presentation_without_a_display_is_refused(pair, view):
    with pytest.raises(InvalidInputError, match="gsdf"):
        visibility(*pair, view, presentation=Presentation())
