"""What the absorbing layer makes of a photon of each energy.

A photon is stopped with probability ``η = 1 − exp(−(μ_photo + μ_incoherent)/ρ · thickness)``: a
photon scattered coherently goes on almost as before. A stopped photon leaves all of its energy on
average; that some is lost with characteristic radiation is only in the Swank factor (R. K. Swank,
J. Appl. Phys. 44 (1973) 4199-4203, doi:10.1063/1.1662918), which spreads the signal of one photon:
``A_S = ⟨g⟩² / ⟨g²⟩``. Rays are taken to cross the layer straight.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from phantom.imaging.detection.receptor import ABSORBERS, DetectorModel
from phantom.imaging.view import FloatArray
from phantom.materials import ATOMIC_NUMBERS


@dataclass(frozen=True, eq=False)
class PhotonResponse:
    """What a detector gives for a photon of each energy.

    Attributes
    ----------
    stopped
        (K,) probability that a photon is stopped.
    gain
        (K,) mean signal of a stopped photon.
    excess
        Variance of that signal over its squared mean: 1/A_S − 1.
    """

    stopped: FloatArray
    gain: FloatArray
    excess: float

    @property
    def weights(self) -> FloatArray:
        """(K, 3): stopped photons, their signal and their mean squared signal, a photon."""
        stopped, gain = self.stopped, self.gain
        return np.stack([stopped, stopped * gain, stopped * gain**2 * (1 + self.excess)], axis=1)

    def joined(self, other: PhotonResponse) -> PhotonResponse:
        """Return the response of these bins and, after them, of another's."""
        return PhotonResponse(
            np.concatenate([self.stopped, other.stopped]),
            np.concatenate([self.gain, other.gain]),
            self.excess,
        )


def stopped_fraction(detector: DetectorModel, energies_kev: FloatArray) -> FloatArray:
    """Return (K,) probability that the absorber stops a photon; 1 without an absorber."""
    absorber = detector.absorber
    if absorber is None:
        return np.ones(len(energies_kev))
    import xraylib

    composition = ABSORBERS[absorber.material]
    interaction_cm2_g = [
        math.fsum(
            fraction * (xraylib.CS_Photo(z, float(e)) + xraylib.CS_Compt(z, float(e)))
            for z, fraction in ((ATOMIC_NUMBERS[s], f) for s, f in composition.items())
        )
        for e in energies_kev
    ]
    depth: FloatArray = np.array(interaction_cm2_g) * (absorber.thickness_mg_cm2 / 1000)
    return -np.expm1(-depth)


def response(detector: DetectorModel, energies_kev: FloatArray) -> PhotonResponse:
    """Return what the detector gives for photons of these energies, in keV."""
    counts = detector.response == "photon_counting"
    gain = np.ones(len(energies_kev)) if counts else detector.gain_per_kev * energies_kev
    return PhotonResponse(
        stopped=stopped_fraction(detector, energies_kev),
        gain=gain,
        excess=1 / detector.swank_factor - 1,
    )
