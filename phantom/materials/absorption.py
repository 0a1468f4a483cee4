"""Energy absorption in dry air, which turns photons into air kerma.

Values: J. H. Hubbell and S. M. Seltzer, NISTIR 5632, table 4, air (dry, near sea level),
doi:10.18434/T4D01F (a work of the United States government, in the public domain). Between them
the logarithm of the coefficient is a C² cubic spline of the logarithm of the energy, in two pieces
that meet at the K-edge of argon. ``xraylib.CS_Energy`` is not used: its tables of light elements
are too coarse near 20 keV, where it gives two thirds of these values.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError
from phantom.materials.attenuation import check_energy

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

FloatArray = NDArray[np.float64]

ARGON_K_EDGE_KEV: Final = 3.2029

# fmt: off
BELOW_ARGON_K: Final = (
    (1.0, 3599.0), (1.5, 1188.0), (2.0, 526.2), (3.0, 161.4), (ARGON_K_EDGE_KEV, 133.0),
)
"""Energy in keV and mass energy-absorption coefficient in cm²/g, up to the K-edge of argon."""

ABOVE_ARGON_K: Final = (
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
    below, above = _splines()
    logarithm = np.log(energies)
    found = np.where(energies < ARGON_K_EDGE_KEV, below(logarithm), above(logarithm))
    return np.asarray(np.exp(found), dtype=np.float64)


@cache
def _splines() -> tuple[CubicSpline, CubicSpline]:
    from scipy.interpolate import CubicSpline

    below, above = (np.log(np.array(table)) for table in (BELOW_ARGON_K, ABOVE_ARGON_K))
    return CubicSpline(below[:, 0], below[:, 1]), CubicSpline(above[:, 0], above[:, 1])
