"""How a contour changes along its axis, and how its frame rides along."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import field_validator

from phantom.document.base import (
    Coordinate,
    Model,
    Number,
    Vector,
    by_shape,
    by_type,
    direction,
    refuse,
    told,
)


class KnotProfile(Model):
    """A C² cubic through knots; two knots are a line, three a parabola."""

    knots: Annotated[
        tuple[tuple[Number, Coordinate], ...],
        told(
            "Knots",
            "u to the profile's own unit",
            "Pairs [u, value]; u increases strictly from exactly 0 to exactly 1.",
            min_length=2,
        ),
    ]

    @field_validator("knots")
    @classmethod
    def _spans_the_axis(
        cls, knots: tuple[tuple[float, float], ...]
    ) -> tuple[tuple[float, float], ...]:
        problems: list[tuple[tuple[str | int, ...], str]] = [
            ((i, 0), f"found u = {knots[i][0]:g} after {knots[i - 1][0]:g}; expected u to increase")
            for i in range(1, len(knots))
            if not knots[i][0] > knots[i - 1][0]
        ]
        for index, end in ((0, 0.0), (len(knots) - 1, 1.0)):
            if knots[index][0] != end:
                name = "first" if index == 0 else "last"
                message = (
                    f"found u = {knots[index][0]:.17g}; expected the {name} knot at exactly {end:g}"
                )
                problems.append(((index, 0), message))
        if problems:
            refuse("bad_knots", *problems)
        return knots


_NUMBER_OR_KNOTS = "a number or an object with knots"

Profile = Annotated[
    Coordinate | KnotProfile,
    by_shape("number", "object", expected=_NUMBER_OR_KNOTS),
]

Scale = Annotated[
    Coordinate | KnotProfile | tuple[Profile, Profile],
    by_shape("number", "object", "array", expected=_NUMBER_OR_KNOTS + ", or two of them"),
]


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


Sweep = Annotated[LinearSweep, by_type("linear")]


class UpFrame(Model):
    """A frame whose n is a fixed direction made orthogonal to the tangent."""

    up: Annotated[Vector, told("Up", "none", "Direction that n stays nearest to.")]

    _direction = field_validator("up")(direction)


Frame = Annotated[
    Literal["rotation_minimizing", "frenet"] | UpFrame,
    by_shape("string", "object", expected="rotation_minimizing, frenet or an object with up"),
]
