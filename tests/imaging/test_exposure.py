"""A radiograph with a detector: its signal against chords of balls, and what it says of itself."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging import (
    Acquisition,
    Beam,
    Detector,
    DetectorModel,
    Digitizer,
    FocalSpot,
    Grid,
    NoiseKey,
    Scatter,
    View,
    preset_view,
    radiograph,
)
from phantom.scene import Phantom

Ball = Callable[..., Phantom]
Chord = Callable[..., float]
COUNTS = DetectorModel(response="photon_counting")
RADIUS_MM, MU_PER_MM = 20.0, 0.02


def counted(**fields: Any) -> Acquisition:
    return Acquisition(**{"quantum_noise": "off", "detector": COUNTS, **fields})


@pytest.fixture
def ball(ball_at: Ball) -> Phantom:
    return ball_at((0, 0, 0), RADIUS_MM)


def expected(view: View, chord: Chord, source: Any, column: float, row: float) -> float:
    mm = chord(source, view.detector.pixel(column, row), (0, 0, 0), RADIUS_MM)
    return float(np.exp(-MU_PER_MM * mm))


def test_the_samples_of_a_pixel_are_averaged_after_the_exponential(
    ball: Phantom, chord: Chord
) -> None:
    view = preset_view(ball, "ap", columns=7, rows=5, pitch_mm=8)
    image = radiograph(ball, view, acquisition=counted(samples_per_pixel=(2, 3)))
    ideal = radiograph(ball, view)
    for row in range(5):
        for column in range(7):
            passed = [
                expected(view, chord, view.source, column + x, row + y)
                for x in (-0.25, 0.25)
                for y in (-1 / 3, 0.0, 1 / 3)
            ]
            found = image.signal[row, column] / image.open_field
            assert found == pytest.approx(np.mean(passed), rel=1e-9)
    # What is ideal stays the pixel centres'.
    np.testing.assert_array_equal(image.path_lengths, ideal.path_lengths)
    np.testing.assert_array_equal(image.transmission, ideal.transmission)


def test_a_focal_spot_averages_what_comes_from_its_points(ball: Phantom, chord: Chord) -> None:
    view = preset_view(ball, "ap", columns=9, rows=3, pitch_mm=6)
    # Two points of a uniform spot have its variance, size²/12, at ± size/√12.
    spot = FocalSpot(size_mm=(9.0, 1.0), points=(2, 1))
    image = radiograph(ball, view, acquisition=counted(focal_spot=spot))
    right, _ = view.detector.axes
    sources = [np.add(view.source, side * 9.0 / np.sqrt(12) * right) for side in (-1, 1)]
    for row in range(3):
        for column in range(9):
            passed = [expected(view, chord, source, column, row) for source in sources]
            found = image.signal[row, column] / image.open_field
            assert found == pytest.approx(np.mean(passed), rel=1e-9)


def test_the_signal_counts_the_photons_of_the_dose(ball: Phantom) -> None:
    view = preset_view(ball, "ap", columns=400, rows=300, pitch_mm=0.5)
    asked = Acquisition(detector_air_kerma_ugy=0.01, detector=COUNTS)
    image = radiograph(ball, view, acquisition=asked, noise=NoiseKey(seed=5))
    assert image.signal_unit == "photons"
    beside = image.signal[image.transmission == 1.0]
    # NIST: μ_en/ρ of dry air is 0.03041 cm²/g at 60 keV; 1 keV/g = 1.602177e-7 µGy.
    photons = 0.01 / (60 * 0.03041 * 1.602177e-7) / 100 * 0.5**2
    limit = 5 * np.sqrt(photons / beside.size)
    assert beside.mean() == pytest.approx(photons, abs=limit, rel=2e-3)
    assert image.open_field == pytest.approx(photons, rel=2e-3)
    assert beside.var() == pytest.approx(photons, rel=5 * np.sqrt(2 / beside.size) + 2e-3)
    assert np.array_equal(image.signal, np.rint(image.signal))


def test_seed_and_case_choose_the_noise_and_threads_do_not(ball: Phantom) -> None:
    view = preset_view(ball, "ap", columns=40, rows=30)
    noisy = Acquisition(detector_air_kerma_ugy=0.1)

    def signal(workers: int | None = None, **key: int) -> Any:
        return radiograph(
            ball, view, acquisition=noisy, noise=NoiseKey(**key), workers=workers
        ).signal

    first = signal(1)
    np.testing.assert_array_equal(first, signal(3, seed=0))
    for key in ({"seed": 1}, {"case": 1}, {"eye": 1}):
        other = signal(**key)
        assert (other != first).mean() > 0.9
    with pytest.raises(ValueError, match="read-only"):
        first[0, 0] = 0


def test_scatter_and_grid_reach_the_signal(ball_at: Ball) -> None:
    ball = ball_at((0, 0, 0), 80)
    view = preset_view(ball, "ap", columns=32, rows=32)
    grid = Grid(primary_transmission=0.7, scatter_transmission=0.1)
    bare = radiograph(ball, view, acquisition=counted())
    both = radiograph(ball, view, acquisition=counted(scatter=Scatter()))
    through = radiograph(ball, view, acquisition=counted(scatter=Scatter(), grid=grid))
    scattered = both.signal - bare.signal
    assert scattered.min() > 0
    behind = 0.7 * bare.signal + 0.1 * scattered
    np.testing.assert_allclose(through.signal, behind, rtol=1e-12)
    told = through.metadata()
    whole = (bare.signal.sum() + scattered.sum()) / behind.sum()
    assert told["exposure"]["bucky_factor"] == pytest.approx(whole, rel=0.02)
    (stage,) = (s for s in told["stages"] if s["stage"] == "scatter")
    assert stage["air_gap_mm"] == pytest.approx(view.detector.center[1] - 80)


def test_what_was_done_is_told_in_order(ball: Phantom) -> None:
    view = preset_view(ball, "ap", columns=8, rows=8)
    asked = Acquisition(
        mas=2.0,
        falloff="inverse_square_cosine",
        samples_per_pixel=(2, 2),
        detector=DetectorModel(
            electronic_noise=2.0, digitizer=Digitizer(bits=12, codes_per_signal=1e-4)
        ),
    )
    seen: list[tuple[int, int]] = []
    image = radiograph(
        ball,
        view,
        Beam(kvp=70),
        acquisition=asked,
        noise=NoiseKey(seed=3, case=9),
        progress=lambda done, total: seen.append((done, total)),
    )
    told = json.loads(json.dumps(image.metadata()))
    assert [stage["stage"] for stage in told["stages"]] == [
        "path_lengths",
        "spectrum",
        "beer_lambert",
        "exposure",
        "falloff",
        "sampling",
        "quantum_noise",
        "detector",
        "electronic_noise",
        "digitizer",
    ]
    assert told["units"]["signal"] == image.signal_unit == "codes"
    assert told["noise"] == {"seed": 3, "case": 9, "view": 0, "eye": 0}
    assert told["acquisition"]["mas"] == 2.0
    # Output at 1 m by the inverse square of the distance, as an exposure index of 100 a µGy.
    (spectrum,) = (s for s in told["stages"] if s["stage"] == "spectrum")
    kerma = 2 * spectrum["air_kerma_ugy_per_mas_at_1m"] / 1.15**2
    assert told["exposure"]["exposure_index"] == pytest.approx(100 * kerma, rel=1e-3)
    assert seen[-1] == (8 + 16, 8 + 16)  # the centres' rows, and those of the samples


def test_an_ideal_image_has_no_exposure_to_tell(ball: Phantom) -> None:
    view = preset_view(ball, "ap", columns=4, rows=4)
    image = radiograph(ball, view, noise=NoiseKey(seed=1))
    assert not {"acquisition", "exposure", "noise"} & set(image.metadata())
    assert any("seed has no effect" in warning for warning in image.warnings)
    assert image.signal is image.transmission


def test_the_voltage_counts_for_the_detector_where_it_does_not_for_the_phantom(
    ball: Phantom,
) -> None:
    view = preset_view(ball, "ap", columns=4, rows=4)
    soft, hard = (radiograph(ball, view, Beam(kvp=kvp), acquisition=counted()) for kvp in (50, 90))
    np.testing.assert_allclose(soft.transmission, hard.transmission, rtol=1e-12)
    assert abs(soft.open_field / hard.open_field - 1) > 0.1
    (warning,) = soft.warnings
    assert "no effect on what comes through" in warning


@pytest.mark.parametrize(
    ("beam", "asked", "path"),
    [
        (Beam(energy_kev=60), {"mas": 1.0}, "/acquisition/mas"),
        (
            Beam(kvp=70),
            {"detector": {"blur": {"half_frequency_per_mm": 1e-3}}},
            "/acquisition/detector/blur/half_frequency_per_mm",
        ),
    ],
)
def test_what_cannot_be_exposed_is_refused(
    ball: Phantom, beam: Beam, asked: dict[str, Any], path: str
) -> None:
    view = preset_view(ball, "ap", columns=4, rows=4, pitch_mm=0.1)
    with pytest.raises(InvalidInputError) as refusal:
        radiograph(ball, view, beam, acquisition=Acquisition(**asked))
    assert [p.path for p in refusal.value.problems] == [path]


def test_a_detector_behind_the_source_is_refused(ball: Phantom) -> None:
    side: dict[str, Any] = {
        "right": [1, 0, 0],
        "down": [0, 0, -1],
        "columns": 4,
        "rows": 4,
        "pitch_mm": 9,
    }
    view = View(source=(0, 50, 0), detector=Detector(center=(0, 900, 0), **side))
    with pytest.raises(InvalidInputError) as refusal:
        radiograph(ball, view)
    assert [p.kind for p in refusal.value.problems] == ["detector_behind_source"]
    # With the tube inside the phantom there is something to see.
    within = View(source=(0, 10, 0), detector=Detector(center=(0, 900, 0), **side))
    assert radiograph(ball, within).path_lengths.max() == pytest.approx(10.0, rel=0.05)
