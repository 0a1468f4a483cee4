"""Attenuation of matter: the elements, the reference table and the coefficient at one energy."""

from phantom.materials.attenuation import (
    ENERGY_LIMITS_KEV,
    attenuation_per_mm,
    check_energy,
)
from phantom.materials.elements import ATOMIC_NUMBERS, ELEMENTS
from phantom.materials.reference import REFERENCE_NAMES, ReferenceTissue, reference

__all__ = [
    "ATOMIC_NUMBERS",
    "ELEMENTS",
    "ENERGY_LIMITS_KEV",
    "REFERENCE_NAMES",
    "ReferenceTissue",
    "attenuation_per_mm",
    "check_energy",
    "reference",
]
