"""From a quantity to grey levels.

The share of the grey scale comes from one of four modes (`phantom.imaging.grey_scales`), then the
polarity, then the display (`phantom.imaging.gsdf`), and last the rounding to whole levels.

Polarity: bones white is full scale minus the stretched transmission; bones dark, the paper's, is
the stretched transmission itself.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo, field_validator, model_validator

from phantom.document.asked import Asked
from phantom.document.base import Number, refuse, told
from phantom.errors import InvalidInputError, Problem
from phantom.imaging.grey_scales import between_percentiles, equalised, stretched, windowed
from phantom.imaging.gsdf import Gsdf

GreyArray = NDArray[np.uint8] | NDArray[np.uint16]
FloatArray = NDArray[np.float64]

Percent = Annotated[Number, Field(ge=0, le=100)]

USUAL_PERCENTILES = (1.0, 99.0)

OF_MODE = {"window_center": "window", "window_width": "window", "percentiles": "percentile"}
"""The fields that only one mode has."""


class Presentation(Asked):
    """How a quantity becomes grey levels.

    What is left out is filled in: ``mode`` from the fields of a mode, ``scope`` from the mode.
    """

    place: ClassVar[str] = "/presentation"

    mode: Annotated[
        Literal["stretch", "window", "percentile", "equalise"],
        told(
            "Mode",
            "none",
            "stretch: least to 0, greatest to full scale; window: a range of line integrals;"
            " percentile: a range of the image's own values; equalise: by the histogram.",
        ),
    ] = "stretch"
    scope: Annotated[
        Literal["image", "pair", "fixed"],
        told(
            "Scope",
            "none",
            "What the mapping depends on: the image's values, those of both images of a pair"
            " (where there is one, the default), or nothing but the window.",
        ),
    ] = "image"
    window_center: Annotated[
        Number | None,
        told("Window centre", "none", "Line integral in the middle of the scale; for window."),
    ] = None
    window_width: Annotated[
        Number | None,
        told("Window width", "none", "Line integrals that the scale spans; for window."),
    ] = None
    percentiles: Annotated[
        tuple[Percent, Percent] | None,
        told("Percentiles", "%", "What becomes 0 and full scale; for percentile."),
    ] = None
    polarity: Annotated[
        Literal["bones_white", "bones_dark"],
        told("Polarity", "none", "Which end of the scale much attenuation has."),
    ] = "bones_white"
    bits: Annotated[Literal[8, 16], told("Depth", "bits", "Of a grey level.")] = 8
    gsdf: Annotated[
        Gsdf | None, told("Display", "none", "The display that grey levels are meant for.")
    ] = None

    @field_validator("window_width")
    @classmethod
    def _has_a_width(cls, value: float | None) -> float | None:
        if value is not None and value <= 0:
            refuse("out_of_range", ((), f"found {value:g}; expected more than 0"))
        return value

    @field_validator("percentiles")
    @classmethod
    def _rise(cls, value: tuple[float, float] | None) -> tuple[float, float] | None:
        if value is not None and value[0] >= value[1]:
            message = f"found {value[0]:g} and {value[1]:g}; expected the second to be greater"
            refuse("not_rising", ((), message))
        return value

    @field_validator("gsdf")
    @classmethod
    def _has_room(cls, value: Gsdf | None, info: ValidationInfo) -> Gsdf | None:
        bits = info.data.get("bits")
        if value is not None and value.response is not None and bits is not None:
            greatest, full = value.response[-1][0], 2**bits - 1
            if greatest > full:
                message = f"found a level of {greatest}; expected {full} at most, for {bits} bits"
                where = ("response", len(value.response) - 1, 0)
                refuse("out_of_range", (where, message))
        return value

    @model_validator(mode="after")
    def _is_whole(self) -> Self:
        # Straight into the model, which is frozen for others: null is not said.
        silent = {name for name in self.model_fields_set if getattr(self, name) is None}
        self.__pydantic_fields_set__.difference_update(silent)
        said = {name: mode for name, mode in OF_MODE.items() if getattr(self, name) is not None}
        if "mode" not in self.model_fields_set:
            wanted = [*said.values(), *(("window",) if self.scope == "fixed" else ())]
            if wanted:
                self.__dict__["mode"] = wanted[0]
        idle = [name for name, mode in said.items() if mode != self.mode]
        if idle:
            expected = "expected it only with mode"
            refuse(
                "no_effect",
                *(
                    ((n,), f"found {n} with mode {self.mode!r}; {expected} {said[n]!r}")
                    for n in idle
                ),
            )
        if (self.window_center is None) != (self.window_width is None):
            missing = "window_center" if self.window_center is None else "window_width"
            refuse("missing", ((missing,), "missing; expected both a centre and a width"))
        own = ("fixed",) if self.mode == "window" else ("image", "pair")
        if "scope" not in self.model_fields_set:
            self.__dict__["scope"] = own[0]
        elif self.scope not in own:
            expected = " or ".join(map(repr, own))
            message = f"found {self.scope!r} with mode {self.mode!r}; expected {expected}"
            refuse("contradiction", (("scope",), message))
        if self.mode == "percentile" and self.percentiles is None:
            self.__dict__["percentiles"] = USUAL_PERCENTILES
        return self

    @property
    def of_pair(self) -> Presentation:
        """The same for a pair, whose two images share one mapping unless it was said otherwise."""
        if "scope" in self.model_fields_set or self.mode == "window":
            return self
        return self.model_copy(update={"scope": "pair"})

    def check_alone(self) -> None:
        """Refuse the scope of a pair for an image by itself (``/presentation/scope``)."""
        if self.scope == "pair":
            message = "found 'pair' for one image; expected 'image', or a pair"
            raise InvalidInputError([Problem(f"{self.place}/scope", "no_pair", message)])

    @property
    def full_scale(self) -> int:
        """The greatest grey level."""
        return int(2**self.bits - 1)

    @property
    def window(self) -> tuple[float, float]:
        """Centre and width of the window.

        Raises
        ------
        InvalidInputError
            There is none: a phantom without a window of its own needs one from the caller.
        """
        if self.window_center is None or self.window_width is None:
            message = "missing; expected a window, for this phantom and view have none of their own"
            raise InvalidInputError([Problem(f"{self.place}/window_center", "missing", message)])
        return self.window_center, self.window_width


def present(
    image: NDArray[np.floating],
    presentation: Presentation | None = None,
    *,
    rises_with_attenuation: bool = False,
    open_field: float = 1.0,
) -> GreyArray:
    """Return an image's grey levels, uint8 or uint16.

    A constant image gives 0 throughout, in either polarity and whatever the mode.

    Parameters
    ----------
    image
        (rows, columns), finite; a line integral may be infinite where a window is applied.
    presentation
        How; by default stretched, bones white, 8 bits.
    rises_with_attenuation
        True for a line integral, whose greatest values are the bones'.
    open_field
        Value of a pixel that nothing is in front of, for the window of a quantity that falls with
        attenuation: the window is on −ln(value / open_field).
    """
    presentation = presentation if presentation is not None else Presentation()
    share = _share(image, presentation, rises_with_attenuation, open_field)
    if share is None:
        return _whole(np.zeros(image.shape), presentation.bits)
    rises = rises_with_attenuation or presentation.mode in ("window", "equalise")
    falls = (presentation.polarity == "bones_white") != rises
    if presentation.gsdf is not None and presentation.gsdf.response is not None:
        # Drive levels come from the share itself, so that nothing is rounded twice.
        levels = presentation.gsdf.drive_levels(1.0 - share if falls else share)
        return _whole(np.rint(levels), presentation.bits)
    share *= presentation.full_scale
    np.rint(share, out=share)
    if falls:
        np.subtract(presentation.full_scale, share, out=share)
    return _whole(share, presentation.bits)


def _share(
    image: NDArray[np.floating], presentation: Presentation, rises: bool, open_field: float
) -> FloatArray | None:
    """Return shares of the grey scale; window and equalisation rise with attenuation."""
    if presentation.mode == "window":
        if rises:
            return windowed(np.asarray(image, dtype=np.float64), *presentation.window)
        with np.errstate(divide="ignore"):  # no signal at all is the far end of any window
            logs = -np.log(np.maximum(np.divide(image, open_field, dtype=np.float64), 0.0))
        return windowed(logs, *presentation.window)
    if presentation.mode == "equalise":
        return equalised(image if rises else -image)
    if presentation.mode == "percentile":
        return between_percentiles(image, presentation.percentiles or USUAL_PERCENTILES)
    return stretched(image)


def _whole(levels: FloatArray, bits: int) -> GreyArray:
    return levels.astype(np.uint8) if bits == 8 else levels.astype(np.uint16)


def contrast_jnd(
    grey: GreyArray,
    inside: NDArray[np.bool_],
    around: NDArray[np.bool_],
    presentation: Presentation,
) -> float:
    """Return how many just-noticeable differences a lesion stands out from what is around it.

    The JND index of every pixel on the display, its mean over the lesion less its mean over the
    surroundings: positive where the lesion is brighter. One is what an average eye just notices of
    the standard target, not of this lesion in this anatomy.

    Parameters
    ----------
    grey
        (rows, columns) grey levels, made by :func:`present` with this presentation.
    inside, around
        (rows, columns) masks of some pixels each.
    presentation
        With a ``gsdf``, which says what the display is.

    Raises
    ------
    InvalidInputError
        No display is given, or a mask is empty or of another shape.
    """
    problems = []
    if presentation.gsdf is None:
        message = "missing; expected a display, for its luminances count"
        problems.append(Problem(f"{presentation.place}/gsdf", "missing", message))
    for name, mask in (("inside", inside), ("around", around)):
        if mask.shape != grey.shape:
            message = f"found shape {mask.shape}; expected that of the image, {grey.shape}"
            problems.append(Problem(f"/{name}", "wrong_shape", message))
        elif not mask.any():
            problems.append(Problem(f"/{name}", "empty", "found no pixel; expected some"))
    if problems or presentation.gsdf is None:
        raise InvalidInputError(problems)
    index = presentation.gsdf.jnd_of_levels(grey, presentation.full_scale)
    return float(index[inside].mean() - index[around].mean())
