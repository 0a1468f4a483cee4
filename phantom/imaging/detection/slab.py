"""Radiation scattered in a slab of water, over what passes it unscattered.

A pencil beam of unit intensity crosses a slab of thickness T that is wide without end; photons
that leave the far side are counted in a plane behind it, a gap away.

**Scattered once**: an integral. With t the depth below the far side, θ the angle of scattering, μ
and μ′ the attenuation before and after it, and σ(θ) the differential cross section per unit length
(Compton with the incoherent scattering function, and Rayleigh with the form factor)::

    h(r) = (1/r) ∫ σ(θ) cos θ exp(μ t − μ′ t / cos θ) dθ,      t = r / tan θ − gap
    A(T) = ∫ h dA = 2π ∫ σ(θ) sin θ (1 − exp(−c T)) / c dθ,     c = μ′ / cos θ − μ

This is the model of J. M. Boone and J. A. Seibert, *An analytical model of the scattered radiation
distribution in diagnostic radiology*, Med. Phys. 15 (1988) 721-725.

**Scattered more than once**: no closed form; the table of ``multiple.py``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from phantom.imaging.detection.multiple import multiple
from phantom.imaging.view import FloatArray
from phantom.materials import ATOMIC_NUMBERS, attenuation_per_mm, reference

_ANGLES: Final = 96
_CM_PER_MM: Final = 0.1
_KEV_ANGSTROM: Final = 12.398419843  # h c


@dataclass(frozen=True, eq=False)
class Water:
    """Cross sections of water at one energy, at the angles of a Gauss-Legendre rule.

    Attributes
    ----------
    energy_kev, attenuation_per_mm, scattering_per_mm
        The photon's energy, and the total and the scattering coefficient.
    angles, weights
        (A,) radians within 0 … π/2, and the rule's weights.
    kinds
        For Compton and for Rayleigh: (A,) cross section per mm and steradian, and (A,) attenuation
        per mm after scattering by that angle, and (A,) the energy that is left, in keV.
    """

    energy_kev: float
    attenuation_per_mm: float
    scattering_per_mm: float
    angles: FloatArray
    weights: FloatArray
    kinds: tuple[tuple[FloatArray, FloatArray, FloatArray], ...]


@lru_cache(maxsize=512)
def water(energy_kev: float) -> Water:
    """Return the cross sections of water at an energy."""
    import xraylib

    composition = reference("water").composition
    density = reference("water").density_g_cm3
    parts = [(ATOMIC_NUMBERS[s], f * density * _CM_PER_MM) for s, f in composition.items()]
    nodes, weights = np.polynomial.legendre.leggauss(_ANGLES)
    # Rayleigh scattering is peaked forwards: nodes crowd at small angles.
    angles = (nodes + 1) ** 2 / 4 * (math.pi / 2)
    weights = weights * (nodes + 1) / 2 * (math.pi / 2)
    before = attenuation_per_mm(composition, density, energy_kev)
    # The tables of the incoherent scattering function begin at q = 0.001 per ångström, where it has
    # all but vanished.
    first = 2 * math.asin(min(1.0, 1.001e-3 * _KEV_ANGSTROM / energy_kev))
    tabled = np.maximum(angles, first).tolist()
    kinds = []
    for cross_section, loses in ((xraylib.DCS_Compt, True), (xraylib.DCS_Rayl, False)):
        sigma = [sum(f * cross_section(z, energy_kev, a) for z, f in parts) for a in tabled]
        left = [xraylib.ComptonEnergy(energy_kev, a) if loses else energy_kev for a in tabled]
        after = [attenuation_per_mm(composition, density, e) if loses else before for e in left]
        kinds.append((np.array(sigma), np.array(after), np.array(left)))
    scattering = sum(
        f * (xraylib.CS_Compt(z, energy_kev) + xraylib.CS_Rayl(z, energy_kev)) for z, f in parts
    )
    return Water(energy_kev, before, float(scattering), angles, weights, tuple(kinds))


def single(energy_kev: float, thickness_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return photons scattered once over unscattered ones, and their mean energy in keV.

    Both have the shape of ``thickness_mm``; the energy is that of the photon where there are none.
    """
    matter = water(energy_kev)
    depth = np.asarray(thickness_mm, dtype=np.float64)[..., None]
    ring = 2 * math.pi * np.sin(matter.angles) * matter.weights
    number = np.zeros(depth.shape[:-1])
    energy = np.zeros(depth.shape[:-1])
    for sigma, after, left in matter.kinds:
        c = after / np.cos(matter.angles) - matter.attenuation_per_mm
        # c vanishes forwards: (1 − exp(−cT))/c is then T.
        reach = np.where(c * depth > 1e-9, -np.expm1(-c * depth) / np.maximum(c, 1e-300), depth)
        each = ring * sigma * reach
        number += each.sum(axis=-1)
        energy += (each * left).sum(axis=-1)
    return number, np.where(number > 0, energy / np.maximum(number, 1e-300), energy_kev)


def single_profile(
    energy_kev: float, thickness_mm: float, gap_mm: float, radii_mm: FloatArray
) -> FloatArray:
    """Return (R,) photons scattered once per mm² over the unscattered ones, at radii above 0."""
    matter = water(energy_kev)
    r = np.asarray(radii_mm, dtype=np.float64)[:, None]
    least, most = np.arctan2(r, gap_mm + thickness_mm), np.arctan2(r, gap_mm)
    nodes, weights = np.polynomial.legendre.leggauss(_ANGLES)
    angle = least + (nodes + 1) / 2 * (most - least)
    t = np.maximum(r / np.tan(angle) - gap_mm, 0.0)
    out = np.zeros(len(r))
    for sigma, after, _ in matter.kinds:
        sigma_here = np.interp(angle, matter.angles, sigma)
        after_here = np.interp(angle, matter.angles, after)
        passed = np.exp(t * (matter.attenuation_per_mm - after_here / np.cos(angle)))
        inner = sigma_here * np.cos(angle) * passed
        out += (inner @ weights) * ((most - least)[:, 0] / 2) / r[:, 0]
    return out


def amounts(energy_kev: float, thickness_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return scattered photons over unscattered ones, and their mean energy in keV.

    Returns
    -------
    Two (T, 2) arrays: scattered once, and more than once.
    """
    number, left = single(energy_kev, thickness_mm)
    more = multiple(energy_kev, thickness_mm)
    return (
        np.stack([number, number * more.ratio], axis=-1),
        np.stack([left, energy_kev * more.energy], axis=-1),
    )


def kernel_per_mm2(
    energy_kev: float, thickness_mm: float, gap_mm: float, radii_mm: FloatArray, order: int
) -> FloatArray:
    """Return (R,) where scattered photons arrive, per mm² and adding to one over the plane.

    ``order`` 0 is scattered once; 1, more often: ``2 / (π a²) (1 + r²/a²)⁻³``.
    """
    if order == 0:
        whole, _ = single(energy_kev, np.array([thickness_mm]))
        return single_profile(energy_kev, thickness_mm, gap_mm, radii_mm) / float(whole[0])
    more = multiple(energy_kev, np.array([thickness_mm]))
    a = float(more.width_mm[0] + more.widening[0] * gap_mm)
    return 2 / (math.pi * a * a) * (1 + (np.asarray(radii_mm) / a) ** 2) ** -3
