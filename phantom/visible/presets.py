"""Cameras by a word for the side that is looked at, fitted to what is to be seen.

World axes are the patient's: +x to the left, +y to the back, +z to the head. The head is up; from
above the patient's front is at the bottom of the picture, from below it is at the top, as in an
axial section. ``ap``, ``left_lateral`` and ``right_lateral`` show the side that the X-ray view of
that word shows on the light box.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Final, Literal, get_args

import numpy as np
from pydantic import Field, field_validator, model_validator
from pydantic import ValidationInfo as Info

from phantom.document.asked import Asked
from phantom.document.base import Angle, Boolean, Number, refuse, told
from phantom.document.pixels import Side, within_pixels
from phantom.geometry.vectors import box_corners, sine_cosine, unit
from phantom.visible.camera import (
    DEFAULT_FIELD_OF_VIEW_DEG,
    DEFAULT_PIXELS,
    Camera,
    FieldOfView,
    Floats,
)

CameraName = Literal[
    "front",
    "back",
    "left",
    "right",
    "top",
    "bottom",
    "three_quarter",
    "ap",
    "left_lateral",
    "right_lateral",
]
CAMERA_NAMES: Final[tuple[str, ...]] = get_args(CameraName)
"""Every word, in the order in which they are listed to people."""

MARGIN: Final = 1.06
"""How much wider the picture is than what it shows."""

# From the target to the eye: azimuth from the front toward the patient's left, and elevation.
_ANGLES_DEG: Final = {
    "front": (0.0, 0.0),
    "back": (180.0, 0.0),
    "left": (90.0, 0.0),
    "right": (-90.0, 0.0),
    "top": (0.0, 90.0),
    "bottom": (0.0, -90.0),
    "three_quarter": (35.0, 20.0),
    "ap": (0.0, 0.0),
    "left_lateral": (90.0, 0.0),
    "right_lateral": (-90.0, 0.0),
}


class CameraPreset(Asked):
    """A camera by a word; its distance is such that everything to be seen is in the picture."""

    place: ClassVar[str] = "/camera"

    preset: Annotated[
        CameraName | None,
        told("Preset", "none", "The side that is looked at; three_quarter by default."),
    ] = None
    azimuth_deg: Annotated[
        Angle | None,
        told("Azimuth", "degrees", "Of the eye, from the front toward the patient's left."),
    ] = None
    elevation_deg: Annotated[
        Annotated[Number, Field(ge=-90, le=90)] | None,
        told("Elevation", "degrees", "Of the eye, from the horizontal toward the head."),
    ] = None
    parallel: Annotated[
        Boolean, told("Parallel", "none", "Parallel lines of sight instead of perspective.")
    ] = False
    field_of_view_deg: Annotated[
        FieldOfView | None,
        told("Field of view", "degrees", "Across the picture's width; 20 in perspective."),
    ] = None
    zoom: Annotated[
        Annotated[Number, Field(ge=0.1, le=100.0)],
        told("Zoom", "1", "How much larger than fitted; above 1 the edges leave the picture."),
    ] = 1.0
    columns: Annotated[Side, told("Columns", "pixels", "Pixels in a row.")] = DEFAULT_PIXELS
    rows: Annotated[Side, told("Rows", "pixels", "Pixels in a column.")] = DEFAULT_PIXELS

    @field_validator("azimuth_deg", "elevation_deg")
    @classmethod
    def _stands_alone(cls, value: float | None, info: Info) -> float | None:
        preset = info.data.get("preset")
        if value is not None and preset is not None:
            message = f"found {info.field_name} with preset {preset!r}; expected one of them"
            refuse("contradiction", ((), message))
        return value

    @field_validator("rows")
    @classmethod
    def _is_not_too_large(cls, rows: int, info: Info) -> int:
        return within_pixels(rows, info)

    @model_validator(mode="after")
    def _has_an_effect(self) -> CameraPreset:
        if self.parallel and self.field_of_view_deg is not None:
            message = "found a field of view with parallel lines of sight; expected one of them"
            refuse("contradiction", (("field_of_view_deg",), message))
        return self

    @property
    def word(self) -> CameraName | None:
        """The preset; None where angles say where the eye is."""
        if self.azimuth_deg is not None or self.elevation_deg is not None:
            return None
        return self.preset or "three_quarter"

    @property
    def angles_deg(self) -> tuple[float, float]:
        """Azimuth and elevation of the eye."""
        if self.word is not None:
            return _ANGLES_DEG[self.word]
        return self.azimuth_deg or 0.0, self.elevation_deg or 0.0

    def camera(self, bounds: Floats) -> Camera:
        """Return the camera that sees all of some boxes.

        Parameters
        ----------
        bounds
            (..., 2, 3) least and greatest coordinates in mm, such as ``phantom.bounds`` or the
            ``phantom.leaf_bounds`` of the leaves that are shown. The picture's middle is the middle
            of the box around them all.
        """
        boxes = np.asarray(bounds, dtype=np.float64).reshape(-1, 2, 3)
        middle = 0.5 * (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0))
        to_eye, up = _pose(*self.angles_deg)
        right = unit(np.cross(up, to_eye))
        corners = np.concatenate([box_corners(box) for box in boxes]) - middle
        across, above = np.abs(corners @ right), np.abs(corners @ np.cross(to_eye, right))
        near = corners @ to_eye
        widths = 2.0 * MARGIN * np.maximum(across, above * (self.columns / self.rows))
        if self.parallel:
            distance = float(near.max()) + float(np.ptp(near)) + 1.0
            lens = {"parallel_width_mm": float(widths.max()) / self.zoom}
        else:
            half = math.tan(math.radians(self.field_of_view_deg or DEFAULT_FIELD_OF_VIEW_DEG) / 2)
            distance = float((near + widths / (2.0 * half)).max())
            zoomed = 2.0 * math.degrees(math.atan(half / self.zoom))
            lens = {"field_of_view_deg": min(max(zoomed, 0.01), 170.0)}
        eye = middle + distance * to_eye
        return Camera(
            eye=_point(eye),
            target=_point(middle),
            up=_point(up),
            columns=self.columns,
            rows=self.rows,
            **lens,
        )


def preset_camera(
    bounds: Floats,
    preset: CameraName = "three_quarter",
    *,
    columns: int = DEFAULT_PIXELS,
    rows: int = DEFAULT_PIXELS,
    parallel: bool = False,
) -> Camera:
    """Return the camera of a word for some boxes, as :meth:`CameraPreset.camera` does."""
    asked = CameraPreset(preset=preset, columns=columns, rows=rows, parallel=parallel)
    return asked.camera(bounds)


def _pose(azimuth_deg: float, elevation_deg: float) -> tuple[Floats, Floats]:
    """Return the unit vector from the target to the eye, and the one that is up in the picture."""
    sine_a, cosine_a = sine_cosine(azimuth_deg)
    sine_e, cosine_e = sine_cosine(elevation_deg)
    to_eye = np.array([sine_a * cosine_e, -cosine_a * cosine_e, sine_e])
    # Across the line of sight in the plane that holds the body's axis: at the poles too.
    up = np.array([-sine_a * sine_e, cosine_a * sine_e, cosine_e])
    return to_eye, up


def _point(vector: Floats) -> tuple[float, float, float]:
    x, y, z = (float(value) + 0.0 for value in vector)  # no -0
    return x, y, z
