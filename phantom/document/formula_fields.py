"""Fields that hold a formula: text that has been parsed once, and the range of its variable."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from pydantic import AfterValidator, Field

from phantom.document.base import refuse
from phantom.document.formula_text import LONGEST_FORMULA, parse_formula
from phantom.document.formula_tokens import FormulaError

LARGEST_PARAMETER = 1e7
NARROWEST_RANGE = 1e-6
"""Least width of a range, relative to its larger end where that is over 1."""


def _in(*variables: str) -> Callable[[str], str]:
    def parsed(text: str) -> str:
        try:
            parse_formula(text, variables)
        except FormulaError as error:
            refuse("bad_formula", ((), str(error)))
        return text

    return parsed


_Text = Annotated[str, Field(strict=True, max_length=LONGEST_FORMULA)]
FormulaInU = Annotated[_Text, AfterValidator(_in("u"))]
FormulaInV = Annotated[_Text, AfterValidator(_in("v"))]
FormulaInTheta = Annotated[_Text, AfterValidator(_in("theta"))]
FormulaInXYU = Annotated[_Text, AfterValidator(_in("x", "y", "u"))]

Parameter = Annotated[
    float,
    Field(strict=True, allow_inf_nan=False, ge=-LARGEST_PARAMETER, le=LARGEST_PARAMETER),
]


def _increasing(ends: tuple[float, float]) -> tuple[float, float]:
    start, end = ends
    least = NARROWEST_RANGE * max(1.0, abs(start), abs(end))
    if not end - start >= least:
        message = f"found {start:.12g} to {end:.12g}; expected an end at least {least:g} further on"
        refuse("bad_range", ((), message))
    return ends


Range = Annotated[tuple[Parameter, Parameter], AfterValidator(_increasing)]
