"""Sums of path lengths, each times what a mm of its material takes away."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import kernel

Floats = NDArray[np.float64]


@kernel
def add_material(lengths: Floats, attenuation_per_mm: float, first: bool, total: Floats) -> None:
    """Add one material to ``total`` (n,), or begin with it; a product is rounded before a sum."""
    if first:
        for i in range(len(total)):
            total[i] = attenuation_per_mm * lengths[i]
    else:
        for i in range(len(total)):
            total[i] += attenuation_per_mm * lengths[i]
