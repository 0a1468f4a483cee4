"""The detector as a person describes it: what absorbs, what blurs, what is read out.

Its pose and its pixels are those of the view.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.asked import Asked
from phantom.document.base import Integer, Number, refuse, told

AbsorberName = Literal["cesium_iodide", "amorphous_selenium", "gadolinium_oxysulfide"]

ABSORBERS: Final[dict[AbsorberName, dict[str, float]]] = {
    "cesium_iodide": {"Cs": 0.511549, "I": 0.488451},
    "amorphous_selenium": {"Se": 1.0},
    "gadolinium_oxysulfide": {"Gd": 0.830782, "S": 0.084691, "O": 0.084527},
}
"""Mass fractions, from the formulas CsI, Se and Gd2O2S and the 2021 IUPAC atomic weights."""

_Positive = Annotated[Number, Field(gt=0, le=1e12)]
_NotNegative = Annotated[Number, Field(ge=0, le=1e12)]


class Absorber(Asked):
    """The layer that stops the photons."""

    place: ClassVar[str] = "/acquisition/detector/absorber"

    material: Annotated[AbsorberName, told("Material", "none", "What the layer is made of.")]
    thickness_mg_cm2: Annotated[
        Annotated[Number, Field(gt=0, le=1e5)],
        told("Thickness", "mg/cm2", "Mass per area of the layer, without binder and gaps."),
    ]


class Blur(Asked):
    """The detector's modulation transfer function, without the aperture of the pixel."""

    place: ClassVar[str] = "/acquisition/detector/blur"

    shape: Annotated[
        Literal["gaussian", "lorentzian"],
        told("Shape", "none", "MTF(f) = 2^-(f/h)^2 or 1/(1 + (f/h)^2), h its half value."),
    ] = "gaussian"
    half_frequency_per_mm: Annotated[
        Annotated[Number, Field(ge=1e-3, le=1e6)],
        told("Half value", "line pairs/mm", "Spatial frequency at which the MTF is one half."),
    ]


class Digitizer(Asked):
    """From the analogue signal to whole codes."""

    place: ClassVar[str] = "/acquisition/detector/digitizer"

    bits: Annotated[
        Annotated[Integer, Field(ge=1, le=24)], told("Depth", "bits", "The greatest code is 2^n-1.")
    ] = 14
    codes_per_signal: Annotated[
        _Positive, told("Gain", "codes per unit of signal", "Slope of the conversion.")
    ]
    offset_codes: Annotated[_NotNegative, told("Offset", "codes", "The code of no signal.")] = 0.0
    saturation_signal: Annotated[
        _Positive | None,
        told("Saturation", "unit of signal", "More than this is read as this; null for no limit."),
    ] = None


class DetectorModel(Asked):
    """What the detector does with the photons; by default it is ideal and gives the energy."""

    place: ClassVar[str] = "/acquisition/detector"

    response: Annotated[
        Literal["energy_integrating", "photon_counting"],
        told("Response", "none", "What a stopped photon adds to the signal: its energy, or one."),
    ] = "energy_integrating"
    absorber: Annotated[
        Absorber | None, told("Absorber", "none", "The layer; null stops every photon.")
    ] = None
    gain_per_kev: Annotated[
        _Positive, told("Gain", "signal per keV", "Signal of one keV of absorbed energy.")
    ] = 1.0
    swank_factor: Annotated[
        Annotated[Number, Field(gt=0, le=1)],
        told("Swank factor", "none", "Squared mean gain over mean squared gain of one photon."),
    ] = 1.0
    blur: Annotated[Blur | None, told("Blur", "none", "The MTF; null for none.")] = None
    electronic_noise: Annotated[
        _NotNegative,
        told("Electronic noise", "unit of signal", "Standard deviation in a pixel, after blur."),
    ] = 0.0
    digitizer: Annotated[
        Digitizer | None, told("Digitizer", "none", "Gain, saturation and bits; null for none.")
    ] = None

    @field_validator("gain_per_kev", "swank_factor")
    @classmethod
    def _has_an_effect(cls, value: float, info: ValidationInfo) -> float:
        if info.data.get("response") == "photon_counting" and value != 1.0:
            message = f"found {value:g} with a detector that counts photons; expected 1"
            refuse("no_effect", ((), message))
        return value

    @property
    def unit(self) -> str:
        """The unit of the signal before it is digitised."""
        if self.response == "photon_counting":
            return "photons"
        return "keV" if self.gain_per_kev == 1.0 else "signal"
