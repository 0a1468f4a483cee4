"""The screen that a pair is looked at on: from pixels of disparity to degrees.

The eyes, ``ipd_mm`` apart, are ``distance_mm`` before the screen, and a pixel of the picture is a
pixel of the screen. Fixing a point of the screen they converge by 2 atan(ipd / 2D). A point whose
images are P mm apart, the left eye's to the right, asks for 2 atan((ipd + P) / 2D); the difference
is its disparity in degrees, as it is straight ahead.
"""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from phantom.document.asked import Asked
from phantom.document.base import Length, told

Floats = NDArray[np.float64]


class Screen(Asked):
    """What a pair is shown on, and who looks at it."""

    place: ClassVar[str] = "/stereo/screen"

    pixel_pitch_mm: Annotated[
        Length, told("Pixel pitch", "mm", "Of the screen; a pixel of the picture is one of these.")
    ] = 0.27
    distance_mm: Annotated[Length, told("Distance", "mm", "From the eyes to the screen.")] = 600.0
    ipd_mm: Annotated[
        Length, told("Eye distance", "mm", "Between the pupils; adults have 63 on average.")
    ] = 63.0

    def degrees(self, pixels: Floats | float) -> Floats:
        """Return disparities of so many pixels in degrees; crossed ones are positive."""
        apart = self.ipd_mm + np.asarray(pixels, dtype=np.float64) * self.pixel_pitch_mm
        twice = 2.0 * self.distance_mm
        found: Floats = np.degrees(
            2.0 * (np.arctan2(apart, twice) - np.arctan2(self.ipd_mm, twice))
        )
        return found

    def vertical_degrees(self, pixels: Floats | float) -> Floats:
        """Return how far apart two pixels are, seen from before the screen, in degrees."""
        apart = np.asarray(pixels, dtype=np.float64) * self.pixel_pitch_mm
        found: Floats = np.degrees(2.0 * np.arctan2(apart, 2.0 * self.distance_mm))
        return found

    @property
    def parallel_px(self) -> float:
        """The uncrossed disparity at which the eyes look straight ahead, in pixels."""
        return self.ipd_mm / self.pixel_pitch_mm
