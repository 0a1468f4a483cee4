"""Photons scattered more than once in a slab of water: amount, energy and width, as a table.

The numbers are those that ``bench/scatter_in_water.py`` prints with ``1500000 table``: photons
followed one by one, each entry good to about 1 %. Outside its energies and below its least
thickness the nearest entry stands in, but for the amount, which goes to 0 with the thickness. Where
less than a ten-thousandth passes unscattered the last thickness that was followed stands in.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from phantom.imaging.view import FloatArray

_ENERGIES_KEV: Final = (20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0)
_THICKNESSES_MM: Final = (10.0, 20.0, 50.0, 100.0, 150.0, 200.0, 300.0, 400.0)

THICKEST_MM: Final = _THICKNESSES_MM[-1]
"""Thicker water than this is taken to be as thick as this."""

# For every energy and thickness: photons scattered more than once over those scattered once, the
# fraction of their energy that they keep, the width on the far side in mm, and how much wider a mm
# of gap makes it.
# fmt: off
_TABLE: Final = np.array([
    [  # 20 keV
        [0.143, 0.961, 11.1, 1.66], [0.223, 0.968, 14.5, 1.41],
        [0.406, 0.977, 22.6, 1.12], [0.739, 0.983, 32.2, 0.89],
        [0.739, 0.983, 32.2, 0.89], [0.739, 0.983, 32.2, 0.89],
        [0.739, 0.983, 32.2, 0.89], [0.739, 0.983, 32.2, 0.89],
    ],
    [  # 30 keV
        [0.194, 0.918, 16.9, 1.99], [0.316, 0.921, 23.5, 1.74],
        [0.595, 0.930, 36.7, 1.42], [1.001, 0.938, 52.4, 1.22],
        [1.365, 0.943, 64.7, 1.09], [1.741, 0.945, 75.9, 1.01],
        [1.741, 0.945, 75.9, 1.01], [1.741, 0.945, 75.9, 1.01],
    ],
    [  # 40 keV
        [0.217, 0.881, 20.8, 2.09], [0.374, 0.880, 29.6, 1.86],
        [0.760, 0.881, 47.4, 1.54], [1.310, 0.884, 68.2, 1.32],
        [1.889, 0.887, 84.3, 1.20], [2.481, 0.889, 98.0, 1.12],
        [3.902, 0.892, 123.3, 1.03], [3.902, 0.892, 123.3, 1.03],
    ],
    [  # 60 keV
        [0.228, 0.823, 24.3, 2.18], [0.411, 0.816, 35.2, 1.95],
        [0.913, 0.803, 59.3, 1.62], [1.738, 0.793, 86.7, 1.39],
        [2.585, 0.787, 107.2, 1.26], [3.546, 0.784, 124.6, 1.17],
        [5.805, 0.776, 155.4, 1.06], [8.388, 0.771, 180.6, 0.97],
    ],
    [  # 80 keV
        [0.221, 0.778, 25.9, 2.22], [0.407, 0.769, 37.8, 1.99],
        [0.941, 0.747, 64.8, 1.66], [1.886, 0.727, 95.8, 1.42],
        [2.923, 0.714, 119.3, 1.28], [4.093, 0.705, 139.4, 1.20],
        [7.044, 0.692, 173.0, 1.07], [10.378, 0.681, 203.8, 0.99],
    ],
    [  # 100 keV
        [0.213, 0.740, 26.7, 2.23], [0.394, 0.730, 39.0, 2.01],
        [0.926, 0.704, 67.9, 1.67], [1.904, 0.678, 101.3, 1.42],
        [2.993, 0.660, 126.8, 1.29], [4.239, 0.647, 148.3, 1.20],
        [7.285, 0.630, 184.1, 1.08], [11.289, 0.615, 214.7, 1.00],
    ],
    [  # 120 keV
        [0.204, 0.708, 27.2, 2.24], [0.377, 0.698, 39.8, 2.03],
        [0.896, 0.670, 69.7, 1.69], [1.865, 0.639, 104.8, 1.44],
        [2.979, 0.618, 131.4, 1.30], [4.236, 0.604, 154.1, 1.20],
        [7.555, 0.582, 191.2, 1.08], [11.506, 0.566, 224.5, 1.01],
    ],
    [  # 140 keV
        [0.196, 0.680, 27.6, 2.25], [0.362, 0.670, 40.4, 2.03],
        [0.866, 0.641, 71.1, 1.70], [1.800, 0.608, 107.2, 1.44],
        [2.906, 0.586, 135.1, 1.31], [4.131, 0.570, 158.1, 1.22],
        [7.266, 0.546, 195.9, 1.08], [11.206, 0.531, 229.2, 1.01],
    ],
])
# fmt: on


@dataclass(frozen=True, eq=False)
class Multiple:
    """Photons scattered more than once; every array has the shape of the thicknesses.

    Attributes
    ----------
    ratio
        Over photons scattered once.
    energy
        Mean energy over that of the beam.
    width_mm, widening
        ``a = width_mm + widening · gap`` of ``(1 + r²/a²)⁻³``, where they arrive.
    """

    ratio: FloatArray
    energy: FloatArray
    width_mm: FloatArray
    widening: FloatArray


def multiple(energy_kev: float, thickness_mm: FloatArray) -> Multiple:
    """Return the table at an energy and at thicknesses, linear between its entries."""
    place = float(np.interp(energy_kev, _ENERGIES_KEV, np.arange(len(_ENERGIES_KEV))))
    lower = min(int(place), len(_ENERGIES_KEV) - 2)
    row = _TABLE[lower] * (lower + 1 - place) + _TABLE[lower + 1] * (place - lower)
    ratio, energy, width, widening = (
        np.interp(thickness_mm, _THICKNESSES_MM, column) for column in row.T
    )
    thin = np.minimum(np.asarray(thickness_mm) / _THICKNESSES_MM[0], 1.0)
    return Multiple(ratio * thin, energy, width, widening)
