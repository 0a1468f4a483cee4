"""Where the eye is and what it looks at: a perspective or a parallel camera.

The centre of pixel (column, row) lies at whole numbers, as in an X-ray view; row 0 is at the top.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Final, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, field_validator, model_validator
from pydantic import ValidationInfo as Info

from phantom.document.asked import Asked, plain
from phantom.document.base import Length, Number, Point, Vector, direction, refuse, same_place, told
from phantom.document.pixels import Side, within_pixels
from phantom.geometry.vectors import dots, unit

Floats = NDArray[np.float64]

DEFAULT_PIXELS: Final = 1024
DEFAULT_FIELD_OF_VIEW_DEG: Final = 20.0

MIN_UP_SINE: Final = 1e-6
"""``up`` closer than this (sine of the angle) to the line of sight does not say which way is up."""

FieldOfView = Annotated[Number, Field(ge=0.01, le=170.0)]


class Camera(Asked):
    """An eye that looks at a target: perspective, or parallel where a width in mm is given."""

    place: ClassVar[str] = "/camera"

    eye: Annotated[
        Annotated[Point, BeforeValidator(plain)],
        told("Eye", "mm", "World point that is looked from; nothing behind it is seen."),
    ]
    target: Annotated[
        Annotated[Point, BeforeValidator(plain)],
        told("Target", "mm", "World point in the middle of the picture."),
    ]
    up: Annotated[
        Annotated[Vector, BeforeValidator(plain)],
        told("Up", "none", "Direction that points to the top of the picture."),
        Field(validate_default=True),
    ] = (0.0, 0.0, 1.0)
    field_of_view_deg: Annotated[
        FieldOfView | None,
        told("Field of view", "degrees", "Angle across the picture's width; 20 by default."),
    ] = None
    parallel_width_mm: Annotated[
        Length | None,
        told("Parallel width", "mm", "Width of the picture; lines of sight are then parallel."),
    ] = None
    columns: Annotated[Side, told("Columns", "pixels", "Pixels in a row.")] = DEFAULT_PIXELS
    rows: Annotated[Side, told("Rows", "pixels", "Pixels in a column.")] = DEFAULT_PIXELS
    shift_px: Annotated[
        Number,
        told(
            "Shift",
            "pixels",
            "How far the picture's window is slid to the right in its plane: for the eyes of a"
            " pair, whose lines of sight stay parallel.",
        ),
    ] = 0.0

    @field_validator("target")
    @classmethod
    def _is_not_the_eye(cls, target: Point, info: Info) -> Point:
        eye = info.data.get("eye")
        if eye is not None and same_place(eye, target):
            message = f"found {target}, where the eye is; expected another point to look at"
            refuse("eye_is_target", ((), message))
        return target

    @field_validator("up")
    @classmethod
    def _says_which_way_is_up(cls, up: Vector, info: Info) -> Vector:
        direction(up)
        if "eye" in info.data and "target" in info.data:
            look = np.subtract(info.data["target"], info.data["eye"])
            sine = np.linalg.norm(np.cross(unit(look), unit(np.asarray(up))))
            if sine < MIN_UP_SINE:
                message = f"found {up}, along the line of sight; expected a direction across it"
                refuse("parallel_up", ((), message))
        return up

    @field_validator("rows")
    @classmethod
    def _is_not_too_large(cls, rows: int, info: Info) -> int:
        return within_pixels(rows, info)

    @model_validator(mode="after")
    def _is_one_kind(self) -> Self:
        if self.field_of_view_deg is not None and self.parallel_width_mm is not None:
            message = "found a parallel width and a field of view; expected one of them"
            refuse("contradiction", (("parallel_width_mm",), message))
        if self.field_of_view_deg is None and self.parallel_width_mm is None:
            # Straight into the model, which is frozen for others.
            self.__dict__["field_of_view_deg"] = DEFAULT_FIELD_OF_VIEW_DEG
        return self

    @property
    def axes(self) -> tuple[Floats, Floats, Floats]:
        """Unit vectors along a row, down a column and from the eye to the target."""
        forward = unit(np.subtract(self.target, self.eye))
        right = unit(np.cross(forward, unit(np.asarray(self.up))))
        return right, np.cross(forward, right), forward

    @property
    def pitch(self) -> float:
        """Distance of pixel centres: mm of a parallel camera, else of the plane at depth 1."""
        if self.parallel_width_mm is not None:
            return self.parallel_width_mm / self.columns
        assert self.field_of_view_deg is not None
        return 2.0 * math.tan(math.radians(self.field_of_view_deg) / 2) / self.columns

    def offsets(self, columns: Floats, rows: Floats) -> Floats:
        """Return (..., 3) vectors from the middle of the picture to points of it.

        Parameters
        ----------
        columns, rows
            Where in the picture, in pixels; they are broadcast against each other.
        """
        right, down, _ = self.axes
        middle = (self.columns - 1) / 2 - self.shift_px
        across = (np.asarray(columns, dtype=np.float64) - middle) * self.pitch
        below = (np.asarray(rows, dtype=np.float64) - (self.rows - 1) / 2) * self.pitch
        across, below = np.broadcast_arrays(across, below)
        return across[..., None] * right + below[..., None] * down

    def rays(self, columns: Floats, rows: Floats) -> tuple[Floats, Floats]:
        """Return (..., 3) origins in mm and unit directions of the lines of sight.

        A perspective camera's rays start at the eye, a parallel camera's in the plane through the
        eye across the line of sight.

        Parameters
        ----------
        columns, rows
            Where in the picture, in pixels; they are broadcast against each other.
        """
        offsets = self.offsets(columns, rows)
        eye, forward = np.asarray(self.eye, dtype=np.float64), self.axes[2]
        if self.parallel_width_mm is not None:
            return eye + offsets, np.broadcast_to(forward, offsets.shape).copy()
        return np.broadcast_to(eye, offsets.shape).copy(), unit(offsets + forward)

    def project(self, points: Floats) -> tuple[Floats, Floats]:
        """Return where points are seen, and how deep they lie.

        Parameters
        ----------
        points
            (..., 3) world points in mm.

        Returns
        -------
        (..., 2) columns and rows, nan for a point at or behind a perspective camera's eye, and the
        (...) depths in mm from the eye along the line of sight to the target.
        """
        right, down, forward = self.axes
        ways = np.asarray(points, dtype=np.float64) - np.asarray(self.eye, dtype=np.float64)
        depth = dots(ways, forward)
        scale = np.full(depth.shape, self.pitch)
        if self.parallel_width_mm is None:
            scale = np.where(depth > 0.0, depth * self.pitch, np.nan)
        column = dots(ways, right) / scale + (self.columns - 1) / 2 - self.shift_px
        row = dots(ways, down) / scale + (self.rows - 1) / 2
        return np.stack([column, row], axis=-1), depth

    @property
    def matrix(self) -> Floats:
        """(3, 4) world mm to homogeneous (column, row); the third is the depth, or 1 if parallel.

        As the projection matrix of an X-ray view has it (docs/methods/geometry.md).
        """
        right, down, forward = self.axes
        middle = np.array([(self.columns - 1) / 2 - self.shift_px, (self.rows - 1) / 2])
        across = np.stack([right, down]) / self.pitch
        eye = np.asarray(self.eye, dtype=np.float64)
        if self.parallel_width_mm is not None:
            rows = np.column_stack([across, middle - across @ eye])
            return np.vstack([rows, [0.0, 0.0, 0.0, 1.0]])
        turned = np.vstack([across + np.outer(middle, forward), forward])
        return np.column_stack([turned, -turned @ eye])
