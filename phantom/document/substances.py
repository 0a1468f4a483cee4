"""Materials of a document: a fixed attenuation, a reference tissue or a composition."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated, Any

from pydantic import BaseModel, Field, field_validator

from phantom.document.base import Choice, Fraction, Model, Name, Number, refuse, told
from phantom.materials import ELEMENTS, REFERENCE_NAMES, reference

FRACTION_SUM_TOLERANCE = 1e-3
"""How far the mass fractions of a composition may add up from 1 (tables are rounded to 0.001)."""

Density = Annotated[Number, Field(gt=0, le=100)]


class FixedMaterial(Model):
    """A linear attenuation coefficient that holds at any energy (the paper's density)."""

    attenuation_per_mm: Annotated[
        Number,
        told("Attenuation", "1/mm", "Linear attenuation coefficient at any energy.", ge=0, le=1e6),
    ]


class ReferenceMaterial(Model):
    """A material of the reference table."""

    reference: Annotated[
        Name,
        told("Reference", "none", "Name in the table of reference materials."),
        Field(json_schema_extra={"enum": sorted(REFERENCE_NAMES)}),
    ]
    density_g_cm3: Annotated[
        Density | None, told("Density", "g/cm³", "Mass density, in place of the table's.")
    ] = None

    @field_validator("reference")
    @classmethod
    def _is_in_the_table(cls, reference: str) -> str:
        if reference not in REFERENCE_NAMES:
            known = ", ".join(REFERENCE_NAMES)
            message = f"found {reference[:60]!r}; expected a reference material: {known}"
            refuse("unknown_reference", ((), message))
        return reference


class CompositionMaterial(Model):
    """A mixture of elements by mass."""

    composition: Annotated[
        dict[Name, Fraction],
        told("Composition", "g/g", "Element symbol to mass fraction; the fractions add to 1."),
    ]
    density_g_cm3: Annotated[Density, told("Density", "g/cm³", "Mass density of the mixture.")]

    @field_validator("composition")
    @classmethod
    def _is_a_whole(cls, composition: dict[str, float]) -> dict[str, float]:
        unknown = [symbol for symbol in composition if symbol not in ELEMENTS]
        if unknown:
            expected = "expected the symbol of an element, such as Ca"
            refuse("unknown_element", *(((s,), f"found {s[:60]!r}; {expected}") for s in unknown))
        total = sum(composition.values())
        if abs(total - 1.0) > FRACTION_SUM_TOLERANCE * (1 + 1e-9):
            message = f"found mass fractions that add to {total:.6g}; expected 1 within 0.001"
            refuse("fraction_sum", ((), message))
        return composition


_KEYS = ("attenuation_per_mm", "reference", "composition")


def _the_one_key(value: Any) -> str | None:
    """Return which of the three keys a material has, None unless it has exactly one."""
    present: Collection[str] = value if isinstance(value, Mapping) else ()
    if isinstance(value, BaseModel):
        present = type(value).model_fields
    keys = [key for key in _KEYS if key in present]
    return keys[0] if len(keys) == 1 else None


Material = Annotated[
    FixedMaterial | ReferenceMaterial | CompositionMaterial,
    Choice(_the_one_key, _KEYS, "material_kind", "exactly one of " + ", ".join(_KEYS)),
]


def density_g_cm3(material: Material) -> float | None:
    """Return the mass density of a material; None for a fixed attenuation, which has none."""
    if isinstance(material, FixedMaterial):
        return None
    if isinstance(material, CompositionMaterial) or material.density_g_cm3 is not None:
        return material.density_g_cm3
    return reference(material.reference).density_g_cm3


def composition(material: Material) -> Mapping[str, float] | None:
    """Return the mass fraction of each element; None for a fixed attenuation, which has none."""
    if isinstance(material, FixedMaterial):
        return None
    if isinstance(material, CompositionMaterial):
        return material.composition
    return reference(material.reference).composition
