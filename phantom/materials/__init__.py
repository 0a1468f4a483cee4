"""Attenuation of matter: the elements, the reference table and the coefficient at one energy."""

from phantom.materials.absorption import air_absorption_cm2_g
from phantom.materials.attenuation import (
    ENERGY_LIMITS_KEV,
    attenuation_curve_per_mm,
    attenuation_per_mm,
    check_energy,
    k_edges_kev,
)
from phantom.materials.elements import ATOMIC_NUMBERS, ELEMENTS
from phantom.materials.filters import FILTER_NAMES, Substance, filter_substance
from phantom.materials.reference import REFERENCE_NAMES, ReferenceTissue, reference

__all__ = [
    "ATOMIC_NUMBERS",
    "ELEMENTS",
    "ENERGY_LIMITS_KEV",
    "FILTER_NAMES",
    "REFERENCE_NAMES",
    "ReferenceTissue",
    "Substance",
    "air_absorption_cm2_g",
    "attenuation_curve_per_mm",
    "attenuation_per_mm",
    "check_energy",
    "filter_substance",
    "k_edges_kev",
    "reference",
]
