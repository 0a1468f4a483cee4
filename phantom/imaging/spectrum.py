"""The photons of a beam by energy, and the quantities that name its quality.

Half-value layers are of air kerma, as IEC 61267 and IEC 60601-1-3 have them: a photon of energy E
counts E · (μ_en/ρ)_air(E), and the layer is that behind which half of the sum is left in a narrow
beam.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.materials import air_absorption_cm2_g, attenuation_curve_per_mm, filter_substance

FloatArray = NDArray[np.float64]

UGY_PER_KEV_PER_G: Final = 1.602176634e-7
"""1 keV/g in µGy."""

_MM2_PER_CM2: Final = 100.0
_HALVINGS: Final = 200


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Photons by energy, in bins.

    Attributes
    ----------
    energies_kev
        (K,) middle of each bin, rising; a line of the anode is a bin of no width.
    photons_per_mm2_mas_at_1m
        (K,) photons of each bin per mm² and mAs at 1 m from the focal spot, in vacuum, where the
        spectrum is a tube's; else shares that add up to 1.
    widths_kev
        (K,) widths of the bins; within a bin the photons are spread evenly.
    absolute
        Whether the photons are those of a tube, counted, and not shares.
    """

    energies_kev: FloatArray
    photons_per_mm2_mas_at_1m: FloatArray
    widths_kev: FloatArray
    absolute: bool

    @property
    def shares(self) -> FloatArray:
        """(K,) share of each bin in all photons; they add up to 1."""
        whole = float(self.photons_per_mm2_mas_at_1m.sum())
        return self.photons_per_mm2_mas_at_1m / whole

    @property
    def mean_energy_kev(self) -> float:
        """Mean energy of a photon."""
        return float(self.shares @ self.energies_kev)

    @property
    def air_kerma_ugy_by_bin(self) -> FloatArray:
        """(K,) air kerma of each bin per mAs at 1 m in µGy; for shares, of 1 photon per mm²."""
        per_photon = self.energies_kev * air_absorption_cm2_g(self.energies_kev)
        return self.photons_per_mm2_mas_at_1m * per_photon * (_MM2_PER_CM2 * UGY_PER_KEV_PER_G)

    @property
    def air_kerma_ugy_per_mas_at_1m(self) -> float:
        """Air kerma per mAs at 1 m from the focal spot; for shares, of 1 photon per mm²."""
        return float(self.air_kerma_ugy_by_bin.sum())

    def behind(self, material: str, thickness_mm: float) -> Spectrum:
        """Return what is left of it in a narrow beam behind a filter.

        Parameters
        ----------
        material
            A reference material or an element; see :func:`phantom.materials.filter_substance`.
        thickness_mm
            How much of it.
        """
        left = np.exp(-thickness_mm * self.attenuations_per_mm(material))
        return self._with(self.photons_per_mm2_mas_at_1m * left)

    def attenuations_per_mm(self, material: str) -> FloatArray:
        """Return the (K,) attenuation of a filter's material at the bins' energies, in 1/mm."""
        substance = filter_substance(material)
        return attenuation_curve_per_mm(
            substance.composition, substance.density_g_cm3, self.energies_kev
        )

    def cut_at(self, energies_kev: FloatArray) -> Spectrum:
        """Return it with no bin that has one of these energies, K-edges say, inside it."""
        middles, photons, widths = [], [], []
        for middle, count, width in zip(
            self.energies_kev.tolist(),
            self.photons_per_mm2_mas_at_1m.tolist(),
            self.widths_kev.tolist(),
            strict=True,
        ):
            low, high = middle - width / 2, middle + width / 2
            inner = sorted({float(e) for e in energies_kev if low < e < high})
            for start, end in zip([low, *inner], [*inner, high], strict=True):
                middles.append((start + end) / 2 if inner else middle)
                widths.append(end - start if inner else width)
                photons.append(count * (end - start) / width if inner else count)
        return Spectrum(np.array(middles), np.array(photons), np.array(widths), self.absolute)

    def grouped(self, width_kev: float, edges_kev: FloatArray) -> Spectrum:
        """Return it with the bins of each cell put together, at their photons' mean energy.

        Cells are ``width_kev`` wide, from 0 on, and are cut at the energies ``edges_kev``. Cells
        without photons are left out. Photons and energy are kept, and so is whatever varies in a
        straight line within a cell.
        """
        cell = np.floor(self.energies_kev / width_kev).astype(int)
        side = np.searchsorted(np.sort(edges_kev), self.energies_kev)
        _, group = np.unique(np.stack([cell, side]), axis=1, return_inverse=True)
        parts = (
            self.photons_per_mm2_mas_at_1m,
            self.photons_per_mm2_mas_at_1m * self.energies_kev,
            self.widths_kev,
        )
        photons, energy, widths = (
            np.bincount(group.ravel(), part).astype(np.float64) for part in parts
        )
        held = photons > 0
        return Spectrum(
            energy[held] / photons[held], photons[held], widths[held], absolute=self.absolute
        )

    def without_traces(self, share: float) -> Spectrum:
        """Return it without the softest bins that together hold less than this share of photons."""
        kept = np.cumsum(self.shares) >= share
        return Spectrum(
            self.energies_kev[kept],
            self.photons_per_mm2_mas_at_1m[kept],
            self.widths_kev[kept],
            absolute=self.absolute,
        )

    def half_value_layer_mm(self, material: str = "aluminium") -> float:
        """Return the first half-value layer of air kerma, in mm."""
        return self.transmitting_layer_mm(0.5, material)

    def second_half_value_layer_mm(self, material: str = "aluminium") -> float:
        """Return what halves the air kerma once more behind the first half-value layer, in mm."""
        return self.transmitting_layer_mm(0.25, material) - self.half_value_layer_mm(material)

    def homogeneity(self, material: str = "aluminium") -> float:
        """Return the first half-value layer over the second; 1 for a single energy."""
        return self.half_value_layer_mm(material) / self.second_half_value_layer_mm(material)

    def transmitting_layer_mm(self, fraction: float, material: str = "aluminium") -> float:
        """Return the thickness behind which this fraction of the air kerma is left, in mm."""
        kerma = self.air_kerma_ugy_by_bin
        attenuation = self.attenuations_per_mm(material)
        wanted = fraction * float(kerma.sum())
        # Of a sum of falling exponentials the layer lies between those of its extreme terms.
        low = -math.log(fraction) / float(attenuation.max())
        high = -math.log(fraction) / float(attenuation.min())
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            if float(kerma @ np.exp(-attenuation * middle)) > wanted:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)

    def _with(self, photons: FloatArray) -> Spectrum:
        """Return it with other photons; shares add up to 1 again."""
        whole = 1.0 if self.absolute else float(photons.sum())
        return Spectrum(self.energies_kev, photons / whole, self.widths_kev, self.absolute)


def monochromatic(energy_kev: float) -> Spectrum:
    """Return the spectrum of a single energy."""
    return relative(np.array([energy_kev]), np.ones(1))


def relative(energies_kev: FloatArray, weights: FloatArray) -> Spectrum:
    """Return a spectrum of single energies, rising, with these weights."""
    energies, shares = np.array(energies_kev, float), np.array(weights, float)
    return Spectrum(energies, shares / shares.sum(), np.zeros(len(energies)), absolute=False)
