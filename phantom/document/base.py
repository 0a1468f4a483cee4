"""What every model of a document shares: strict numbers, told fields and the choice by tag."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Annotated, Any, LiteralString, NoReturn, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

# Marks a union tag in an error's location, so that it can never be taken for a key of the input
# (keys with control characters are refused before any model is tried).
TAG = "\x00"
SMALLEST_LENGTH_MM = 1e-6  # shorter lengths, and points nearer than this, are refused
LARGEST_LENGTH_MM = 1e7  # ten kilometres
SMALLEST_VECTOR = 1e-12  # shorter vectors have no direction
LARGEST_NUMBER = 1e18


def told(title: str, unit: str, meaning: str, **limits: Any) -> FieldInfo:
    """Return the description of a field: its title, its unit and what it means, with limits."""
    text = f"{meaning} Unit: {unit}."
    info: FieldInfo = Field(
        title=title, description=text, json_schema_extra={"unit": unit}, **limits
    )
    return info


def _require_type(schema: dict[str, Any]) -> None:
    """List `type` as required: it has a default for Python callers, but none in a document."""
    if "type" in schema.get("properties", {}):
        schema["required"] = ["type", *schema.get("required", [])]


class Model(BaseModel):
    """A frozen part of a document; unknown fields are errors."""

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        json_schema_extra=_require_type,
        hide_input_in_errors=True,
    )


Number = Annotated[
    float,
    Field(strict=True, allow_inf_nan=False, ge=-LARGEST_NUMBER, le=LARGEST_NUMBER),
]
Coordinate = Annotated[
    float,
    Field(strict=True, allow_inf_nan=False, ge=-LARGEST_LENGTH_MM, le=LARGEST_LENGTH_MM),
]
Length = Annotated[
    float,
    Field(strict=True, allow_inf_nan=False, ge=SMALLEST_LENGTH_MM, le=LARGEST_LENGTH_MM),
]
Fraction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e6, le=1e6)]
Integer = Annotated[int, Field(strict=True)]
Boolean = Annotated[bool, Field(strict=True)]
Text = Annotated[str, Field(strict=True, max_length=20_000)]
Name = Annotated[str, Field(strict=True, min_length=1, max_length=200)]

Point = tuple[Coordinate, Coordinate, Coordinate]
Vector = tuple[Number, Number, Number]
PlanePoint = tuple[Coordinate, Coordinate]


def refuse(
    kind: LiteralString, *problems: tuple[tuple[str | int, ...], str], whole: bool = False
) -> NoReturn:
    """Refuse the field under validation, once for each (place below it, message).

    With ``whole`` the places are below the model that holds the field instead of the field.
    """
    first = problems[0][1]
    context = {"message": first, "problems": problems, "whole": whole}
    raise PydanticCustomError(kind, "{message}", context)


def direction(vector: Vector) -> Vector:
    """Refuse a vector that is too short to have a direction."""
    if math.hypot(*vector) < SMALLEST_VECTOR:
        refuse("zero_vector", ((), "found a zero vector; expected a direction"))
    return vector


def same_place(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Tell whether two points are nearer than the smallest length."""
    return math.dist(one, other) < SMALLEST_LENGTH_MM


class Choice:
    """Makes a union pick its member by a tag, with one error in our words when none fits.

    Parameters
    ----------
    pick
        Takes the input (raw or a model) and returns a tag, or None.
    tags
        The tag of each member of the union, in order.
    kind, expected
        The kind of the problem and what was expected, when no member fits.
    """

    def __init__(
        self,
        pick: Callable[[Any], str | None],
        tags: tuple[str, ...],
        kind: str,
        expected: str,
    ) -> None:
        self.pick, self.tags, self.kind, self.expected = pick, tags, kind, expected

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Build the tagged union; tags carry the mark that keeps them out of paths."""
        members = self._members(source)
        choices = {
            TAG + tag: handler.generate_schema(member)
            for tag, member in zip(self.tags, members, strict=True)
        }
        return core_schema.tagged_union_schema(
            choices,
            discriminator=self._tag,
            custom_error_type=self.kind,
            custom_error_message=self.expected,
        )

    @staticmethod
    def _members(source: Any) -> tuple[Any, ...]:
        is_union = get_origin(source) is not None and get_origin(source) is not tuple
        return get_args(source) if is_union else (source,)

    def _tag(self, value: Any) -> str | None:
        tag = self.pick(value)
        return TAG + tag if tag in self.tags else None


def by_type(*tags: str) -> Choice:
    """Pick a member by the field ``type``."""

    def pick(value: Any) -> str | None:
        found = value.get("type") if isinstance(value, Mapping) else getattr(value, "type", None)
        return found if isinstance(found, str) else None

    return Choice(pick, tags, "unknown_type", ", ".join(tags))


def shape_of(value: Any) -> str:
    """Name the JSON shape of a value: number, string, array, object, boolean, null or other."""
    if isinstance(value, Mapping | BaseModel):
        return "object"
    for shape, types in _SHAPES:
        if isinstance(value, types):
            return shape
    return "other"


_SHAPES: tuple[tuple[str, Any], ...] = (
    ("boolean", bool),
    ("null", type(None)),
    ("number", (int, float)),
    ("string", str),
    ("array", (list, tuple)),
)


def by_shape(*shapes: str, expected: str) -> Choice:
    """Pick a member by the JSON shape of the value; members stand in the order of ``shapes``."""
    kind: LiteralString = "not_a_number" if "number" in shapes else "wrong_shape"
    return Choice(shape_of, shapes, kind, expected)
