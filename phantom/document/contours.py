"""Contours of generalized cylinders, in the plane of the frame's n (x) and b (y)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.base import (
    SMALLEST_LENGTH_MM,
    Length,
    Model,
    Number,
    PlanePoint,
    by_type,
    refuse,
    told,
)
from phantom.document.formula_curves import FormulaContour
from phantom.document.formula_fields import FormulaInTheta
from phantom.document.rules import neighbours_apart


class CircleContour(Model):
    """A circle about the axis."""

    type: Literal["circle"] = "circle"
    radius: Annotated[Length, told("Radius", "mm", "Radius of the circle.")]


class EllipseContour(Model):
    """An ellipse about the axis."""

    type: Literal["ellipse"] = "ellipse"
    semi_axes: Annotated[
        tuple[Length, Length], told("Semi-axes", "mm", "Half widths along n and b.")
    ]


class SuperellipseContour(Model):
    """|x/a|^k + |y/b|^k = 1 about the axis."""

    type: Literal["superellipse"] = "superellipse"
    semi_axes: Annotated[
        tuple[Length, Length], told("Semi-axes", "mm", "Half widths a along n and b along b.")
    ]
    exponent: Annotated[
        Number, told("Exponent", "none", "The power k: 2 is an ellipse.", ge=2, le=20)
    ]


class PolygonContour(Model):
    """A polygon, its corners rounded by tangent arcs or sharp."""

    type: Literal["polygon"] = "polygon"
    points: Annotated[
        tuple[PlanePoint, ...],
        told("Points", "mm", "Corners [n, b] in order, three or more.", min_length=3),
    ]
    corner_radius: Annotated[
        Number,
        told("Corner radius", "mm", "Radius of the arc at every corner; 0 is sharp.", ge=0, le=1e7),
    ]

    @field_validator("points")
    @classmethod
    def _corners_apart(cls, points: tuple[PlanePoint, ...]) -> tuple[PlanePoint, ...]:
        neighbours_apart(points, closed=True, field="points")
        return points

    @field_validator("corner_radius")
    @classmethod
    def _is_a_length_or_zero(cls, corner_radius: float) -> float:
        if 0 < corner_radius < SMALLEST_LENGTH_MM:
            message = f"found {corner_radius:g}; expected 0 or at least {SMALLEST_LENGTH_MM:g}"
            refuse("out_of_range", ((), message))
        return corner_radius


class SplineContour(Model):
    """A periodic C² cubic through points, with chord-length knots."""

    type: Literal["spline"] = "spline"
    points: Annotated[
        tuple[PlanePoint, ...],
        told("Points", "mm", "Points [n, b] in order, three or more.", min_length=3),
    ]

    @field_validator("points")
    @classmethod
    def _points_apart(cls, points: tuple[PlanePoint, ...]) -> tuple[PlanePoint, ...]:
        neighbours_apart(points, closed=True, field="points")
        return points


class PolarContour(Model):
    """r(θ), either a periodic C² cubic through equally spaced radii or a formula."""

    type: Literal["polar"] = "polar"
    radii: Annotated[
        tuple[Length, ...] | None,
        told(
            "Radii", "mm", "Radii equally spaced in θ over [0, 2π), from n toward b.", min_length=3
        ),
    ] = None
    formula: Annotated[
        FormulaInTheta | None,
        told("Formula", "mm", "The radius, a 2π-periodic formula in theta, instead of radii."),
        Field(validate_default=True),
    ] = None

    @field_validator("formula")
    @classmethod
    def _has_one_radius(cls, formula: str | None, info: ValidationInfo) -> str | None:
        if "radii" in info.data:
            if info.data["radii"] is None and formula is None:
                message = "found neither; expected radii or formula"
                refuse("missing", (("radii",), message), whole=True)
            if info.data["radii"] is not None and formula is not None:
                refuse("conflict", ((), "found radii too; expected radii or formula, not both"))
        return formula


Contour = Annotated[
    CircleContour
    | EllipseContour
    | SuperellipseContour
    | PolygonContour
    | SplineContour
    | PolarContour
    | FormulaContour,
    by_type("circle", "ellipse", "superellipse", "polygon", "spline", "polar", "formula"),
]
