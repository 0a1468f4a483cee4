"""What a file says of the radiograph it holds, as plain JSON values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from phantom.document.identity import identity

if TYPE_CHECKING:
    from phantom.imaging.result import Radiograph

UNITS: Final = {
    "length": "mm",
    "angle": "degree",
    "energy": "keV",
    "attenuation": "1/mm",
    "path_lengths": "mm",
    "line_integral": "1",
    "transmission": "1",
    "signal": "1",
}
"""Unit of every number in the metadata and of every quantity; ``1`` is a pure number.

The signal's is that of what the detector reads where there is an acquisition."""

AXES: Final = "LPS: +x patient left, +y back, +z head; pixel centres at whole numbers"


def metadata(radiograph: Radiograph) -> dict[str, Any]:
    """Return the metadata of a radiograph; every value survives ``json.dumps``."""
    view = radiograph.view
    magnified = radiograph.pitch_at_isocentre_mm
    return {
        **identity(radiograph.phantom.document),
        "units": {**UNITS, "signal": radiograph.signal_unit},
        "axes": AXES,
        "view": view.model_dump(mode="json"),
        "beam": radiograph.beam.model_dump(mode="json", exclude_none=True),
        **_exposure(radiograph),
        "projection_matrix": radiograph.projection_matrix.tolist(),
        "intrinsics": radiograph.intrinsics.tolist(),
        "rotation": radiograph.rotation.tolist(),
        "translation_mm": radiograph.translation.tolist(),
        "isocentre_mm": [float(x) for x in radiograph.phantom.isocentre],
        "magnification": radiograph.magnification,
        "pitch_mm": list(view.detector.pitch_xy_mm),
        "pitch_at_isocentre_mm": None if magnified is None else list(magnified),
        "truncated": list(radiograph.truncated),
        "stages": list(radiograph.stages),
        "warnings": list(radiograph.warnings),
    }


def _exposure(radiograph: Radiograph) -> dict[str, Any]:
    """Return what is said of dose, detector and noise; nothing of an ideal image."""
    acquisition, exposed = radiograph.acquisition, radiograph.exposed
    if acquisition is None or exposed is None:
        return {}
    told: dict[str, Any] = {
        "acquisition": acquisition.model_dump(mode="json"),
        "exposure": {
            "detector_air_kerma_ugy": exposed.detector_air_kerma_ugy,
            "exposure_index": exposed.exposure_index,
            "bucky_factor": exposed.bucky_factor,
            "open_field": exposed.open_field,
        },
    }
    if acquisition.draws:
        told["noise"] = radiograph.noise.model_dump(mode="json")
    return told
