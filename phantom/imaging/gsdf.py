"""The Grayscale Standard Display Function: luminance in steps that are just noticed.

DICOM PS3.14, section 7: the luminance L (cd/m²) of the JND index j, from 0.05 cd/m² at 1 to
3993.404 cd/m² at 1023, fitted to the contrast sensitivity of P. G. J. Barten's model of the eye.
One step of j is one just-noticeable difference of the standard target, a grating of 4 cycles per
degree, 2° wide, on a ground of its own mean luminance.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, ClassVar, Final, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, ValidationInfo, field_validator, model_validator

from phantom.document.asked import Asked
from phantom.document.base import Integer, Number, refuse, told
from phantom.errors import InvalidInputError, Problem

FloatArray = NDArray[np.float64]

LEAST_JND: Final = 1.0
GREATEST_JND: Final = 1023.0
LEAST_CD_M2: Final = 0.05
GREATEST_CD_M2: Final = 3993.404
"""Ends of the function (PS3.14, table B-1); its printed coefficients give 3993.33 at 1023."""

_NUMERATOR: Final = (-1.3011877, 8.0242636e-2, 1.3646699e-1, -2.5468404e-2, 1.3635334e-3)
_DENOMINATOR: Final = (
    1.0,
    -2.5840191e-2,
    -1.0320229e-1,
    2.8745620e-2,
    -3.1978977e-3,
    1.2992634e-4,
)
"""Of log10 L by rising powers of ln j (PS3.14, equation 7-1: a c e g m, and 1 b d f h k)."""

_STEPS_PER_JND: Final = 64

Luminance = Annotated[Number, Field(gt=0, le=1e5)]
Level = Annotated[Integer, Field(ge=0, le=65535)]


def luminance_cd_m2(jnd_index: ArrayLike) -> FloatArray:
    """Return the luminance of JND indices from 1 to 1023, in cd/m² (PS3.14, equation 7-1)."""
    log = np.log(np.asarray(jnd_index, dtype=np.float64))
    above = np.polynomial.polynomial.polyval(log, _NUMERATOR)
    below = np.polynomial.polynomial.polyval(log, _DENOMINATOR)
    found: FloatArray = 10.0 ** (above / below)
    return found


def jnd_index(luminance: ArrayLike) -> FloatArray:
    """Return the JND index of luminances in cd/m²; the function's end beyond its ends.

    It inverts :func:`luminance_cd_m2`, to 1e-5; the polynomial that the standard has for it
    (equation 7-2) is an approximation, off by up to 0.1.
    """
    count = int((GREATEST_JND - LEAST_JND) * _STEPS_PER_JND) + 1
    indices = np.linspace(LEAST_JND, GREATEST_JND, count)
    logs = np.log10(np.maximum(np.asarray(luminance, dtype=np.float64), 1e-300))
    found: FloatArray = np.interp(logs, np.log10(luminance_cd_m2(indices)), indices)
    return found


class Gsdf(Asked):
    """The display that a picture is meant for.

    Without ``response`` it is one that follows the standard by itself: grey levels are P-values,
    whose equal steps are equally many just-noticeable differences. With ``response`` the display
    is as measured, and grey levels are the drive levels that make it follow the standard.
    """

    place: ClassVar[str] = "/presentation/gsdf"

    l_min_cd_m2: Annotated[
        Luminance, told("Least luminance", "cd/m²", "Of the display alone, for black.")
    ]
    l_max_cd_m2: Annotated[
        Luminance, told("Greatest luminance", "cd/m²", "Of the display alone, for white.")
    ]
    l_ambient_cd_m2: Annotated[
        Annotated[Number, Field(ge=0, le=1e5)],
        told("Ambient luminance", "cd/m²", "What the room's light adds everywhere."),
    ] = 0.0
    response: Annotated[
        tuple[tuple[Level, Luminance], ...] | None,
        told(
            "Response",
            "cd/m²",
            "Drive level and luminance without ambient light, measured, both rising.",
        ),
    ] = None

    @field_validator("l_max_cd_m2")
    @classmethod
    def _is_brighter(cls, value: float, info: ValidationInfo) -> float:
        least = info.data.get("l_min_cd_m2")
        if least is not None and value <= least:
            message = f"found {value:g} cd/m²; expected more than l_min_cd_m2, {least:g}"
            refuse("not_rising", ((), message))
        return value

    @field_validator("response")
    @classmethod
    def _rises(
        cls, value: tuple[tuple[int, float], ...] | None
    ) -> tuple[tuple[int, float], ...] | None:
        if value is None:
            return None
        if len(value) < 2:
            refuse("too_few", ((), f"found {len(value)} measurements; expected 2 or more"))
        for i, (one, other) in enumerate(pairwise(value)):
            for k, name in enumerate(("level", "luminance")):
                if other[k] <= one[k]:
                    message = f"found a {name} of {other[k]:g} after {one[k]:g}; expected more"
                    refuse("not_rising", ((i + 1, k), message))
        return value

    @model_validator(mode="after")
    def _is_within_reach(self) -> Self:
        least = self.l_min_cd_m2 + self.l_ambient_cd_m2
        if least < LEAST_CD_M2:
            message = f"found {least:g} cd/m² with ambient light"
            expected = f"expected {LEAST_CD_M2:g} or more, where the standard begins"
            refuse("out_of_range", (("l_min_cd_m2",), f"{message}; {expected}"))
        greatest = self.l_max_cd_m2 + self.l_ambient_cd_m2
        if greatest > GREATEST_CD_M2:
            message = f"found {greatest:g} cd/m² with ambient light"
            expected = f"expected {GREATEST_CD_M2:g} at most, where the standard ends"
            refuse("out_of_range", (("l_max_cd_m2",), f"{message}; {expected}"))
        if self.response is not None:
            first, last = self.response[0][1], self.response[-1][1]
            for name in ("l_min_cd_m2", "l_max_cd_m2"):
                value = getattr(self, name)
                if not first <= value <= last:
                    message = f"found {value:g} cd/m²; expected {first:g} to {last:g}, as measured"
                    refuse("out_of_range", ((name,), message))
        return self

    @property
    def jnd_range(self) -> tuple[float, float]:
        """JND indices of black and white, ambient light included."""
        ends = np.array([self.l_min_cd_m2, self.l_max_cd_m2]) + self.l_ambient_cd_m2
        black, white = jnd_index(ends)
        return float(black), float(white)

    def jnd_of_fraction(self, fraction: ArrayLike) -> FloatArray:
        """Return the JND index at which fractions of the grey scale, 0 to 1, are shown."""
        black, white = self.jnd_range
        found: FloatArray = black + np.asarray(fraction, dtype=np.float64) * (white - black)
        return found

    def drive_levels(self, fraction: ArrayLike) -> FloatArray:
        """Return the levels, not rounded, that show fractions of the grey scale by the standard.

        Between measurements the level runs evenly with the JND index.
        """
        if self.response is None:
            message = "found no response; expected one, for drive levels"
            raise InvalidInputError([Problem(f"{self.place}/response", "missing", message)])
        levels, measured = self._measured()
        found: FloatArray = np.interp(self.jnd_of_fraction(fraction), measured, levels)
        return found

    def jnd_of_levels(self, levels: ArrayLike, full_scale: int) -> FloatArray:
        """Return the JND index at which grey levels of a picture are seen.

        They are P-values up to ``full_scale`` or, with a response, drive levels.
        """
        if self.response is None:
            return self.jnd_of_fraction(np.asarray(levels, dtype=np.float64) / full_scale)
        known, measured = self._measured()
        found: FloatArray = np.interp(np.asarray(levels, dtype=np.float64), known, measured)
        return found

    def _measured(self) -> tuple[FloatArray, FloatArray]:
        """Return the measured drive levels and their JND indices."""
        table = np.array(self.response, dtype=np.float64)
        return table[:, 0], jnd_index(table[:, 1] + self.l_ambient_cd_m2)
