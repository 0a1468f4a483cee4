"""The leaves of a solid: shapes that map their inside to one material."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.base import (
    Length,
    Number,
    Point,
    Vector,
    direction,
    refuse,
    told,
)
from phantom.document.leaf import Cut, LeafModel
from phantom.document.rules import end_apart, parallel


class Sphere(LeafModel):
    """All points within a radius of a centre."""

    type: Literal["sphere"] = "sphere"
    center: Annotated[Point, told("Centre", "mm", "Centre.")]
    radius: Annotated[Length, told("Radius", "mm", "Radius.")]


class Ellipsoid(LeafModel):
    """An ellipsoid along the world's axes."""

    type: Literal["ellipsoid"] = "ellipsoid"
    center: Annotated[Point, told("Centre", "mm", "Centre.")]
    semi_axes: Annotated[
        tuple[Length, Length, Length], told("Semi-axes", "mm", "Half widths along x, y and z.")
    ]


class Cylinder(LeafModel):
    """A straight cylinder with flat ends, circular or elliptic."""

    type: Literal["cylinder"] = "cylinder"
    start: Annotated[Point, told("Start", "mm", "Centre of one end.")]
    end: Annotated[Point, told("End", "mm", "Centre of the other end.")]
    radius: Annotated[
        Length | None, told("Radius", "mm", "Radius; left out when semi_axes are given.")
    ] = None
    semi_axes: Annotated[
        tuple[Length, Length] | None,
        told("Semi-axes", "mm", "Half width a along up and b along (end - start) x up."),
        Field(validate_default=True),
    ] = None
    up: Annotated[
        Vector | None,
        told("Up", "none", "Direction of a, made orthogonal to the axis; goes with semi_axes."),
        Field(validate_default=True),
    ] = None

    _ends = field_validator("end")(end_apart)

    @field_validator("semi_axes")
    @classmethod
    def _has_one_section(
        cls, semi_axes: tuple[float, float] | None, info: ValidationInfo
    ) -> tuple[float, float] | None:
        if "radius" in info.data:
            if info.data["radius"] is None and semi_axes is None:
                message = "found neither; expected radius, or semi_axes with up"
                refuse("missing", (("radius",), message), whole=True)
            if info.data["radius"] is not None and semi_axes is not None:
                refuse("conflict", ((), "found radius too; expected radius or semi_axes, not both"))
        return semi_axes

    @field_validator("up")
    @classmethod
    def _goes_with_semi_axes(cls, up: Vector | None, info: ValidationInfo) -> Vector | None:
        if "semi_axes" in info.data:
            elliptic = info.data["semi_axes"] is not None
            if elliptic and up is None:
                refuse("missing", ((), "missing; expected up beside semi_axes"))
            if up is not None and not elliptic:
                refuse("conflict", ((), "found up without semi_axes; expected both or neither"))
        if up is not None:
            direction(up)
            if "start" in info.data and "end" in info.data:
                start, end = info.data["start"], info.data["end"]
                axis = [e - s for s, e in zip(start, end, strict=True)]
                if parallel(up, axis):
                    message = "found a direction parallel to the axis; expected one across it"
                    refuse("degenerate", ((), message))
        return up


ConeRadius = Annotated[Number, Field(ge=0, le=1e7)]


class Cone(LeafModel):
    """A cone or a truncated cone with flat ends."""

    type: Literal["cone"] = "cone"
    start: Annotated[Point, told("Start", "mm", "Centre of one end.")]
    end: Annotated[Point, told("End", "mm", "Centre of the other end.")]
    start_radius: Annotated[ConeRadius, told("Start radius", "mm", "Radius at start; 0 is a tip.")]
    end_radius: Annotated[ConeRadius, told("End radius", "mm", "Radius at end; 0 is a tip.")]

    _ends = field_validator("end")(end_apart)

    @field_validator("end_radius")
    @classmethod
    def _has_one_end(cls, end_radius: float, info: ValidationInfo) -> float:
        if max(info.data.get("start_radius", 1.0), end_radius) < 1e-6:
            refuse("out_of_range", ((), "found 0 at both ends; expected one radius above 0"))
        return end_radius


class DoubleCone(LeafModel):
    """Both sides of a cone without ends, bounded by its cuts."""

    type: Literal["double_cone"] = "double_cone"
    apex: Annotated[Point, told("Apex", "mm", "Where the two cones meet.")]
    axis: Annotated[Vector, told("Axis", "none", "Direction of the cones' axis.")]
    slope: Annotated[
        Number, told("Slope", "1", "Radius over distance along the axis.", ge=1e-6, le=1e6)
    ]
    cuts: Annotated[
        tuple[Cut, ...],
        told("Cuts", "none", "Planes that bound the cones; needed, for they are endless."),
        Field(validate_default=True),
    ] = ()

    _direction = field_validator("axis")(direction)

    @field_validator("cuts")
    @classmethod
    def _is_bounded(cls, cuts: tuple[Cut, ...]) -> tuple[Cut, ...]:
        if not cuts:
            refuse("unbounded", ((), "found no cuts; expected cuts that bound the double cone"))
        return cuts


class Box(LeafModel):
    """A box along the world's axes."""

    type: Literal["box"] = "box"
    center: Annotated[Point, told("Centre", "mm", "Centre.")]
    size: Annotated[
        tuple[Length, Length, Length], told("Size", "mm", "Full widths along x, y and z.")
    ]


Coefficients = tuple[Number, Number, Number, Number, Number, Number, Number, Number, Number, Number]


class Quadric(LeafModel):
    """Ax²+By²+Cz²+Dxy+Eyz+Fzx+Gx+Hy+Iz+J <= 0, bounded by itself or by its cuts."""

    type: Literal["quadric"] = "quadric"
    coefficients: Annotated[
        Coefficients, told("Coefficients", "mm^-2, mm^-1 and 1", "A to J, ten numbers.")
    ]

    @field_validator("coefficients")
    @classmethod
    def _has_a_surface(cls, coefficients: Coefficients) -> Coefficients:
        if not any(coefficients[:9]):
            refuse("degenerate", ((), "found 0 for all of A to I; expected a surface"))
        return coefficients
