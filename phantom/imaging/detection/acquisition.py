"""How an exposure is made: the dose, the tube's focal spot, scatter, grid and detector."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.asked import Asked
from phantom.document.base import Boolean, Integer, Number, refuse, told
from phantom.imaging.detection.receptor import DetectorModel

AIR_KERMA_UGY: Final = 2.5
"""Air kerma at the detector in the open field, unless asked otherwise."""

_Size = Annotated[Number, Field(gt=0, le=100)]
_Points = Annotated[Integer, Field(ge=1, le=64)]
_Samples = Annotated[Integer, Field(ge=1, le=16)]


class FocalSpot(Asked):
    """The area that X-rays come from, parallel to the detector and centred on the source."""

    place: ClassVar[str] = "/acquisition/focal_spot"

    size_mm: Annotated[
        tuple[_Size, _Size],
        told(
            "Size",
            "mm",
            "Along the detector's right and down: full width, or half-value width of a gaussian.",
        ),
    ]
    shape: Annotated[
        Literal["uniform", "gaussian"], told("Shape", "none", "How the emission is spread.")
    ] = "uniform"
    points: Annotated[
        tuple[_Points, _Points],
        told("Points", "none", "Source points along right and down; each costs a trace."),
    ] = (5, 5)


class Scatter(Asked):
    """Scattered radiation, from the thickness of the object and a broad kernel."""

    place: ClassVar[str] = "/acquisition/scatter"

    air_gap_mm: Annotated[
        Annotated[Number, Field(ge=0, le=1e4)] | None,
        told(
            "Air gap",
            "mm",
            "From the object's exit side to the detector; null takes it from the bounding box.",
        ),
    ] = None


class Grid(Asked):
    """An anti-scatter grid, by the transmissions that IEC 60627 defines."""

    place: ClassVar[str] = "/acquisition/grid"

    primary_transmission: Annotated[
        Annotated[Number, Field(gt=0, le=1)],
        told("Primary transmission", "none", "Fraction of the primary radiation that passes."),
    ]
    scatter_transmission: Annotated[
        Annotated[Number, Field(ge=0, le=1)],
        told("Scatter transmission", "none", "Fraction of the scattered radiation that passes."),
    ]


class Acquisition(Asked):
    """An exposure; every stage that is left out is off."""

    place: ClassVar[str] = "/acquisition"

    detector_air_kerma_ugy: Annotated[
        Annotated[Number, Field(gt=0, le=1e9)] | None,
        told(
            "Detector air kerma",
            "uGy",
            "At the detector's centre in the open field, before any grid; 2.5 unless mas is given.",
        ),
    ] = None
    mas: Annotated[
        Annotated[Number, Field(gt=0, le=1e9)] | None,
        told("Tube load", "mAs", "Instead of the air kerma: with the tube's output."),
    ] = None
    falloff: Annotated[
        Literal["none", "inverse_square_cosine"],
        told("Falloff", "none", "How the open field changes over the detector."),
    ] = "none"
    flat_field: Annotated[
        Boolean, told("Flat field", "none", "Divide by the open field, so that it is even.")
    ] = False
    focal_spot: Annotated[
        FocalSpot | None, told("Focal spot", "none", "Its size; null for a point.")
    ] = None
    scatter: Annotated[Scatter | None, told("Scatter", "none", "The model; null for none.")] = None
    grid: Annotated[Grid | None, told("Grid", "none", "An anti-scatter grid; null for none.")] = (
        None
    )
    samples_per_pixel: Annotated[
        tuple[_Samples, _Samples],
        told("Samples", "none", "Rays a pixel, along right and down; intensities are averaged."),
    ] = (1, 1)
    quantum_noise: Annotated[
        Literal["off", "compound", "per_bin"],
        told(
            "Quantum noise",
            "none",
            "compound: photons drawn at once, their energies by two moments; per_bin: every bin.",
        ),
    ] = "compound"
    detector: Annotated[DetectorModel, told("Detector", "none", "What reads the image.")] = (
        DetectorModel()
    )

    @field_validator("mas")
    @classmethod
    def _is_the_only_dose(cls, mas: float | None, info: ValidationInfo) -> float | None:
        if mas is not None and info.data.get("detector_air_kerma_ugy") is not None:
            message = "found mas and detector_air_kerma_ugy; expected one of them"
            refuse("contradiction", ((), message))
        return mas

    @field_validator("flat_field")
    @classmethod
    def _has_something_to_correct(cls, flat_field: bool, info: ValidationInfo) -> bool:
        if flat_field and info.data.get("falloff") == "none":
            message = "found a flat field without falloff; expected falloff inverse_square_cosine"
            refuse("no_effect", ((), message))
        return flat_field

    @property
    def draws(self) -> bool:
        """Whether anything of the image is random."""
        return self.quantum_noise != "off" or self.detector.electronic_noise > 0
