"""Linear attenuation of a composition at one photon energy.

The coefficient is the total one: photoelectric + incoherent + coherent scattering, summed over the
elements by mass fraction. A photon scattered coherently has left the narrow beam, so it counts as
lost: this is the coefficient of the primary image. Values come from ``xraylib`` (``CS_Total``; T.
Schoonjans et al., Spectrochim. Acta B 66 (2011) 776-784, doi:10.1016/j.sab.2011.09.011).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from phantom.errors import InvalidInputError, Problem
from phantom.materials.elements import ATOMIC_NUMBERS

ENERGY_LIMITS_KEV: Final[tuple[float, float]] = (1.0, 800.0)
"""Least and greatest energy served; the tables behind ``CS_Total`` end just above 800 keV."""

_CM_PER_MM: Final = 0.1


def check_energy(energy_kev: float) -> tuple[Problem, ...]:
    """Return what is wrong with a photon energy in keV; nothing where it can be served."""
    least, greatest = ENERGY_LIMITS_KEV
    if math.isfinite(energy_kev) and least <= energy_kev <= greatest:
        return ()
    kind = "out_of_range" if math.isfinite(energy_kev) else "not_finite"
    message = f"found {energy_kev!r} keV, expected an energy from {least:g} to {greatest:g} keV"
    return (Problem("/beam/energy_kev", kind, message),)


def attenuation_per_mm(
    composition: Mapping[str, float], density_g_cm3: float, energy_kev: float
) -> float:
    """Return the total linear attenuation coefficient, coherent scattering included, in 1/mm.

    Parameters
    ----------
    composition
        Mass fraction of every element by its symbol; they are taken as they are, not normalised.
    density_g_cm3
        Mass density in g/cm³.
    energy_kev
        Photon energy in keV, within :data:`ENERGY_LIMITS_KEV`.

    Raises
    ------
    InvalidInputError
        The energy is outside the tables (``/beam/energy_kev``), or a symbol is no known element.
    """
    problems = check_energy(energy_kev) + tuple(
        Problem(
            f"/composition/{symbol}", "unknown_element", f"{symbol!r} is not an element, H to Cf"
        )
        for symbol in composition
        if symbol not in ATOMIC_NUMBERS
    )
    if problems:
        raise InvalidInputError(problems)

    import xraylib

    mass_attenuation_cm2_g = math.fsum(
        fraction * xraylib.CS_Total(ATOMIC_NUMBERS[symbol], energy_kev)
        for symbol, fraction in composition.items()
    )
    return float(mass_attenuation_cm2_g * density_g_cm3 * _CM_PER_MM)
