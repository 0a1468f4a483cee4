"""An axis and a contour given by formulas."""

from __future__ import annotations

from typing import Annotated, Literal

from phantom.document.base import Boolean, Model, told
from phantom.document.formula_fields import FormulaInU, FormulaInV, Range


class FormulaAxis(Model):
    """Any regular curve, by formulas in u over a range of its own."""

    type: Literal["formula"] = "formula"
    x: Annotated[FormulaInU, told("x", "mm", "World x, a formula in u.")]
    y: Annotated[FormulaInU, told("y", "mm", "World y, a formula in u.")]
    z: Annotated[FormulaInU, told("z", "mm", "World z, a formula in u.")]
    range: Annotated[
        Range, told("Range", "none", "First and last u; knots and at of the sweep span it.")
    ]
    closed: Annotated[
        Boolean, told("Closed", "none", "Whether the axis ends where and as it starts.")
    ] = False


class FormulaContour(Model):
    """Any simple closed curve, by formulas in v."""

    type: Literal["formula"] = "formula"
    x: Annotated[FormulaInV, told("x", "mm", "Along n, a formula in v.")]
    y: Annotated[FormulaInV, told("y", "mm", "Along b, a formula in v.")]
    range: Annotated[
        Range, told("Range", "none", "First and last v; the curve ends where it starts.")
    ]
