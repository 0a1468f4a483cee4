"""From the intensities of a colour picture to whole levels.

``stretch`` is the paper's (II.I): one mapping for red, green and blue, from the least and the
greatest value of all three, so that colours stay true. ``srgb`` does not depend on the picture: 0
to 1 along the curve of IEC 61966-2-1, which screens expect; what is beyond is cut off.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from phantom.document.asked import Asked
from phantom.document.base import told

Floats = NDArray[np.float64]
Levels = NDArray[np.uint8] | NDArray[np.uint16]


class Tone(Asked):
    """How intensities become levels."""

    place: ClassVar[str] = "/tone"

    mode: Annotated[
        Literal["srgb", "stretch"],
        told(
            "Mode",
            "none",
            "srgb: 0 to 1 along the curve screens expect; stretch: the least of all red, green and"
            " blue values to 0 and the greatest to full scale, linearly (the paper).",
        ),
    ] = "srgb"
    bits: Annotated[Literal[8, 16], told("Depth", "bits", "Of a level.")] = 8


def toned(rgb: Floats, tone: Tone) -> Levels:
    """Return the levels of a picture, uint8 or uint16.

    Parameters
    ----------
    rgb
        (rows, columns, 3) intensities. A constant picture stretches to 0 throughout.
    tone
        How.
    """
    if tone.mode == "srgb":
        share = srgb(rgb)
    else:
        least, greatest = float(rgb.min()), float(rgb.max())
        width = greatest - least
        share = (rgb - least) / width if width > 0.0 else np.zeros(rgb.shape)
    levels = np.rint(share * (2**tone.bits - 1))
    if tone.bits == 8:
        return np.asarray(levels, dtype=np.uint8)
    return np.asarray(levels, dtype=np.uint16)


def srgb(rgb: Floats) -> Floats:
    """Return the sRGB values of linear light, both from 0 to 1 (IEC 61966-2-1)."""
    light = np.clip(rgb, 0.0, 1.0)
    curved = 1.055 * light ** (1 / 2.4) - 0.055
    return np.asarray(np.where(light <= 0.0031308, 12.92 * light, curved))
