"""A person's frame: the points of the drawn chest moved to where this person has them.

The tables of this package draw one man, in mm: x = 0 is the middle, z = 0 the middle of the seventh
thoracic vertebra, y = 0 about midway between breastbone and back. `Frame` stretches them along the
three axes and bends the chest to the person's kyphosis. Thicknesses of bones are not stretched.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from phantom.document import Point
from phantoms.chest.arms import GIRDLES, Arms, Girdle
from phantoms.chest.parameters import MODEL_HEIGHT_CM, Sizes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

MODEL_WIDTH_MM: Final = 272.4
MODEL_DEPTH_MM: Final = 176.0
MODEL_LUNG_HEIGHT_MM: Final = 210.0
MODEL_HEART_MM: Final = 122.8
MODEL_KYPHOSIS_DEG: Final = 25.0
KYPHOSIS_SPAN_MM: Final = 163.0
"""From T3 to T10 along the drawn spine."""


@dataclass(frozen=True)
class Frame:
    """How the drawn chest becomes a person's.

    Attributes
    ----------
    sizes
        The person's lengths.
    height_cm
        Stature; the spine keeps its share of it.
    bone
        Factor of the thicknesses of vertebrae and shoulder bones.
    arms
        Whether the arms hang or are raised.
    """

    sizes: Sizes
    height_cm: float
    bone: float
    arms: Arms = "at_sides"

    @property
    def x(self) -> float:
        """Stretch across."""
        return self.sizes.chest_width_mm / MODEL_WIDTH_MM

    @property
    def y(self) -> float:
        """Stretch from front to back."""
        return self.sizes.chest_depth_mm / MODEL_DEPTH_MM

    @property
    def z(self) -> float:
        """Stretch along the spine."""
        return self.height_cm / MODEL_HEIGHT_CM

    @property
    def girdle(self) -> Girdle:
        """The drawn pose of the shoulders."""
        return GIRDLES[self.arms]

    @cached_property
    def _bend_per_mm(self) -> float:
        more = math.radians(self.sizes.kyphosis_deg - MODEL_KYPHOSIS_DEG)
        return more / (2.0 * KYPHOSIS_SPAN_MM * self.z)

    def lean(self, z_mm: float) -> float:
        """Return how far the chest leans back at a height of the body, by kyphosis (mm in y)."""
        # Beyond the ends of the thoracic spine it leans on straight.
        end = 130.0 * self.z
        inside = min(abs(z_mm), end)
        return -self._bend_per_mm * inside * (2.0 * abs(z_mm) - inside)

    def at(self, x: float, y: float, z: float) -> Point:
        """Return where a drawn point is in this person."""
        height = z * self.z
        return (x * self.x, y * self.y + self.lean(height), height)

    def path(self, points: Sequence[Sequence[float]]) -> list[Point]:
        """Return drawn points where they are in this person."""
        return [self.at(x, y, z) for x, y, z in points]

    @property
    def deeper_mm(self) -> float:
        """How much lower the diaphragm stands than in the drawn man, in drawn mm."""
        return self.sizes.lung_height_mm / self.z - MODEL_LUNG_HEIGHT_MM
