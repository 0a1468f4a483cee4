"""A pair of pictures as a person asks for it."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.asked import Asked
from phantom.document.base import Length, Number, by_shape, refuse, told
from phantom.stereo.screen import Screen

MAX_ANGLE_DEG: Final = 120.0

USUAL: Final = {"shift": 65.0, "rotate": 6.0}
"""The separation that is kept where it is comfortable: about that of the eyes, in mm, and that of a
pair of breasts, in degrees."""

OF_METHOD: Final = {"baseline_mm": "shift", "angle_deg": "rotate"}
"""The fields that only one method has."""


class ZeroPlane(Asked):
    """The plane, along the detector, that is seen in the screen."""

    place: ClassVar[str] = "/stereo/zero_parallax"

    plane_mm: Annotated[
        Number, told("Plane", "mm", "Depth from the source, at a right angle to the detector.")
    ]

    @field_validator("plane_mm")
    @classmethod
    def _is_before_the_source(cls, value: float) -> float:
        if value <= 0.0:
            message = f"found {value:g} mm, at or behind the source; expected more than 0"
            refuse("behind_source", ((), message))
        return value


class Stereo(Asked):
    """Two eyes; what is left out gets a default that can be fused."""

    place: ClassVar[str] = "/stereo"

    method: Annotated[
        Literal["shift", "rotate"],
        told(
            "Method",
            "none",
            "shift: the tube moves along the detector's rows, which stay in their plane;"
            " rotate: the object turns about the picture's vertical.",
        ),
    ] = "shift"
    baseline_mm: Annotated[
        Annotated[
            Length | Literal["auto"],
            by_shape("number", "string", expected="a length in mm, or 'auto'"),
        ]
        | None,
        told(
            "Baseline",
            "mm",
            "Between the two places of the tube, for shift; auto is the largest with which nothing"
            " is more than 1 degree from the screen. By default 65, or auto where that is less.",
        ),
    ] = None
    angle_deg: Annotated[
        Annotated[
            Annotated[Number, Field(gt=0, le=MAX_ANGLE_DEG)] | Literal["auto"],
            by_shape("number", "string", expected="an angle in degrees, or 'auto'"),
        ]
        | None,
        told(
            "Angle",
            "degrees",
            "Between the two poses of the object, for rotate; auto as for the baseline. By default"
            " 6, or auto where that is less.",
        ),
    ] = None
    zero_parallax: Annotated[
        Annotated[
            Literal["isocentre", "detector"] | ZeroPlane,
            by_shape("string", "object", expected="isocentre, detector or an object with plane_mm"),
        ],
        told("Zero parallax", "none", "What is seen in the plane of the screen."),
    ] = "isocentre"
    screen: Annotated[Screen, told("Screen", "none", "What the pair is shown on.")] = Screen()
    dose: Annotated[
        Literal["split", "per_image"],
        told(
            "Dose",
            "none",
            "split: each image has half, so that the pair costs what one image does;"
            " per_image: each has all of it.",
        ),
    ] = "split"
    mono: Annotated[
        Literal["same_image", "single"] | None,
        told(
            "Mono",
            "none",
            "The arm without depth, of one image with all of the dose: same_image shows it to"
            " both eyes, single gives it once; null for a pair.",
        ),
    ] = None

    @field_validator("baseline_mm", "angle_deg")
    @classmethod
    def _has_an_effect(cls, value: float | str | None, info: ValidationInfo) -> float | str | None:
        name, method = str(info.field_name), info.data.get("method")
        if value is not None and method is not None and OF_METHOD[name] != method:
            message = (
                f"found {name} with method {method!r}; expected it only with {OF_METHOD[name]!r}"
            )
            refuse("no_effect", ((), message))
        return value

    @property
    def separation(self) -> float | Literal["auto"] | None:
        """The baseline in mm or the angle in degrees, as the method has it, as it was asked for."""
        return self.baseline_mm if self.method == "shift" else self.angle_deg
