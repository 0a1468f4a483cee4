"""Contours of generalized cylinders, in the plane of the frame's n (x) and b (y)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import field_validator

from phantom.document.base import Length, Model, Number, PlanePoint, by_type, told
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
    """A polygon whose corners are rounded by tangent arcs."""

    type: Literal["polygon"] = "polygon"
    points: Annotated[
        tuple[PlanePoint, ...],
        told("Points", "mm", "Corners [n, b] in order, three or more.", min_length=3),
    ]
    corner_radius: Annotated[
        Length, told("Corner radius", "mm", "Radius of the arc at every corner.")
    ]

    @field_validator("points")
    @classmethod
    def _corners_apart(cls, points: tuple[PlanePoint, ...]) -> tuple[PlanePoint, ...]:
        neighbours_apart(points, closed=True, field="points")
        return points


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
    """A periodic C² cubic r(θ) through equally spaced radii."""

    type: Literal["polar"] = "polar"
    radii: Annotated[
        tuple[Length, ...],
        told(
            "Radii", "mm", "Radii equally spaced in θ over [0, 2π), from n toward b.", min_length=3
        ),
    ]


Contour = Annotated[
    CircleContour
    | EllipseContour
    | SuperellipseContour
    | PolygonContour
    | SplineContour
    | PolarContour,
    by_type("circle", "ellipse", "superellipse", "polygon", "spline", "polar"),
]
