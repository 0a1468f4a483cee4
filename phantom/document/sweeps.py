"""How a contour changes along its axis, and how its frame rides along."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import field_validator

from phantom.document.base import Choice, Model, Vector, by_shape, direction, refuse, told
from phantom.document.contours import Contour
from phantom.document.formula_fields import FormulaInXYU, Parameter
from phantom.document.profiles import Profile, Scale


class LinearSweep(Model):
    """The column map R·H·D·[x, y] + offset of the contour's plane, each a profile of u."""

    type: Literal["linear"] = "linear"
    scale: Annotated[
        Scale, told("Scale", "1", "Scale D of the contour, or one each along n and b.")
    ] = 1.0
    rotate_deg: Annotated[Profile, told("Rotation", "degree", "Rotation R from n toward b.")] = 0.0
    shear: Annotated[Profile, told("Shear", "1", "Shear H: x grows by shear times y.")] = 0.0
    offset: Annotated[
        tuple[Profile, Profile], told("Offset", "mm", "Shift of the contour along n and b.")
    ] = (0.0, 0.0)


MatrixRow = tuple[Profile, Profile, Profile]


class MatrixSweep(Model):
    """A linear sweep in the paper's form [x y 1] S(u), its matrix given."""

    type: Literal["linear"] = "linear"
    matrix: Annotated[
        tuple[MatrixRow, MatrixRow, MatrixRow],
        told(
            "Matrix",
            "1, the last row mm",
            "Rows of S(u), for row vectors; the third column is 0, 0, 1.",
        ),
    ]

    @field_validator("matrix")
    @classmethod
    def _third_column_is_constant(
        cls, matrix: tuple[MatrixRow, MatrixRow, MatrixRow]
    ) -> tuple[MatrixRow, MatrixRow, MatrixRow]:
        problems: list[tuple[tuple[str | int, ...], str]] = []
        for i, row in enumerate(matrix):
            wanted = 1 if i == 2 else 0
            if row[2] != wanted:
                shown = f"{row[2]:g}" if isinstance(row[2], float) else "a profile"
                problems.append(((i, 2), f"found {shown}; expected the number {wanted}"))
        if problems:
            refuse("bad_matrix", *problems)
        return matrix


class MorphSection(Model):
    """A contour at one place of the axis."""

    at: Annotated[Parameter, told("At", "none", "The u at which the section is this contour.")]
    contour: Annotated[Contour, told("Contour", "mm", "The section there.")]


class MorphSweep(Model):
    """One contour turning into the next along the axis; it replaces the cylinder's contour."""

    type: Literal["morph"] = "morph"
    contours: Annotated[
        tuple[MorphSection, ...],
        told(
            "Contours",
            "none",
            "Sections; at increases strictly from exactly the axis's first u to its last.",
            min_length=2,
            max_length=100,
        ),
    ]

    @field_validator("contours")
    @classmethod
    def _increase(cls, contours: tuple[MorphSection, ...]) -> tuple[MorphSection, ...]:
        problems: list[tuple[tuple[str | int, ...], str]] = []
        for i, (before, section) in enumerate(itertools.pairwise(contours), 1):
            if not section.at > before.at:
                message = f"found u = {section.at:g} after {before.at:g}; expected u to increase"
                problems.append(((i, "at"), message))
        if problems:
            refuse("bad_knots", *problems)
        return contours


class FormulaSweep(Model):
    """Any map of the contour's plane, with its inverse, by formulas in x, y and u."""

    type: Literal["formula"] = "formula"
    forward: Annotated[
        tuple[FormulaInXYU, FormulaInXYU],
        told("Forward", "mm", "Where the contour's point [x, y] goes at u."),
    ]
    inverse: Annotated[
        tuple[FormulaInXYU, FormulaInXYU],
        told("Inverse", "mm", "The contour's point that goes to [x, y] at u."),
    ]


def _kind(value: Any) -> str | None:
    """Name the kind of a sweep; a linear one with a matrix is a kind of its own."""
    held = value if isinstance(value, Mapping) else getattr(value, "__dict__", {})
    kind = held.get("type")
    if kind == "linear":
        return "matrix" if "matrix" in held else "linear"
    return kind if kind in ("morph", "formula") else None


Sweep = Annotated[
    LinearSweep | MatrixSweep | MorphSweep | FormulaSweep,
    Choice(
        _kind, ("linear", "matrix", "morph", "formula"), "unknown_type", "linear, morph, formula"
    ),
]


class UpFrame(Model):
    """A frame whose n is a fixed direction made orthogonal to the tangent."""

    up: Annotated[Vector, told("Up", "none", "Direction that n stays nearest to.")]

    _direction = field_validator("up")(direction)


Frame = Annotated[
    Literal["rotation_minimizing", "frenet"] | UpFrame,
    by_shape("string", "object", expected="rotation_minimizing, frenet or an object with up"),
]
