"""What was applied on the way to the signal, with its values, as plain JSON values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from phantom.imaging.detection.acquisition import Acquisition
from phantom.imaging.detection.blur import mixture
from phantom.imaging.detection.draws import NoiseKey
from phantom.imaging.detection.falloff import source_detector_mm
from phantom.imaging.detection.kerma import INDEX_PER_UGY
from phantom.imaging.view import View

if TYPE_CHECKING:
    from phantom.imaging.detection.scatter import ScatterField


def stages(
    acquisition: Acquisition,
    view: View,
    key: NoiseKey,
    detector_air_kerma_ugy: float,
    field: ScatterField | None,
) -> tuple[dict[str, Any], ...]:
    """Return every stage that was applied, in order; what is off is not listed."""
    model = acquisition.detector
    listed: list[dict[str, Any]] = [
        {
            "stage": "exposure",
            "detector_air_kerma_ugy": detector_air_kerma_ugy,
            "mas": acquisition.mas,
            "exposure_index": INDEX_PER_UGY * detector_air_kerma_ugy,
        }
    ]
    if acquisition.falloff != "none":
        listed.append(
            {
                "stage": "falloff",
                "kind": acquisition.falloff,
                "source_detector_mm": source_detector_mm(view),
            }
        )
    if acquisition.focal_spot is not None and view.source is not None:
        listed.append({"stage": "focal_spot", **acquisition.focal_spot.model_dump(mode="json")})
    if acquisition.samples_per_pixel != (1, 1):
        listed.append(
            {"stage": "sampling", "samples_per_pixel": list(acquisition.samples_per_pixel)}
        )
    if field is not None and field.photons is not None:
        listed.append(
            {
                "stage": "scatter",
                "model": "water slab: single scattering, and a fit to more than one",
                "air_gap_mm": field.air_gap_mm,
                "scatter_to_primary": field.scatter_to_primary,
            }
        )
    if acquisition.grid is not None and field is not None:
        listed.append(
            {
                "stage": "grid",
                **acquisition.grid.model_dump(mode="json"),
                "bucky_factor": field.bucky_factor,
            }
        )
    if acquisition.quantum_noise != "off":
        listed.append(
            {
                "stage": "quantum_noise",
                "kind": acquisition.quantum_noise,
                "seed": key.seed,
                "case": key.case,
                "view": key.view,
                "eye": key.eye,
            }
        )
    listed.append(
        {
            "stage": "detector",
            "response": model.response,
            "absorber": None if model.absorber is None else model.absorber.model_dump(mode="json"),
            "gain_per_kev": model.gain_per_kev,
            "swank_factor": model.swank_factor,
        }
    )
    if model.blur is not None:
        listed.append(
            {
                "stage": "blur",
                **model.blur.model_dump(mode="json"),
                "gaussians": [{"weight": w, "sigma_mm": s} for w, s in mixture(model.blur)],
            }
        )
    if model.electronic_noise > 0:
        listed.append({"stage": "electronic_noise", "standard_deviation": model.electronic_noise})
    if acquisition.flat_field:
        listed.append({"stage": "flat_field", "divided_by": "falloff"})
    if model.digitizer is not None:
        listed.append({"stage": "digitizer", **model.digitizer.model_dump(mode="json")})
    return tuple(listed)


def without_effect(acquisition: Acquisition, view: View) -> tuple[str, ...]:
    """Return what was asked for and changes nothing, a sentence each."""
    found = []
    if view.source is None and acquisition.focal_spot is not None:
        found.append("the focal spot has no effect: a parallel beam has none")
    if acquisition.grid is not None and acquisition.scatter is None:
        found.append("the grid's scatter transmission has no effect: there is no scatter")
    return tuple(found)
