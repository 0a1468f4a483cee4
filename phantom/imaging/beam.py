"""The beam, and what it sees of each material.

Monochromatic: one photon energy, one linear attenuation coefficient a material.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar

import numpy as np
from pydantic import field_validator

from phantom.document.base import Number, refuse, told
from phantom.document.substances import (
    CompositionMaterial,
    FixedMaterial,
    Material,
    ReferenceMaterial,
)
from phantom.imaging.asked import Asked
from phantom.imaging.view import FloatArray
from phantom.materials import attenuation_per_mm, check_energy, reference


class Beam(Asked):
    """A beam of photons of one energy."""

    place: ClassVar[str] = "/beam"

    energy_kev: Annotated[
        Number, told("Energy", "keV", "Photon energy; a fixed attenuation holds at any.")
    ] = 60.0

    @field_validator("energy_kev")
    @classmethod
    def _is_served(cls, energy_kev: float) -> float:
        for problem in check_energy(energy_kev):
            refuse(problem.kind, ((), problem.message))
        return energy_kev


def material_attenuation_per_mm(material: Material, energy_kev: float) -> float:
    """Return the linear attenuation coefficient of a document's material, in 1/mm."""
    match material:
        case FixedMaterial():
            return material.attenuation_per_mm
        case ReferenceMaterial():
            named = reference(material.reference)
            density = material.density_g_cm3
            if density is None:
                density = named.density_g_cm3
            return attenuation_per_mm(named.composition, density, energy_kev)
        case CompositionMaterial():
            return attenuation_per_mm(material.composition, material.density_g_cm3, energy_kev)


def attenuations_per_mm(materials: Mapping[str, Material], energy_kev: float) -> FloatArray:
    """Return the (M,) coefficients of a document's materials, in their order, in 1/mm."""
    values = [material_attenuation_per_mm(m, energy_kev) for m in materials.values()]
    return np.array(values, dtype=np.float64)


def depends_on_energy(materials: Mapping[str, Material]) -> bool:
    """Tell whether any material has another coefficient at another energy."""
    return any(not isinstance(material, FixedMaterial) for material in materials.values())
