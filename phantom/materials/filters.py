"""What a filter in a beam may be made of: the reference materials, and some elements by name.

Densities of the elements: NISTIR 5632, table 1 (doi:10.18434/T4D01F).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from phantom.errors import InvalidInputError, Problem
from phantom.materials.reference import REFERENCE_NAMES, reference


@dataclass(frozen=True, slots=True)
class Substance:
    """Mass fractions of the elements, and a mass density in g/cm³."""

    composition: Mapping[str, float]
    density_g_cm3: float


# fmt: off
_ELEMENTS: Final[dict[str, tuple[str, float]]] = {
    "beryllium": ("Be", 1.848), "carbon": ("C", 1.700), "iron": ("Fe", 7.874),
    "nickel": ("Ni", 8.902), "copper": ("Cu", 8.960), "zinc": ("Zn", 7.133),
    "niobium": ("Nb", 8.570), "molybdenum": ("Mo", 10.22), "rhodium": ("Rh", 12.41),
    "palladium": ("Pd", 12.02), "silver": ("Ag", 10.50), "tin": ("Sn", 7.310),
    "gadolinium": ("Gd", 7.900), "erbium": ("Er", 9.066), "tantalum": ("Ta", 16.65),
    "tungsten": ("W", 19.30), "gold": ("Au", 19.32), "lead": ("Pb", 11.35),
}
# fmt: on

FILTER_NAMES: Final[tuple[str, ...]] = (*REFERENCE_NAMES, *_ELEMENTS)
"""Every name that a filter may have."""


def filter_substance(name: str) -> Substance:
    """Return what a filter of that name is made of.

    Raises
    ------
    InvalidInputError
        It is neither a reference material nor one of the elements; the known ones are listed.
    """
    if name in _ELEMENTS:
        symbol, density = _ELEMENTS[name]
        return Substance({symbol: 1.0}, density)
    if name not in REFERENCE_NAMES:
        message = f"found {name[:60]!r}; expected one of {', '.join(FILTER_NAMES)}"
        raise InvalidInputError([Problem("/beam/filtration_mm", "unknown_material", message)])
    named = reference(name)
    return Substance(named.composition, named.density_g_cm3)
