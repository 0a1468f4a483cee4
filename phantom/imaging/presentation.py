"""From a quantity to grey levels.

The paper's contrast stretching (section II.I): the least value becomes 0 and the greatest full
scale, linearly. Polarity: bones white is full scale minus the stretched transmission; bones dark,
the paper's, is the stretched transmission itself.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from phantom.document.base import told
from phantom.imaging.asked import Asked

GreyArray = NDArray[np.uint8] | NDArray[np.uint16]


class Presentation(Asked):
    """How a quantity becomes grey levels."""

    place: ClassVar[str] = "/presentation"

    mode: Annotated[
        Literal["stretch"], told("Mode", "none", "stretch: least to 0, greatest to full scale.")
    ] = "stretch"
    polarity: Annotated[
        Literal["bones_white", "bones_dark"],
        told("Polarity", "none", "Which end of the scale much attenuation has."),
    ] = "bones_white"
    bits: Annotated[Literal[8, 16], told("Depth", "bits", "Of a grey level.")] = 8

    @property
    def full_scale(self) -> int:
        """The greatest grey level."""
        return int(2**self.bits - 1)


def present(
    image: NDArray[np.floating],
    presentation: Presentation | None = None,
    *,
    rises_with_attenuation: bool = False,
) -> GreyArray:
    """Return an image's grey levels, uint8 or uint16.

    A constant image gives 0 throughout, in either polarity.

    Parameters
    ----------
    image
        (rows, columns), finite.
    presentation
        How; by default stretched, bones white, 8 bits.
    rises_with_attenuation
        True for a line integral, whose greatest values are the bones'.
    """
    presentation = presentation if presentation is not None else Presentation()
    depth = np.uint8 if presentation.bits == 8 else np.uint16
    least, greatest = float(image.min()), float(image.max())
    if not greatest > least:
        return np.zeros(image.shape, dtype=depth)
    # Values are brought to [0, 1] first, so that the greatest reaches full scale exactly.
    stretched = np.subtract(image, least, dtype=np.float64)
    stretched /= greatest - least
    stretched *= presentation.full_scale
    np.rint(stretched, out=stretched)
    if (presentation.polarity == "bones_white") != rises_with_attenuation:
        np.subtract(presentation.full_scale, stretched, out=stretched)
    grey: GreyArray = stretched.astype(depth)
    return grey
