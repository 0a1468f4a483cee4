"""A preset view as a person asks for it: a clinical word, distances and a grid of pixels."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator

from phantom.document.asked import Asked, plain
from phantom.document.base import Length, Number, Point, refuse, told
from phantom.document.pixels import Side, within_pixels
from phantom.imaging.poses import WITH_ANGLE, WITH_LATERALITY, Laterality, PresetName
from phantom.imaging.view import Pitch

PREVIEW_PIXELS: Final = 1024
SOURCE_DETECTOR_MM: Final = 1150.0

_Turn = Annotated[Number, Field(ge=-180, le=180)]


class Preset(Asked):
    """A view by its clinical word; what is left out gets a default."""

    place: ClassVar[str] = "/view"

    preset: Annotated[PresetName, told("Preset", "none", "The clinical word for the pose.")]
    source_detector_mm: Annotated[
        Length, told("Source to detector", "mm", "Along the central ray.")
    ] = SOURCE_DETECTOR_MM
    source_object_mm: Annotated[
        Length | None, told("Source to object", "mm", "From the source to the isocentre.")
    ] = None
    object_detector_mm: Annotated[
        Length | None,
        told(
            "Object to detector", "mm", "From isocentre to detector, instead of source_object_mm."
        ),
    ] = None
    isocentre: Annotated[
        Point | None,
        BeforeValidator(plain),
        told("Isocentre", "mm", "Where the central ray aims; by default the phantom's own."),
    ] = None
    angle_deg: Annotated[
        Annotated[Number, Field(ge=0, le=90)] | None,
        told("Angle", "degrees", "Of lao, rao, lpo, rpo and mlo; 45 by default."),
    ] = None
    primary_angle_deg: Annotated[
        _Turn | None,
        told("Primary angle", "degrees", "DICOM positioner angle of c_arm, toward the left."),
    ] = None
    secondary_angle_deg: Annotated[
        Annotated[Number, Field(ge=-90, le=90)] | None,
        told("Secondary angle", "degrees", "DICOM positioner angle of c_arm, toward the head."),
    ] = None
    laterality: Annotated[
        Laterality | None,
        told("Laterality", "none", "The limb or breast; by default the phantom's own, else right."),
    ] = None

    @field_validator("angle_deg", "primary_angle_deg", "secondary_angle_deg", "laterality")
    @classmethod
    def _has_an_effect(cls, value: object, info: ValidationInfo) -> object:
        preset, name = info.data.get("preset"), str(info.field_name)
        turned = {"angle_deg": WITH_ANGLE, "laterality": WITH_LATERALITY}.get(name, {"c_arm"})
        if value is not None and preset is not None and preset not in turned:
            words = ", ".join(sorted(turned))
            message = f"found {value!r} with {preset!r}; expected {name} only with {words}"
            refuse("no_effect", ((), message))
        return value

    @field_validator("source_object_mm", "object_detector_mm")
    @classmethod
    def _lies_between(cls, value: float | None, info: ValidationInfo) -> float | None:
        whole = info.data.get("source_detector_mm")
        if value is not None and whole is not None and value >= whole:
            message = f"found {value:g} mm; expected less than source_detector_mm, {whole:g}"
            refuse("too_far", ((), message))
        if value is not None and info.data.get("source_object_mm") is not None:
            message = "found source_object_mm and object_detector_mm; expected one of them"
            refuse("contradiction", ((), message))
        return value


class DetectorGrid(Asked):
    """The pixels of a preset's detector; by default a preview that covers the phantom."""

    place: ClassVar[str] = "/detector"

    columns: Annotated[Side, told("Columns", "pixels", "Pixels in a row.")] = PREVIEW_PIXELS
    rows: Annotated[Side, told("Rows", "pixels", "Pixels in a column.")] = PREVIEW_PIXELS
    pitch_mm: Annotated[
        Pitch | None,
        BeforeValidator(plain),
        told("Pitch", "mm", "Distance of pixel centres; by default such that all is covered."),
    ] = None

    @field_validator("rows")
    @classmethod
    def _is_not_too_large(cls, rows: int, info: ValidationInfo) -> int:
        return within_pixels(rows, info)
