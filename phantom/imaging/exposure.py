"""X-raying a phantom: the whole run, from rays to the result."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from phantom.geometry.vectors import box_corners
from phantom.imaging.beam import Beam, attenuations_per_mm, depends_on_energy
from phantom.imaging.beer import band_transmission
from phantom.imaging.camera import projection
from phantom.imaging.detection import (
    Acquisition,
    DetectorModel,
    Exposed,
    NoiseKey,
    air_gap_mm,
    expose,
)
from phantom.imaging.refusals import check_exposure
from phantom.imaging.result import Radiograph, sealed, signal_weights
from phantom.imaging.spectrum import Spectrum
from phantom.imaging.traces import Traces
from phantom.imaging.view import FloatArray, View

if TYPE_CHECKING:
    from phantom.scene import Phantom


def radiograph(
    phantom: Phantom,
    view: View,
    beam: Beam | None = None,
    *,
    acquisition: Acquisition | None = None,
    noise: NoiseKey | None = None,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
    keep_path_lengths: bool | None = None,
) -> Radiograph:
    """X-ray a phantom.

    Parameters
    ----------
    phantom, view, beam
        What, from where, and with what; the default beam has 60 keV.
    acquisition
        Dose, focal spot, scatter, grid, samples of a pixel, noise and detector. Without one the
        image is ideal: the signal is the transmission.
    noise
        Whose noise; the same key gives the same image. By default every number of it is 0.
    workers
        Threads; the result does not depend on their number.
    cancelled
        Asked now and then; when it turns true the trace stops.
    progress
        Told now and then how many rows of rays are done, and of how many.
    keep_path_lengths
        Whether to hold path lengths, which take as many images of memory as there are materials.
        True for one who will ask for them or for line integrals; by default they are kept only
        where a detector's model needs them all at once. What was not kept is traced once more when
        it is asked for. No number of the result depends on it.

    Raises
    ------
    InvalidInputError
        What has no image; see :func:`phantom.imaging.refusals.check_exposure`.
    CancelledError
        ``cancelled`` turned true.
    """
    beam = beam if beam is not None else Beam()
    check_exposure(phantom, view, beam, acquisition)
    materials = phantom.document.materials
    spectrum = beam.imaging_spectrum(materials)
    energies = beam.energy_kev if beam.energy_kev is not None else spectrum.energies_kev
    attenuation = attenuations_per_mm(materials, energies)
    rays = Traces(phantom, view, acquisition, workers, cancelled, progress)
    key = noise if noise is not None else NoiseKey()
    path_lengths, exposed, left = None, None, None
    if acquisition is None:
        left = np.empty((view.detector.rows, view.detector.columns))
        weights = signal_weights(spectrum, DetectorModel())

        def attenuate(first: int, lengths: FloatArray) -> None:
            band = left[first : first + lengths.shape[1]]
            band_transmission(lengths, attenuation, weights, band)

        if keep_path_lengths:
            path_lengths = rays.centres(attenuate)
        else:
            rays.centres_by_bands(attenuate)
    else:
        path_lengths = rays.centres()
        exposed = _exposed(rays, path_lengths, attenuation, spectrum, acquisition, key)
    return Radiograph(
        phantom=phantom,
        view=view,
        beam=beam,
        kept=None if path_lengths is None or keep_path_lengths is False else sealed(path_lengths),
        left=None if left is None else sealed(left),
        spectrum=spectrum,
        attenuation_per_mm=sealed(attenuation),
        acquisition=acquisition,
        noise=key,
        exposed=exposed,
        warnings=(
            *_warnings(phantom, view, beam, acquisition),
            *(() if exposed is None else exposed.warnings),
            *_idle_noise(acquisition, noise),
        ),
    )


def _exposed(
    rays: Traces,
    path_lengths: FloatArray,
    attenuation_per_mm: FloatArray,
    spectrum: Spectrum,
    acquisition: Acquisition,
    key: NoiseKey,
) -> Exposed:
    """Return what the detector makes of the rays."""
    exposed = expose(
        rays.samples(path_lengths),
        attenuation_per_mm=attenuation_per_mm,
        spectrum=spectrum,
        view=rays.view,
        acquisition=acquisition,
        key=key,
        field_path_lengths=rays.field(),
        default_gap_mm=air_gap_mm(rays.view, rays.phantom.bounds),
        workers=rays.workers,
        cancelled=rays.cancelled,
    )
    sealed(exposed.signal)
    return exposed


def _idle_noise(acquisition: Acquisition | None, noise: NoiseKey | None) -> list[str]:
    """Return the warning of a key from which nothing is drawn."""
    if noise is None or (acquisition is not None and acquisition.draws):
        return []
    return ["the seed has no effect: no acquisition with noise is asked for"]


def _warnings(
    phantom: Phantom, view: View, beam: Beam, acquisition: Acquisition | None
) -> list[str]:
    found = list(phantom.warnings)
    if not depends_on_energy(phantom.document.materials):
        asked = {name: getattr(beam, name) for name in ("energy_kev", "kvp")}
        # A detector's photons still depend on it.
        idle = "has no effect" if acquisition is None else "has no effect on what comes through"
        words = {"energy_kev": "energy of {:g} keV", "kvp": "tube voltage of {:g} kV"}
        found += [
            f"the {words[name].format(value)} {idle}: every material has a fixed attenuation"
            for name, value in asked.items()
            if value is not None and name in beam.model_fields_set
        ]
    if view.source is not None:
        bounds = np.asarray(phantom.bounds)
        if np.all((bounds[0] < view.source) & (bounds[1] > view.source)):
            found.append("the source lies within the phantom's bounding box")
    camera = projection(view)
    depth, limit = camera.depth_mm(box_corners(phantom.bounds)), camera.distance_mm
    if float(depth.max()) > (limit if limit is not None else 0.0):
        found.append("part of the phantom's bounding box lies behind the detector and is not seen")
    return found
