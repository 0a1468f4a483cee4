"""Energy absorption of air: between the printed values, against the cross-sections themselves."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.materials import air_absorption_cm2_g, reference
from phantom.materials.absorption import ABOVE_ARGON_K, BELOW_ARGON_K

ELECTRON_KEV = 510.99895


def transferred_cm2_g(energy_kev: float) -> float:
    """Energy transfer by photoelectric absorption and by Klein and Nishina's scattering."""
    import xraylib

    cosine = np.linspace(-1, 1, 4001)
    ratio = 1 / (1 + energy_kev / ELECTRON_KEV * (1 - cosine))
    differential = ratio**2 * (ratio + 1 / ratio - (1 - cosine**2))
    given = float(np.sum(differential * (1 - ratio)) / np.sum(differential))
    return sum(
        fraction * (xraylib.CS_Photo(z, energy_kev) + xraylib.CS_Compt(z, energy_kev) * given)
        for fraction, z in zip(reference("air").composition.values(), (6, 7, 8, 18), strict=True)
    )


def test_printed_values_are_met() -> None:
    for table, nudge in ((BELOW_ARGON_K, -1e-9), (ABOVE_ARGON_K, 1e-9)):
        for energy_kev, printed in table:
            energy = np.clip(energy_kev * (1 + nudge), 1, 800)
            assert air_absorption_cm2_g(np.array([energy]))[0] == pytest.approx(printed, rel=1e-6)


@pytest.mark.parametrize("energy_kev", [12, 17, 22, 25, 27, 35, 45, 55, 65, 70, 75, 90, 120])
def test_between_them_it_follows_the_cross_sections(energy_kev: float) -> None:
    # The ratio to what theory gives changes slowly; a straight line between the logarithms of the
    # printed values would be 3 % off at 70 keV.
    nodes = np.array([e for e, _ in ABOVE_ARGON_K if 8 <= e <= 200])
    ratios = [
        float(air_absorption_cm2_g(np.array([e]))[0]) / transferred_cm2_g(e) for e in nodes.tolist()
    ]
    expected = np.interp(energy_kev, nodes, ratios)
    found = float(air_absorption_cm2_g(np.array([float(energy_kev)]))[0])
    assert found / transferred_cm2_g(energy_kev) == pytest.approx(expected, rel=3e-3)


def test_outside_the_tables_it_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="1 to 800 keV"):
        air_absorption_cm2_g(np.array([30.0, 0.5]))
