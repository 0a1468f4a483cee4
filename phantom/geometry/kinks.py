"""Where a formula may have a kink: places at which a choice in it is decided anew."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.formulas import Formula

Floats = NDArray[np.float64]

_SAMPLES = 1025


def kinks(formula: Formula, variable: str, start: float, end: float) -> Floats:
    """Return the places strictly inside a range where an abs, min, max or conditional turns.

    Each is the first double at which the choice is the one to its right. Choices are compared at
    evenly spread places and then halved down to neighbouring doubles, so two turns within a
    thousandth of the range may pass unseen; derivatives do not depend on them.
    """
    if formula.is_smooth:
        return np.empty(0)
    u = np.linspace(start, end, _SAMPLES)
    decided = formula.branches(**{variable: u})
    row, k = np.nonzero(decided[:, 1:] != decided[:, :-1])
    low, high = u[k], u[k + 1]
    while True:
        middle = low + 0.5 * (high - low)
        apart = (low < middle) & (middle < high)
        if not apart.any():
            break
        there = formula.branches(**{variable: middle})[row, np.arange(len(row))]
        turned = there != decided[row, k]
        high = np.where(apart & turned, middle, high)
        low = np.where(apart & ~turned, middle, low)
    found = np.unique(high)
    return np.asarray(found[(start < found) & (found < end)])
