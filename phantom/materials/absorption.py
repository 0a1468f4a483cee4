"""Energy absorption in dry air, which turns photons into air kerma.

Values: J. H. Hubbell and S. M. Seltzer, NISTIR 5632, table 4, air (dry, near sea level),
doi:10.18434/T4D01F (a work of the United States government, in the public domain). Between them
the logarithm of the coefficient is a natural cubic spline of the logarithm of the energy, in two
pieces that meet at the K-edge of argon. (Straight lines between the logarithms, a common choice,
are 3 % too high at 70 keV.) ``xraylib.CS_Energy`` is not used: its tables of light elements are too
coarse near 20 keV, where it gives two thirds of these values.
"""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError
from phantom.materials.attenuation import check_energy

FloatArray = NDArray[np.float64]

Table = tuple[tuple[float, float], ...]

ARGON_K_EDGE_KEV: Final = 3.2029

# fmt: off
BELOW_ARGON_K: Final[Table] = (
    (1.0, 3599.0), (1.5, 1188.0), (2.0, 526.2), (3.0, 161.4), (ARGON_K_EDGE_KEV, 133.0),
)
"""Energy in keV and mass energy-absorption coefficient in cm²/g, up to the K-edge of argon."""

ABOVE_ARGON_K: Final[Table] = (
    (ARGON_K_EDGE_KEV, 146.0), (4.0, 76.36), (5.0, 39.31), (6.0, 22.70), (8.0, 9.446),
    (10.0, 4.742), (15.0, 1.334), (20.0, 0.5389), (30.0, 0.1537), (40.0, 0.06833),
    (50.0, 0.04098), (60.0, 0.03041), (80.0, 0.02407), (100.0, 0.02325), (150.0, 0.02496),
    (200.0, 0.02672), (300.0, 0.02872), (400.0, 0.02949), (500.0, 0.02966), (600.0, 0.02953),
    (800.0, 0.02882),
)
"""The same from the K-edge of argon on."""
# fmt: on


def air_absorption_cm2_g(energies_kev: FloatArray) -> FloatArray:
    """Return the mass energy-absorption coefficient μ_en/ρ of dry air, in cm²/g.

    Parameters
    ----------
    energies_kev
        Any shape; from 1 to 800 keV. The result has the same shape.

    Raises
    ------
    InvalidInputError
        An energy is outside the tables.
    """
    energies = np.asarray(energies_kev, dtype=np.float64)
    problems = [p for energy in energies.ravel().tolist() for p in check_energy(energy)]
    if problems:
        raise InvalidInputError(dict.fromkeys(problems))
    below, above = (_along(table, np.log(energies)) for table in (BELOW_ARGON_K, ABOVE_ARGON_K))
    return np.asarray(np.exp(np.where(energies < ARGON_K_EDGE_KEV, below, above)))


def _along(table: Table, logarithms: FloatArray) -> FloatArray:
    """Return the spline's value at the logarithms of energies, by the cubic of each interval."""
    x, y, curvature = _spline(table)
    left = np.clip(np.searchsorted(x, logarithms, side="right") - 1, 0, len(x) - 2)
    width = x[left + 1] - x[left]
    b = (logarithms - x[left]) / width
    a = 1 - b
    bent = (a**3 - a) * curvature[left] + (b**3 - b) * curvature[left + 1]
    return np.asarray(a * y[left] + b * y[left + 1] + bent * width**2 / 6)


@cache
def _spline(table: Table) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return nodes, values and second derivatives of the spline, all of logarithms."""
    x, y = np.log(np.array(table)).T
    step = np.diff(x)
    inner = len(x) - 2
    matrix = np.zeros((inner, inner))
    index = np.arange(inner)
    matrix[index, index] = (step[:-1] + step[1:]) / 3
    matrix[index[:-1], index[1:]] = matrix[index[1:], index[:-1]] = step[1:-1] / 6
    curvature = np.zeros(len(x))
    curvature[1:-1] = np.linalg.solve(matrix, np.diff(np.diff(y) / step))
    return x, y, curvature
