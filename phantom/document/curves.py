"""Axes of generalized cylinders, and the ways a frame can ride along them."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.base import (
    Boolean,
    Coordinate,
    Integer,
    Model,
    Number,
    Point,
    Vector,
    by_type,
    direction,
    refuse,
    same_place,
    told,
)
from phantom.document.formula_curves import FormulaAxis
from phantom.document.rules import end_apart, neighbours_apart, rejection

PLANE_TOLERANCE = 1e-6
"""How far an arc's start may lie from its plane, relative to its distance from the centre."""


class LineAxis(Model):
    """A straight axis."""

    type: Literal["line"] = "line"
    start: Annotated[Point, told("Start", "mm", "Point at u = 0.")]
    end: Annotated[Point, told("End", "mm", "Point at u = 1.")]

    _ends = field_validator("end")(end_apart)


class SplineAxis(Model):
    """A C² cubic through points, with chord-length knots scaled to [0, 1]."""

    type: Literal["spline"] = "spline"
    points: Annotated[
        tuple[Point, ...],
        told("Points", "mm", "Points the axis passes through, two or more.", min_length=2),
    ]
    closed: Annotated[
        Boolean,
        told("Closed", "none", "Whether the axis is periodic; the first point is not repeated."),
        Field(validate_default=True),
    ] = False

    @field_validator("closed")
    @classmethod
    def _points_can_be_joined(cls, closed: bool, info: ValidationInfo) -> bool:
        if "points" in info.data:
            points = info.data["points"]
            if closed and len(points) < 3:
                message = f"found {len(points)} points; expected 3 or more on a closed axis"
                refuse("wrong_length", (("points",), message), whole=True)
            neighbours_apart(points, closed=closed, field="points")
        return closed


class BSplineAxis(Model):
    """A clamped uniform B-spline."""

    type: Literal["bspline"] = "bspline"
    control_points: Annotated[
        tuple[Point, ...],
        told("Control points", "mm", "Control points, more of them than the degree.", min_length=2),
    ]
    degree: Annotated[
        Integer, told("Degree", "none", "Degree of the polynomial pieces.", ge=1, le=25)
    ]

    @field_validator("degree")
    @classmethod
    def _enough_control_points(cls, degree: int, info: ValidationInfo) -> int:
        count = len(info.data.get("control_points", range(degree + 1)))
        if count <= degree:
            message = f"found degree {degree} with {count} control points; expected more points"
            refuse("out_of_range", ((), message))
        return degree


class ArcAxis(Model):
    """A circular arc; 360 degrees is closed."""

    type: Literal["arc"] = "arc"
    center: Annotated[Point, told("Centre", "mm", "Centre of the circle.")]
    normal: Annotated[
        Vector,
        told(
            "Normal", "none", "Normal of the circle's plane; the arc turns right-handed about it."
        ),
    ]
    start: Annotated[Point, told("Start", "mm", "Point at u = 0, in the plane of the circle.")]
    angle_deg: Annotated[
        Number,
        told("Angle", "degree", "Angle turned through, not 0, from -360 to 360.", ge=-360, le=360),
    ]

    _direction = field_validator("normal")(direction)

    @field_validator("start")
    @classmethod
    def _start_is_in_the_plane(cls, start: Point, info: ValidationInfo) -> Point:
        if "center" not in info.data:
            return start
        center = info.data["center"]
        if same_place(start, center):
            refuse("degenerate", ((), "found the centre; expected a point away from it"))
        if "normal" in info.data:
            arm = (start[0] - center[0], start[1] - center[1], start[2] - center[2])
            normal = info.data["normal"]
            height = sum(a * n for a, n in zip(arm, normal, strict=True)) / math.hypot(*normal)
            if abs(height) > PLANE_TOLERANCE * math.hypot(*arm):
                message = (
                    f"found a point {height:.6g} mm off the plane of the arc; expected one in it"
                )
                refuse("out_of_plane", ((), message))
        return start

    @field_validator("angle_deg")
    @classmethod
    def _turns(cls, angle_deg: float) -> float:
        if abs(angle_deg) < 1e-9:
            refuse("out_of_range", ((), f"found {angle_deg:g}; expected an angle that is not 0"))
        return angle_deg


class HelixAxis(Model):
    """A helix about an axis."""

    type: Literal["helix"] = "helix"
    center: Annotated[Point, told("Centre", "mm", "A point on the helix's own axis.")]
    axis: Annotated[
        Vector,
        told("Axis", "none", "Direction of the helix's own axis; turns are right-handed about it."),
    ]
    start: Annotated[Point, told("Start", "mm", "Point at u = 0, off the helix's own axis.")]
    pitch: Annotated[Coordinate, told("Pitch", "mm", "Advance along the axis in one turn.")]
    turns: Annotated[
        Number,
        told(
            "Turns", "none", "Number of turns, not 0; negative is left-handed.", ge=-1000, le=1000
        ),
    ]

    _direction = field_validator("axis")(direction)

    @field_validator("start")
    @classmethod
    def _start_is_off_the_axis(cls, start: Point, info: ValidationInfo) -> Point:
        if "center" in info.data and "axis" in info.data:
            center = info.data["center"]
            arm = (start[0] - center[0], start[1] - center[1], start[2] - center[2])
            if math.hypot(*rejection(arm, info.data["axis"])) < 1e-6:
                refuse(
                    "degenerate", ((), "found a point on the helix's own axis; expected one off it")
                )
        return start

    @field_validator("turns")
    @classmethod
    def _turns(cls, turns: float) -> float:
        if abs(turns) < 1e-9:
            refuse(
                "out_of_range", ((), f"found {turns:g}; expected a number of turns that is not 0")
            )
        return turns


Axis = Annotated[
    LineAxis | SplineAxis | BSplineAxis | ArcAxis | HelixAxis | FormulaAxis,
    by_type("line", "spline", "bspline", "arc", "helix", "formula"),
]
