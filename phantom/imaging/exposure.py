"""X-raying a phantom: the whole run, from rays to the result."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from phantom.imaging.beam import Beam, Response, attenuations_per_mm, depends_on_energy
from phantom.imaging.camera import box_corners, projection
from phantom.imaging.result import Radiograph, sealed
from phantom.imaging.truncation import truncated
from phantom.imaging.view import View

if TYPE_CHECKING:
    from phantom.scene import Phantom


def radiograph(
    phantom: Phantom,
    view: View,
    beam: Beam | None = None,
    *,
    response: Response = "energy_integrating",
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Radiograph:
    """X-ray a phantom.

    Parameters
    ----------
    phantom, view, beam
        What, from where, and with what; the default beam has 60 keV.
    response
        What a photon adds to the signal: its energy, or one; see `Radiograph`.
    workers
        Threads; the result does not depend on their number.
    cancelled
        Asked now and then; when it turns true the trace stops.
    progress
        Told now and then how many rows are done, and of how many.

    Raises
    ------
    CancelledError
        ``cancelled`` turned true.
    """
    from phantom.tracing import raster

    beam = beam if beam is not None else Beam()
    materials = phantom.document.materials
    spectrum = beam.imaging_spectrum(materials)
    energies = beam.energy_kev if beam.energy_kev is not None else spectrum.energies_kev
    attenuation = attenuations_per_mm(materials, energies)
    detector = view.detector
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    path_lengths = raster(
        phantom,
        source=None if view.source is None else np.asarray(view.source, dtype=np.float64),
        direction=None if view.direction is None else np.asarray(view.direction, dtype=np.float64),
        first_pixel=detector.pixel(0, 0),
        column_step=pitch_x * right,
        row_step=pitch_y * down,
        columns=detector.columns,
        rows=detector.rows,
        workers=workers,
        cancelled=cancelled,
        progress=progress,
    )
    return Radiograph(
        phantom=phantom,
        view=view,
        beam=beam,
        path_lengths=sealed(path_lengths),
        spectrum=spectrum,
        attenuation_per_mm=sealed(attenuation),
        response=response,
        truncated=truncated(phantom, view, projection(view)),
        warnings=tuple(_warnings(phantom, view, beam)),
    )


def _warnings(phantom: Phantom, view: View, beam: Beam) -> list[str]:
    found = list(phantom.warnings)
    if not depends_on_energy(phantom.document.materials):
        asked = {name: getattr(beam, name) for name in ("energy_kev", "kvp")}
        words = {"energy_kev": "energy of {:g} keV", "kvp": "tube voltage of {:g} kV"}
        found += [
            f"the {words[name].format(value)} has no effect: every material has a fixed attenuation"
            for name, value in asked.items()
            if value is not None and name in beam.model_fields_set
        ]
    if view.source is not None:
        bounds = np.asarray(phantom.bounds)
        if np.all((bounds[0] < view.source) & (bounds[1] > view.source)):
            found.append("the source lies within the phantom's bounding box")
    depth = projection(view).depth_mm(box_corners(phantom.bounds))
    limit = projection(view).distance_mm
    if float(depth.max()) > (limit if limit is not None else 0.0):
        found.append("part of the phantom's bounding box lies behind the detector and is not seen")
    return found
