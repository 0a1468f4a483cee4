"""From dose to photons: air kerma, the tube's output and the exposure index."""

from __future__ import annotations

from typing import Final

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.detection.acquisition import AIR_KERMA_UGY, Acquisition
from phantom.imaging.spectrum import UGY_PER_KEV_PER_G, Spectrum
from phantom.imaging.view import FloatArray
from phantom.materials import air_absorption_cm2_g

INDEX_PER_UGY: Final = 100.0
"""Exposure index of 1 µGy: IEC 62494-1 (2008), clause 4.2, c0 = 100 per µGy."""

UGY_MM2_PER_KEV_CM2_G: Final = UGY_PER_KEV_PER_G * 100.0
"""Air kerma in µGy of 1 photon per mm² of 1 keV where μ_en/ρ is 1 cm²/g."""

_METRE_MM: Final = 1000.0


def photons_per_mm2(
    spectrum: Spectrum, acquisition: Acquisition, source_detector_mm: float | None
) -> FloatArray:
    """Return (K,) photons per mm² at the detector's centre, open field, across the ray.

    Parameters
    ----------
    spectrum, acquisition
        What the tube gives, and how much of it.
    source_detector_mm
        From the source to the detector's centre; None for a parallel beam.

    Raises
    ------
    InvalidInputError
        A tube load with a parallel beam, or with a spectrum that has no output.
    """
    photons = spectrum.photons_per_mm2_mas_at_1m
    if acquisition.mas is None:
        asked = acquisition.detector_air_kerma_ugy
        return photons * (
            (AIR_KERMA_UGY if asked is None else asked) / kerma_ugy(spectrum, photons)
        )
    for missing, what in (
        (source_detector_mm is None, "with a parallel beam"),
        (not spectrum.absolute, "with a beam that has no tube"),
    ):
        if missing:
            message = f"found a tube load {what}; expected detector_air_kerma_ugy"
            raise InvalidInputError([Problem("/acquisition/mas", "contradiction", message)])
    assert source_detector_mm is not None
    return photons * (acquisition.mas * (_METRE_MM / source_detector_mm) ** 2)


def kerma_ugy(spectrum: Spectrum, photons_per_mm2: FloatArray) -> float:
    """Return the air kerma, in µGy, of (K,) photons per mm² with the energies of a spectrum.

    ``E μ_en/ρ`` of dry air: the energy-absorption coefficient stands for the energy-transfer one,
    from which it differs by the bremsstrahlung of the electrons, less than 0.1 % below 150 keV.
    """
    per_photon = UGY_MM2_PER_KEV_CM2_G * spectrum.energies_kev
    return float((per_photon * air_absorption_cm2_g(spectrum.energies_kev)) @ photons_per_mm2)
