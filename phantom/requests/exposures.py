"""The acquisition of a request: what it costs, and how it is told in flat words."""

from __future__ import annotations

from collections.abc import Mapping

from phantom.document.substances import Material
from phantom.imaging import Acquisition, Beam, Detector, NoiseKey
from phantom.imaging.detection.acquisition import AIR_KERMA_UGY
from phantom.requests.limits import Limits


def check_cost(
    acquisition: Acquisition | None,
    detector: Detector,
    beam: Beam,
    materials: Mapping[str, Material],
    limits: Limits,
    images: int = 1,
) -> None:
    """Refuse an exposure that costs more than the limits allow.

    Raises
    ------
    InvalidInputError
        Too many rays, or too much memory (``/acquisition``).
    """
    if acquisition is None:
        return
    across, down = acquisition.samples_per_pixel
    spot = acquisition.focal_spot
    points = 1 if spot is None else spot.points[0] * spot.points[1]
    bins = 0
    if acquisition.quantum_noise == "per_bin":
        # Scattered photons have bins of their own.
        sets = 1 if acquisition.scatter is None else 2
        bins = sets * len(beam.imaging_spectrum(materials).energies_kev)
    limits.check_exposure(
        detector.columns, detector.rows, len(materials), across * down, points, bins, images
    )


def words_of(acquisition: Acquisition | None, noise: NoiseKey) -> dict[str, object]:
    """Return the words of an acquisition as it came out; an ideal image has none."""
    if acquisition is None:
        return {}
    told: dict[str, object] = {"mas": acquisition.mas}
    if acquisition.mas is None:
        asked = acquisition.detector_air_kerma_ugy
        told = {"dose_ugy": AIR_KERMA_UGY if asked is None else asked}
    told["quantum_noise"] = acquisition.quantum_noise
    if acquisition.draws:
        told |= {"seed": noise.seed, "case": noise.case}
    return told
