"""Linear attenuation of a composition at one photon energy.

The coefficient is the total one: photoelectric + incoherent + coherent scattering, summed over the
elements by mass fraction. A photon scattered coherently has left the narrow beam, so it counts as
lost: this is the coefficient of the primary image. Values come from ``xraylib`` (``CS_Total``; T.
Schoonjans et al., Spectrochim. Acta B 66 (2011) 776-784, doi:10.1016/j.sab.2011.09.011).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

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
    """Return the coefficient at one energy, in 1/mm; see :func:`attenuation_curve_per_mm`."""
    energies = np.array([energy_kev], dtype=np.float64)
    return float(attenuation_curve_per_mm(composition, density_g_cm3, energies)[0])


def attenuation_curve_per_mm(
    composition: Mapping[str, float], density_g_cm3: float, energies_kev: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the (K,) total linear attenuation, coherent scattering included, in 1/mm.

    Parameters
    ----------
    composition
        Mass fraction of every element by its symbol; they are taken as they are, not normalised.
    density_g_cm3
        Mass density in g/cm³.
    energies_kev
        (K,) photon energies in keV, within :data:`ENERGY_LIMITS_KEV`.

    Raises
    ------
    InvalidInputError
        An energy is outside the tables (``/beam/energy_kev``), or a symbol is no known element.
    """
    _check(composition, energies_kev)
    import xraylib

    # One call a value: xraylib_np would start OpenMP threads, which idle by spinning.
    energies = energies_kev.tolist()
    mass_attenuation_cm2_g = np.zeros(len(energies))
    for symbol, fraction in composition.items():
        number = ATOMIC_NUMBERS[symbol]
        mass_attenuation_cm2_g += fraction * np.array(
            [xraylib.CS_Total(number, energy) for energy in energies]
        )
    return mass_attenuation_cm2_g * density_g_cm3 * _CM_PER_MM


def k_edges_kev(symbols: Iterable[str]) -> tuple[float, ...]:
    """Return the K-edges of these elements that lie at served energies, rising, in keV."""
    import xraylib

    least, greatest = ENERGY_LIMITS_KEV
    edges = {xraylib.EdgeEnergy(ATOMIC_NUMBERS[s], xraylib.K_SHELL) for s in symbols}
    return tuple(sorted(float(edge) for edge in edges if least <= edge <= greatest))


def _check(composition: Mapping[str, float], energies_kev: NDArray[np.float64]) -> None:
    """Refuse energies outside the tables and symbols that are no element."""
    problems = [p for energy in energies_kev.tolist() for p in check_energy(energy)]
    problems += [
        Problem(
            f"/composition/{symbol}", "unknown_element", f"{symbol!r} is not an element, H to Cf"
        )
        for symbol in composition
        if symbol not in ATOMIC_NUMBERS
    ]
    if problems:
        raise InvalidInputError(dict.fromkeys(problems))
