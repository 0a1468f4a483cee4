"""The whole chain from path lengths to what the detector hands out, in one order.

Source weight and falloff → primary in every bin → scatter and grid → Poisson → detector gain →
blur → electronic noise → flat field → saturation, gain and bits.

What the caller traces first::

    window = Window.whole(view.detector)        # or any part of it
    traced = traced_window(view, acquisition, window)
    rays = lattice(view.detector, traced, acquisition.samples_per_pixel)
    for weight, source in source_points(view, acquisition.focal_spot): ...trace `rays`...
    field = scatter_lattice(view.detector)      # only for scatter: trace it from view.source
    gap_mm = air_gap_mm(view, phantom.bounds)   # only for scatter
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from phantom.imaging.detection.acquisition import Acquisition
from phantom.imaging.detection.blur import blurred, halo
from phantom.imaging.detection.digitizer import digitize
from phantom.imaging.detection.draws import ELECTRONICS, NoiseKey, normal, uniforms
from phantom.imaging.detection.falloff import falloff, source_detector_mm
from phantom.imaging.detection.kerma import INDEX_PER_UGY, kerma_ugy, photons_per_mm2
from phantom.imaging.detection.primary import primary
from phantom.imaging.detection.quanta import compound, per_bin
from phantom.imaging.detection.scatter import ScatterField, interpolated, scatter_field
from phantom.imaging.detection.scintillator import response
from phantom.imaging.detection.stages import stages, without_effect
from phantom.imaging.detection.window import Window
from phantom.imaging.spectrum import Spectrum
from phantom.imaging.view import FloatArray, View


@dataclass(frozen=True, eq=False)
class Exposed:
    """What an exposure gives.

    Attributes
    ----------
    signal
        (rows, columns) of the window, in ``unit``.
    unit
        ``photons``, ``keV``, ``signal`` or ``codes``.
    open_field
        What a pixel at the detector's centre reads on average with nothing before it, in ``unit``.
    detector_air_kerma_ugy
        At the detector's centre in the open field, before any grid.
    exposure_index
        100 a µGy of that kerma (IEC 62494-1); the standard takes the kerma behind the patient.
    bucky_factor
        Radiation before the grid over radiation behind it, photons over the whole field (IEC 60627,
        1 / total transmission); None without a grid.
    stages
        Every stage that was applied, in order, with its values.
    warnings
        What was asked for and had no effect.
    """

    signal: FloatArray
    unit: str
    open_field: float
    detector_air_kerma_ugy: float
    exposure_index: float
    bucky_factor: float | None
    stages: tuple[dict[str, Any], ...]
    warnings: tuple[str, ...]


def traced_window(view: View, acquisition: Acquisition, window: Window) -> Window:
    """Return the window whose path lengths are needed: with room for the blur."""
    reach = halo(acquisition.detector.blur, view.detector.pitch_xy_mm)
    return window.grown(reach, view.detector)


def expose(
    traces: Iterable[tuple[float, FloatArray]],
    *,
    attenuation_per_mm: FloatArray,
    spectrum: Spectrum,
    view: View,
    acquisition: Acquisition,
    key: NoiseKey,
    window: Window | None = None,
    field_path_lengths: FloatArray | None = None,
    default_gap_mm: float = 0.0,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Exposed:
    """Expose a detector.

    A pixel's value does not depend on the window it is computed in, nor on ``workers``.

    Parameters
    ----------
    traces
        A weight and (rows · down, columns · across, M) mm for each of :func:`source_points`, over
        the samples of :func:`traced_window`; taken one after the other, so that a generator that
        traces needs the memory of one.
    attenuation_per_mm
        (K, M) at the spectrum's energies; (M,) for one energy.
    spectrum
        K bins.
    view, acquisition, key
        The geometry, the description of the exposure, and whose noise.
    window
        Which pixels are wanted; all of them by default.
    field_path_lengths
        For scatter alone: (rows, columns, M) mm over :func:`scatter_lattice`.
    default_gap_mm
        For scatter, where the acquisition does not say; see :func:`air_gap_mm`.
    workers, cancelled
        As in :func:`phantom.tracing.pool.run_bands`.

    Raises
    ------
    InvalidInputError
        A tube load with a parallel beam, or a blur that reaches too far.
    CancelledError
        ``cancelled`` said yes.
    """
    detector, model = view.detector, acquisition.detector
    wanted = window if window is not None else Window.whole(detector)
    traced = traced_window(view, acquisition, wanted)
    pitch = detector.pitch_xy_mm

    # The photons of the open field, through one pixel held across the ray at the middle.
    energies = spectrum.energies_kev
    attenuation = np.atleast_2d(attenuation_per_mm)
    fluence = photons_per_mm2(spectrum, acquisition, source_detector_mm(view))
    photons = fluence * (pitch[0] * pitch[1])
    kerma = kerma_ugy(spectrum, fluence)
    grid = acquisition.grid
    through = 1.0 if grid is None else grid.primary_transmission
    given = response(model, energies)
    bins = acquisition.quantum_noise == "per_bin"
    weights = np.diag(given.stopped) if bins else given.weights
    open_field = through * float(photons @ given.weights[:, 1])

    # What is expected: the primary of every source point, then scatter.
    expected = np.zeros((weights.shape[1], traced.rows, traced.columns))
    for weight, path_lengths in traces:
        expected += weight * primary(
            path_lengths,
            attenuation,
            (through * photons)[:, np.newaxis] * weights,
            acquisition.samples_per_pixel,
            workers=workers,
            cancelled=cancelled,
        )
    field: ScatterField | None = None
    if acquisition.scatter is not None or grid is not None:
        field = scatter_field(
            field_path_lengths, attenuation, energies, photons, acquisition, view, default_gap_mm
        )
    if field is not None and field.photons is not None:
        late = response(model, field.energies_kev)
        if bins:
            # Scattered photons have bins of their own, at the energies that are left to them.
            given = given.joined(late)
            scattered = interpolated(late.stopped[:, None, None] * field.photons, detector, traced)
            expected = np.concatenate([expected, scattered])
        else:
            sums = np.einsum("kj,krc->jrc", late.weights, field.photons)
            expected += interpolated(sums, detector, traced)
    expected *= falloff(view, traced, acquisition.falloff)

    # What is drawn, and what the detector makes of it.
    if acquisition.quantum_noise == "compound":
        signal = compound(expected, traced, key, workers=workers, cancelled=cancelled)
    elif bins:
        signal = per_bin(expected, given, traced, key, workers=workers, cancelled=cancelled)
    else:
        signal = expected[1]
    if model.blur is not None:
        signal = blurred(signal, model.blur, pitch, workers=workers, cancelled=cancelled)
    first_row, first_column = (
        wanted.first_row - traced.first_row,
        wanted.first_column - traced.first_column,
    )
    signal = signal[
        first_row : first_row + wanted.rows, first_column : first_column + wanted.columns
    ]
    if model.electronic_noise > 0:
        luck, _ = uniforms(key, ELECTRONICS, wanted.row_indices, wanted.column_indices)
        signal = signal + model.electronic_noise * normal(luck)
    if acquisition.flat_field:
        signal = signal / falloff(view, wanted, acquisition.falloff)
    if model.digitizer is not None:
        signal = digitize(signal, model.digitizer)
        open_field = float(digitize(np.array([open_field]), model.digitizer)[0])
    return Exposed(
        signal=np.ascontiguousarray(signal),
        unit="codes" if model.digitizer is not None else model.unit,
        open_field=open_field,
        detector_air_kerma_ugy=kerma,
        exposure_index=INDEX_PER_UGY * kerma,
        bucky_factor=None if field is None else field.bucky_factor,
        stages=stages(acquisition, view, key, kerma, field),
        warnings=without_effect(acquisition, view),
    )
