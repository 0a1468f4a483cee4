"""Where the tube and the detector stand.

A view is a point source and a flat detector; parallel beams have no source but a direction. Any
pose is legal, tilted and off-axis too. The centre of pixel (column, row) lies at whole numbers:
``center + right·pitch_x·(column − (columns − 1)/2) + down·pitch_y·(row − (rows − 1)/2)``.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Final, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, ValidationInfo, field_validator, model_validator

from phantom.document.asked import Asked, plain
from phantom.document.base import Point, Vector, by_shape, direction, refuse, told
from phantom.document.pixels import Side, within_pixels

MIN_PITCH_MM: Final = 1e-6
MAX_PITCH_MM: Final = 1000.0

ORTHOGONALITY: Final = 1e-6
"""Greatest cosine of the angle between ``right`` and ``down`` that still counts as 90°."""

MIN_SOURCE_DISTANCE_MM: Final = 1e-3
"""A source nearer than this to the plane of the detector lies in it."""

MIN_BEAM_SINE: Final = 1e-6
"""A parallel beam closer than this (sine of the angle) to the detector's plane grazes it."""

FloatArray = NDArray[np.float64]


_Point = Annotated[Point, BeforeValidator(plain)]
_Vector = Annotated[Vector, BeforeValidator(plain)]
_Pitch = Annotated[float, Field(strict=True, ge=MIN_PITCH_MM, le=MAX_PITCH_MM)]
Pitch = Annotated[
    _Pitch | tuple[_Pitch, _Pitch],
    by_shape("number", "array", expected="a length in mm, or [along a row, down a column]"),
]
"""One pitch for both directions, or one along a row and one down a column."""


def unit(vector: Vector) -> FloatArray:
    """Return the unit vector along ``vector``."""
    return np.asarray(vector, dtype=np.float64) / math.hypot(*vector)


class Detector(Asked):
    """A flat detector: its pose and its grid of pixels."""

    place: ClassVar[str] = "/view/detector"

    center: Annotated[_Point, told("Centre", "mm", "World point at the middle of the grid.")]
    right: Annotated[_Vector, told("Right", "none", "Direction along a row, columns rising.")]
    down: Annotated[_Vector, told("Down", "none", "Direction down a column, rows rising.")]
    columns: Annotated[Side, told("Columns", "pixels", "Pixels in a row.")]
    rows: Annotated[Side, told("Rows", "pixels", "Pixels in a column.")]
    pitch_mm: Annotated[
        Pitch,
        BeforeValidator(plain),
        told("Pitch", "mm", "Distance of neighbouring pixel centres: a number or [x, y]."),
    ]

    @field_validator("right", "down")
    @classmethod
    def _has_a_direction(cls, vector: Vector) -> Vector:
        return direction(vector)

    @field_validator("down")
    @classmethod
    def _is_orthogonal(cls, down: Vector, info: ValidationInfo) -> Vector:
        if "right" in info.data:
            cosine = float(unit(info.data["right"]) @ unit(down))
            if abs(cosine) > ORTHOGONALITY:
                angle = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
                message = f"found {angle:.6g}° between right and down; expected 90°"
                refuse("not_orthogonal", ((), message))
        return down

    @field_validator("rows")
    @classmethod
    def _is_not_too_large(cls, rows: int, info: ValidationInfo) -> int:
        return within_pixels(rows, info)

    @property
    def pitch_xy_mm(self) -> tuple[float, float]:
        """Pitch along a row and down a column, in mm."""
        return self.pitch_mm if isinstance(self.pitch_mm, tuple) else (self.pitch_mm, self.pitch_mm)

    @property
    def axes(self) -> tuple[FloatArray, FloatArray]:
        """Unit vectors along a row and down a column, orthogonal to rounding."""
        right, down = unit(self.right), unit(self.down)
        down = down - (down @ right) * right
        return right, down / np.linalg.norm(down)

    @property
    def normal(self) -> FloatArray:
        """Unit vector ``right × down``: away from the viewer of the picture."""
        (a, b, c), (d, e, f) = self.axes
        return np.array([b * f - c * e, c * d - a * f, a * e - b * d])

    def pixel(self, column: float, row: float) -> FloatArray:
        """Return the world point, in mm, of a position on the grid; whole numbers are centres."""
        right, down = self.axes
        pitch_x, pitch_y = self.pitch_xy_mm
        center: FloatArray = np.asarray(self.center, dtype=np.float64)
        across = right * (pitch_x * (column - (self.columns - 1) / 2))
        return center + across + down * (pitch_y * (row - (self.rows - 1) / 2))


class View(Asked):
    """A tube and a detector; ``source`` is None for a parallel beam along ``direction``."""

    place: ClassVar[str] = "/view"

    detector: Annotated[Detector, told("Detector", "none", "The flat detector.")]
    source: Annotated[
        _Point | None, told("Source", "mm", "The focal spot; null for a parallel beam.")
    ]
    direction: Annotated[
        _Vector | None,
        told("Direction", "none", "Of a parallel beam, from the tube to the detector."),
    ] = None

    @field_validator("source")
    @classmethod
    def _is_off_the_plane(cls, source: Point | None, info: ValidationInfo) -> Point | None:
        detector = info.data.get("detector")
        if source is not None and detector is not None:
            offset = np.subtract(source, detector.center)
            if abs(float(detector.normal @ offset)) < MIN_SOURCE_DISTANCE_MM:
                message = f"found the source {source} in the plane of the detector; expected it off"
                refuse("source_in_plane", ((), message))
        return source

    @field_validator("direction")
    @classmethod
    def _has_a_direction(cls, vector: Vector | None, info: ValidationInfo) -> Vector | None:
        if vector is None:
            return None
        direction(vector)
        detector = info.data.get("detector")
        if detector is not None and abs(float(detector.normal @ unit(vector))) < MIN_BEAM_SINE:
            message = f"found a beam {vector} along the detector; expected it to cross the detector"
            refuse("grazing_beam", ((), message))
        return vector

    @model_validator(mode="after")
    def _is_one_kind(self) -> Self:
        if self.source is None and self.direction is None:
            message = "found neither a source nor a direction; expected one of them"
            refuse("missing", (("direction",), message))
        if self.source is not None and self.direction is not None:
            message = "found a source and a direction; expected a direction only without a source"
            refuse("contradiction", (("direction",), message))
        return self
