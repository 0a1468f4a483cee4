"""Numbers as codes of 16 bits: ``value = (code - offset) / codes_per_unit``."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

GREATEST_CODE: Final = 65_535
LINE_INTEGRAL_CODES_PER_UNIT: Final = 8192
"""A line integral of 8 lets 0.03 % through; 1/8192 is a hundredth of a percent of the signal."""


@dataclass(frozen=True, slots=True)
class Coding:
    """How a quantity becomes codes.

    Attributes
    ----------
    quantity
        Its name.
    codes_per_unit
        Codes for one unit of it.
    offset
        The code of 0.
    """

    quantity: str
    codes_per_unit: float
    offset: int = 0

    def codes(self, values: NDArray[Any]) -> NDArray[np.uint16]:
        """Return the nearest code of each value, uint16; what is out of range stops at its end."""
        scaled = np.multiply(values, self.codes_per_unit, dtype=np.float64)
        scaled += self.offset
        np.rint(scaled, out=scaled)
        np.clip(scaled, 0, GREATEST_CODE, out=scaled)
        codes: NDArray[np.uint16] = scaled.astype(np.uint16)
        return codes

    def told(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        return asdict(self)


def coding(quantity: str, values: NDArray[Any], unit: str) -> Coding:
    """Return the coding of a quantity.

    A line integral has 8192 codes a unit; another pure number, a fraction of the photons, 65,535; a
    detector's own codes are their own. Other units, such as photons, have the greatest power of two
    of codes a unit with which the greatest value still fits.
    """
    if quantity == "line_integral":
        return Coding(quantity, LINE_INTEGRAL_CODES_PER_UNIT)
    if unit == "1":
        return Coding(quantity, GREATEST_CODE)
    if unit == "codes":
        return Coding(quantity, 1)
    greatest = float(values.max(initial=0.0))
    if greatest <= 0.0:
        return Coding(quantity, 1)
    return Coding(quantity, 2.0 ** math.floor(math.log2(GREATEST_CODE / greatest)))
