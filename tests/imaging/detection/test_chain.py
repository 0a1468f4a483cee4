"""The whole chain: what comes out, in which order, and on what it does not depend."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from phantom.errors import CancelledError
from phantom.imaging.beam import attenuations_per_mm
from phantom.imaging.detection import (
    Absorber,
    Acquisition,
    Blur,
    DetectorModel,
    Digitizer,
    Exposed,
    FocalSpot,
    Grid,
    NoiseKey,
    Scatter,
    Window,
    expose,
    lattice,
    scatter_lattice,
    source_points,
    traced_window,
)
from phantom.imaging.detection.falloff import falloff
from phantom.imaging.detection.kerma import photons_per_mm2
from phantom.imaging.detection.stages import without_effect
from phantom.imaging.detection.window import Lattice
from phantom.imaging.spectrum import Spectrum, monochromatic, relative
from phantom.imaging.view import Detector, FloatArray, View
from phantom.scene import Phantom
from phantom.tracing import raster

VIEW = View(
    source=(0, -700, 0),
    detector=Detector(
        center=(0, 100, 0), right=(1, 0, 0), down=(0, 0, -1), columns=96, rows=80, pitch_mm=1.0
    ),
)
TUBE = relative(np.array([35.0, 50, 62, 75]), np.array([1.0, 3, 3, 1]))
EVERYTHING = Acquisition(
    detector_air_kerma_ugy=1.0,
    falloff="inverse_square_cosine",
    flat_field=True,
    focal_spot=FocalSpot(size_mm=(1.0, 0.6), points=(2, 2)),
    scatter=Scatter(air_gap_mm=60.0),
    grid=Grid(primary_transmission=0.7, scatter_transmission=0.1),
    samples_per_pixel=(2, 1),
    detector=DetectorModel(
        absorber=Absorber(material="cesium_iodide", thickness_mg_cm2=200),
        swank_factor=0.9,
        blur=Blur(shape="lorentzian", half_frequency_per_mm=0.3),
        electronic_noise=300.0,
        digitizer=Digitizer(bits=14, codes_per_signal=0.004, offset_codes=20),
    ),
)
KEY = NoiseKey(seed=11, case=4)


def traced(phantom: Phantom, rays: Lattice, source: FloatArray | None) -> FloatArray:
    return raster(
        phantom,
        source=source,
        direction=None,
        first_pixel=rays.first_pixel,
        column_step=rays.column_step,
        row_step=rays.row_step,
        columns=rays.columns,
        rows=rays.rows,
    )


def exposed(
    phantom: Phantom,
    acquisition: Acquisition,
    window: Window | None = None,
    spectrum: Spectrum = TUBE,
    **options: Any,
) -> Exposed:
    rays = lattice(
        VIEW.detector,
        traced_window(VIEW, acquisition, window or Window.whole(VIEW.detector)),
        acquisition.samples_per_pixel,
    )

    def traces() -> Iterator[tuple[float, FloatArray]]:
        for weight, source in source_points(VIEW, acquisition.focal_spot):
            yield weight, traced(phantom, rays, source)

    field = traced(phantom, scatter_lattice(VIEW.detector), np.asarray(VIEW.source, dtype=float))
    return expose(
        traces(),
        attenuation_per_mm=attenuations_per_mm(phantom.document.materials, spectrum.energies_kev),
        spectrum=spectrum,
        view=VIEW,
        acquisition=acquisition,
        window=window,
        field_path_lengths=field,
        **{"key": KEY, **options},
    )


@pytest.mark.parametrize("noise", ["compound", "per_bin"])
def test_a_pixel_does_not_depend_on_tile_crop_or_threads(balls: Phantom, noise: str) -> None:
    acquisition = EVERYTHING.model_copy(update={"quantum_noise": noise})
    whole = exposed(balls, acquisition, workers=1)
    again = exposed(balls, acquisition, workers=4)
    assert (whole.signal == again.signal).all()
    for window in (Window(31, 40, 17, 23), Window(0, 70, 80, 26), Window(79, 95, 1, 1)):
        part = exposed(balls, acquisition, window)
        rows, columns = (
            slice(window.first_row, window.first_row + window.rows),
            slice(window.first_column, window.first_column + window.columns),
        )
        assert (part.signal == whole.signal[rows, columns]).all()
        assert part.stages == whole.stages


def test_without_noise_the_signal_is_beers_law_over_the_bins(balls: Phantom) -> None:
    acquisition = Acquisition(detector_air_kerma_ugy=3.0, quantum_noise="off")
    found = exposed(balls, acquisition)
    rays = lattice(VIEW.detector, Window.whole(VIEW.detector))
    lengths = traced(balls, rays, np.asarray(VIEW.source, dtype=float))
    photons = photons_per_mm2(TUBE, acquisition, 800.0)
    mu = attenuations_per_mm(balls.document.materials, TUBE.energies_kev)
    expected = np.zeros(lengths.shape[:2])
    for e, n, row in zip(TUBE.energies_kev, photons, mu, strict=True):
        expected += e * n * np.exp(-(lengths @ row))
    assert found.signal == pytest.approx(expected, rel=1e-12)
    assert found.unit == "keV"
    assert found.open_field == pytest.approx(float(photons @ TUBE.energies_kev))
    assert found.signal[0, 0] == pytest.approx(found.open_field)
    assert found.detector_air_kerma_ugy == pytest.approx(3.0)
    assert found.exposure_index == pytest.approx(300.0)


def test_one_energy_may_come_with_one_row_of_coefficients(balls: Phantom) -> None:
    spectrum = monochromatic(60.0)
    acquisition = Acquisition(quantum_noise="off")
    rays = lattice(VIEW.detector, Window.whole(VIEW.detector))
    lengths = traced(balls, rays, np.asarray(VIEW.source, dtype=float))
    mu = attenuations_per_mm(balls.document.materials, 60.0)
    found = expose(
        [(1.0, lengths)],
        attenuation_per_mm=mu,
        spectrum=spectrum,
        view=VIEW,
        acquisition=acquisition,
        key=KEY,
    )
    assert found.signal / found.open_field == pytest.approx(np.exp(-(lengths @ mu)), rel=1e-12)


def test_samples_are_averaged_after_the_exponential(balls: Phantom) -> None:
    acquisition = Acquisition(samples_per_pixel=(3, 2), quantum_noise="off")
    found = exposed(balls, acquisition, spectrum=monochromatic(60.0))
    rays = lattice(VIEW.detector, Window.whole(VIEW.detector), (3, 2))
    lengths = traced(balls, rays, np.asarray(VIEW.source, dtype=float))
    mu = attenuations_per_mm(balls.document.materials, 60.0)
    fine = np.exp(-(lengths @ mu))
    expected = fine.reshape(80, 2, 96, 3).mean(axis=(1, 3))
    assert found.signal / found.open_field == pytest.approx(expected, rel=1e-12)


def test_a_flat_field_undoes_the_falloff_and_leaves_its_noise(ball_at: Any) -> None:
    nothing = ball_at((0, -2000, 0), 1.0)
    fields: dict[str, Any] = {"falloff": "inverse_square_cosine", "quantum_noise": "off"}
    shape = falloff(VIEW, Window.whole(VIEW.detector), "inverse_square_cosine")
    even = exposed(nothing, Acquisition(**fields, flat_field=True))
    uneven = exposed(nothing, Acquisition(**fields))
    assert uneven.signal == pytest.approx(uneven.open_field * shape, rel=1e-12)
    assert even.signal == pytest.approx(np.full((80, 96), even.open_field), rel=1e-12)


def test_scatter_adds_and_the_grid_takes_it_away(balls: Phantom) -> None:
    off: dict[str, Any] = {"quantum_noise": "off"}
    grid = Grid(primary_transmission=0.8, scatter_transmission=0.0)
    clean = exposed(balls, Acquisition(**off))
    foggy = exposed(balls, Acquisition(**off, scatter=Scatter(air_gap_mm=20.0)))
    both = exposed(balls, Acquisition(**off, scatter=Scatter(air_gap_mm=20.0), grid=grid))
    assert (foggy.signal > clean.signal).all()
    assert both.signal == pytest.approx(0.8 * clean.signal)
    assert both.open_field == pytest.approx(0.8 * clean.open_field)
    listed = {stage["stage"]: stage for stage in foggy.stages}
    extra = (foggy.signal - clean.signal).sum() / clean.signal.sum()
    assert extra == pytest.approx(listed["scatter"]["scatter_to_primary"], rel=0.1)


def test_electronic_noise_is_added_after_blur(ball_at: Any) -> None:
    nothing = ball_at((0, -2000, 0), 1.0)
    model = DetectorModel(electronic_noise=50.0, blur=Blur(half_frequency_per_mm=0.1))
    found = exposed(nothing, Acquisition(quantum_noise="off", detector=model))
    noise = (found.signal - found.open_field) / 50.0
    assert abs(noise.mean()) < 4.5 / np.sqrt(noise.size)
    assert abs(noise.var() - 1) < 4.5 * np.sqrt(2 / noise.size)
    assert abs((noise[:, 1:] * noise[:, :-1]).mean()) < 4.5 / np.sqrt(noise.size)


def test_codes_are_whole_saturated_and_cut_off(balls: Phantom) -> None:
    acquisition = Acquisition(quantum_noise="off")
    analogue = exposed(balls, acquisition)
    gain = 1000 / analogue.open_field
    for bits, limit, greatest in ((14, None, 1007), (14, 0.5, 507), (8, None, 255)):
        digitizer = Digitizer(
            bits=bits,
            codes_per_signal=gain,
            offset_codes=7,
            saturation_signal=None if limit is None else limit * analogue.open_field,
        )
        model = DetectorModel(digitizer=digitizer)
        found = exposed(balls, Acquisition(quantum_noise="off", detector=model))
        assert found.unit == "codes"
        assert found.signal.max() == found.open_field == greatest
        expected = np.minimum(np.rint(7 + gain * analogue.signal), greatest)
        assert np.abs(found.signal - expected).max() == 0


def test_stages_stand_in_their_order_with_their_values(balls: Phantom) -> None:
    found = exposed(balls, EVERYTHING)
    assert [stage["stage"] for stage in found.stages] == [
        "exposure",
        "falloff",
        "focal_spot",
        "sampling",
        "scatter",
        "grid",
        "quantum_noise",
        "detector",
        "blur",
        "electronic_noise",
        "flat_field",
        "digitizer",
    ]
    assert json.loads(json.dumps(found.stages)) == list(found.stages)
    plain = exposed(balls, Acquisition(quantum_noise="off"))
    assert [stage["stage"] for stage in plain.stages] == ["exposure", "detector"]
    assert found.bucky_factor is not None
    assert found.bucky_factor > 1 / 0.7


def test_both_eyes_have_their_own_noise(balls: Phantom) -> None:
    acquisition = Acquisition(detector_air_kerma_ugy=1.0)
    expected = exposed(balls, acquisition.model_copy(update={"quantum_noise": "off"})).signal
    one = exposed(balls, acquisition).signal - expected
    other = exposed(balls, acquisition, key=NoiseKey(seed=11, case=4, eye=1)).signal - expected
    correlation = (one * other).mean() / (one.std() * other.std())
    assert abs(correlation) < 4.5 / np.sqrt(one.size)


def test_a_cancelled_exposure_stops(balls: Phantom) -> None:
    with pytest.raises(CancelledError):
        exposed(balls, Acquisition(), cancelled=lambda: True)


def test_what_has_no_effect_is_said(balls: Phantom) -> None:
    grid = Grid(primary_transmission=0.7, scatter_transmission=0.1)
    found = exposed(balls, Acquisition(grid=grid))
    assert found.warnings == ("the grid's scatter transmission has no effect: there is no scatter",)
    assert exposed(balls, EVERYTHING).warnings == ()
    view = View(source=None, direction=(0, 1, 0), detector=VIEW.detector)
    spot = Acquisition(focal_spot=FocalSpot(size_mm=(1, 1)))
    assert source_points(view, spot.focal_spot) == [(1.0, None)]
    assert without_effect(spot, view) == ("the focal spot has no effect: a parallel beam has none",)


@pytest.mark.parametrize("noise", ["compound", "per_bin"])
def test_noise_lies_about_what_is_expected_scatter_and_all(balls: Phantom, noise: str) -> None:
    model = EVERYTHING.detector.model_copy(
        update={"blur": None, "electronic_noise": 0.0, "digitizer": None}
    )
    changes: dict[str, Any] = {"detector": model, "falloff": "none", "flat_field": False}
    expected = exposed(balls, EVERYTHING.model_copy(update={**changes, "quantum_noise": "off"}))
    found = exposed(balls, EVERYTHING.model_copy(update={**changes, "quantum_noise": noise}))
    # Variance over mean is E[g²]/(E[g] A_S) of one photon: for this beam, hardened behind the
    # balls, between 50/0.9 and 75/0.9 keV.
    off = found.signal - expected.signal
    assert abs(off.mean()) < 4.5 * off.std() / np.sqrt(off.size)
    assert 50 / 0.9 < (off**2 / expected.signal).mean() < 75 / 0.9
