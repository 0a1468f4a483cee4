"""Numbers that may change along an axis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import field_validator

from phantom.document.base import Choice, Coordinate, Model, Number, refuse, shape_of, told
from phantom.document.formula_fields import FormulaInU


class KnotProfile(Model):
    """A C² cubic through knots; two knots are a line, three a parabola."""

    knots: Annotated[
        tuple[tuple[Number, Coordinate], ...],
        told(
            "Knots",
            "u to the profile's own unit",
            "Pairs [u, value]; u increases strictly from exactly the axis's first u to its last.",
            min_length=2,
        ),
    ]

    @field_validator("knots")
    @classmethod
    def _increase(cls, knots: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        problems: list[tuple[tuple[str | int, ...], str]] = [
            ((i, 0), f"found u = {knots[i][0]:g} after {knots[i - 1][0]:g}; expected u to increase")
            for i in range(1, len(knots))
            if not knots[i][0] > knots[i - 1][0]
        ]
        if problems:
            refuse("bad_knots", *problems)
        return knots


class FormulaProfile(Model):
    """A formula in u."""

    formula: Annotated[
        FormulaInU, told("Formula", "the profile's own unit", "The value, a formula in u.")
    ]


def _form(value: Any) -> str | None:
    """Name the form of a profile: number, array, knots or formula."""
    if shape_of(value) != "object":
        return shape_of(value)
    held = value if isinstance(value, Mapping) else dict(value)
    forms = [form for form in ("knots", "formula") if form in held]
    return forms[0] if len(forms) == 1 else None


_EXPECTED = "a number or an object with either knots or formula"

Profile = Annotated[
    Coordinate | KnotProfile | FormulaProfile,
    Choice(_form, ("number", "knots", "formula"), "not_a_number", _EXPECTED),
]

Scale = Annotated[
    Coordinate | KnotProfile | FormulaProfile | tuple[Profile, Profile],
    Choice(
        _form,
        ("number", "knots", "formula", "array"),
        "not_a_number",
        _EXPECTED + ", or two of them",
    ),
]
