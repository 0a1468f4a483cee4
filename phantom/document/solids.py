"""Solids: the leaves, the five operators, transforms and instances."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Final, Literal, TypeGuard

from pydantic import ValidationInfo, field_validator

from phantom.document.base import (
    Angle,
    Coordinate,
    Model,
    Name,
    Number,
    Point,
    Vector,
    by_type,
    direction,
    refuse,
    told,
)
from phantom.document.generalized_cylinder import GeneralizedCylinder
from phantom.document.leaf import LeafModel
from phantom.document.leaves import (
    Box,
    Cone,
    Cylinder,
    DoubleCone,
    Ellipsoid,
    Quadric,
    Sphere,
)

SIMILARITY_TOLERANCE = 1e-9
"""How far the columns of a matrix may be from orthogonal and equally long, relative to scale²."""


class Operator(Model):
    """Two or more solids taken from the left: ((a op b) op c)."""

    solids: Annotated[
        tuple[Solid, ...],
        told("Solids", "none", "Two or more solids, taken from the left.", min_length=2),
    ]


class Union(Operator):
    """Where both are present, the left."""

    type: Literal["union"] = "union"


class Intersection(Operator):
    """The left, where both are present."""

    type: Literal["intersection"] = "intersection"


class Difference(Operator):
    """The left, where the right is absent."""

    type: Literal["difference"] = "difference"


class Overlap(Operator):
    """Where both are present, both: densities add."""

    type: Literal["overlap"] = "overlap"


class Replace(Operator):
    """Where both are present, the right."""

    type: Literal["replace"] = "replace"


class Rotation(Model):
    """A right-handed turn about an axis."""

    axis: Annotated[Vector, told("Axis", "none", "Direction of the axis.")]
    angle_deg: Annotated[Angle, told("Angle", "degree", "Angle turned through.")]
    about: Annotated[Point, told("About", "mm", "A point on the axis; the origin by default.")] = (
        0.0,
        0.0,
        0.0,
    )

    _direction = field_validator("axis")(direction)


Row = tuple[Number, Number, Number, Coordinate]
Matrix = tuple[Row, Row, Row]


class Transformed(Model):
    """A solid scaled, rotated and moved, in this order; or mapped by a similarity."""

    type: Literal["transformed"] = "transformed"
    solid: Annotated[Solid, told("Solid", "none", "What is moved.")]
    scale: Annotated[
        Number | None, told("Scale", "1", "Factor about the world's origin.", ge=1e-6, le=1e6)
    ] = None
    rotate: Annotated[Rotation | None, told("Rotate", "none", "A turn, after the scale.")] = None
    translate: Annotated[Point | None, told("Translate", "mm", "A shift, after the turn.")] = None
    matrix: Annotated[
        Matrix | None,
        told("Matrix", "1 and mm", "Rows of [A | t], x' = A x + t, a similarity or its mirror."),
    ] = None
    name: Annotated[Name | None, told("Name", "none", "Part of the labels of its leaves.")] = None

    @field_validator("matrix")
    @classmethod
    def _is_a_similarity_alone(cls, matrix: Matrix | None, info: ValidationInfo) -> Matrix | None:
        if matrix is None:
            return None
        besides = [k for k in ("scale", "rotate", "translate") if info.data.get(k) is not None]
        if besides:
            message = f"found {', '.join(besides)} too; expected a matrix alone"
            refuse("conflict", ((), message))
        columns = [[row[j] for row in matrix] for j in range(3)]
        gram = [
            [math.fsum(a * b for a, b in zip(p, q, strict=True)) for q in columns] for p in columns
        ]
        square = (gram[0][0] + gram[1][1] + gram[2][2]) / 3
        if not 1e-12 <= square <= 1e12:
            message = f"found a scale of {math.sqrt(square):.6g}; expected one from 1e-06 to 1e+06"
            refuse("out_of_range", ((), message))
        fault = max(abs(gram[i][j] - square * (i == j)) for i in range(3) for j in range(3))
        if fault > SIMILARITY_TOLERANCE * square:
            message = f"found a matrix off by {fault / square:.3g}; expected a similarity"
            refuse("not_a_similarity", ((), message))
        return matrix


class Instance(Model):
    """A solid of the definitions, used once more."""

    type: Literal["instance"] = "instance"
    of: Annotated[Name, told("Of", "none", "Name in definitions.")]
    name: Annotated[Name | None, told("Name", "none", "Part of the labels of its leaves.")] = None


Leaf = Sphere | Ellipsoid | Cylinder | Cone | DoubleCone | Box | Quadric | GeneralizedCylinder

LEAVES: Final[dict[str, type[LeafModel]]] = {
    "sphere": Sphere,
    "ellipsoid": Ellipsoid,
    "cylinder": Cylinder,
    "cone": Cone,
    "double_cone": DoubleCone,
    "box": Box,
    "quadric": Quadric,
    "generalized_cylinder": GeneralizedCylinder,
}
"""Type tag to class of the leaves."""

OPERATORS: Final[dict[str, type[Operator]]] = {
    "union": Union,
    "intersection": Intersection,
    "difference": Difference,
    "overlap": Overlap,
    "replace": Replace,
}
"""Type tag to class of the five operators."""

Solid = Annotated[
    Sphere
    | Ellipsoid
    | Cylinder
    | Cone
    | DoubleCone
    | Box
    | Quadric
    | GeneralizedCylinder
    | Union
    | Intersection
    | Difference
    | Overlap
    | Replace
    | Transformed
    | Instance,
    by_type(*LEAVES, *OPERATORS, "transformed", "instance"),
]

for _operator in OPERATORS.values():
    _operator.model_rebuild()
Transformed.model_rebuild()


def is_leaf(solid: object) -> TypeGuard[Leaf]:
    """Tell whether a solid is a leaf."""
    return isinstance(solid, LeafModel)


def label_of(names: Iterable[str | None]) -> str:
    """Return the label made of the names from the root to a leaf; unnamed steps are left out."""
    return "/".join(name for name in names if name)
