"""The coefficient itself, against an independent data base and against its own definition."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.materials import (
    ELEMENTS,
    ENERGY_LIMITS_KEV,
    attenuation_curve_per_mm,
    attenuation_per_mm,
    k_edges_kev,
    reference,
)


def second_opinion_per_mm(name: str, energy_kev: float) -> float:
    """Total attenuation by xraydb, whose tables (Elam, Ravel & Sieber) xraylib does not use."""
    import xraydb

    material = reference(name)
    mass = sum(
        fraction * float(xraydb.mu_elam(symbol, 1000 * energy_kev, kind="total"))
        for symbol, fraction in material.composition.items()
    )
    return mass * material.density_g_cm3 / 10


@pytest.mark.parametrize("energy_kev", [20, 30, 50, 60, 80, 100, 150])
@pytest.mark.parametrize(
    "name",
    ["water", "cortical_bone_icru44", "adipose_icru44", "soft_tissue_icru44", "aluminium", "steel"],
)
def test_a_second_data_base_agrees(name: str, energy_kev: float) -> None:
    material = reference(name)
    ours = attenuation_per_mm(material.composition, material.density_g_cm3, energy_kev)
    assert ours == pytest.approx(second_opinion_per_mm(name, energy_kev), rel=0.01)


# J. H. Hubbell and S. M. Seltzer, *Tables of X-Ray Mass Attenuation Coefficients and Mass
# Energy-Absorption Coefficients*, NISTIR 5632, tables 3 and 4, doi:10.18434/T4D01F: total mass
# attenuation, coherent scattering included, in cm²/g at ENERGIES_KEV. Four digits are printed.
ENERGIES_KEV = (20, 30, 40, 50, 60, 80, 100, 150)
NIST_CM2_G: dict[str, tuple[float, ...]] = {
    "water": (0.8096, 0.3756, 0.2683, 0.2269, 0.2059, 0.1837, 0.1707, 0.1505),
    "cortical_bone_icru44": (4.001, 1.331, 0.6655, 0.4242, 0.3148, 0.2229, 0.1855, 0.1480),
    "adipose_icru44": (0.5677, 0.3063, 0.2396, 0.2123, 0.1974, 0.1800, 0.1688, 0.1500),
    "I": (25.43, 8.561, 22.10, 12.32, 7.579, 3.510, 1.942, 0.6978),
    "aluminium": (3.441, 1.128, 0.5685, 0.3681, 0.2778, 0.2018, 0.1704, 0.1378),
}


def mass_attenuation_cm2_g(name: str, energy_kev: float) -> float:
    composition = {"I": 1.0} if name == "I" else reference(name).composition
    return 10 * attenuation_per_mm(composition, 1.0, energy_kev)


@pytest.mark.parametrize("name", NIST_CM2_G)
def test_nist_values_are_met_to_a_thousandth(name: str) -> None:
    for energy_kev, printed in zip(ENERGIES_KEV, NIST_CM2_G[name], strict=True):
        assert mass_attenuation_cm2_g(name, energy_kev) == pytest.approx(printed, rel=1e-3)


def test_the_second_data_base_meets_the_same_values() -> None:
    import xraydb

    for energy_kev, printed in zip(ENERGIES_KEV, NIST_CM2_G["I"], strict=True):
        theirs = float(xraydb.mu_elam("I", 1000 * energy_kev, kind="total"))
        assert theirs == pytest.approx(printed, rel=1e-3)


def test_iodine_jumps_at_its_k_edge() -> None:
    iodine = reference("iodine_350")
    below, above = (
        10 * attenuation_per_mm(iodine.composition, iodine.density_g_cm3, energy)
        for energy in (33.1, 33.3)
    )
    assert below == pytest.approx(2.64, rel=0.01)
    assert above == pytest.approx(12.7, rel=0.01)


def test_k_edges_are_those_of_the_tables_of_x_ray_data() -> None:
    # A. Thompson et al., X-ray Data Booklet (2009), table 1-1.
    printed = {"Mo": 20.000, "Rh": 23.220, "Ag": 25.514, "I": 33.169, "Ba": 37.441, "W": 69.525}
    assert k_edges_kev(printed) == pytest.approx(sorted(printed.values()), abs=5e-4)
    assert k_edges_kev(["H", "C", "O"]) == ()  # below 1 keV


def test_a_curve_is_its_values_one_by_one() -> None:
    bone = reference("cortical_bone_icru44")
    energies = np.array([20.0, 33.3, 60.0, 150.0])
    one_by_one = [attenuation_per_mm(bone.composition, 1.92, e) for e in energies.tolist()]
    curve = attenuation_curve_per_mm(bone.composition, 1.92, energies)
    assert curve.tolist() == one_by_one


def test_attenuation_is_proportional_to_density() -> None:
    composition = reference("muscle_icru44").composition
    once = attenuation_per_mm(composition, 1.05, 60)
    assert attenuation_per_mm(composition, 2.10, 60) == pytest.approx(2 * once, rel=1e-15)


def test_every_element_is_served_over_the_whole_range() -> None:
    for symbol in ELEMENTS:
        for energy_kev in ENERGY_LIMITS_KEV:
            assert attenuation_per_mm({symbol: 1.0}, 1.0, energy_kev) > 0


@pytest.mark.parametrize("energy_kev", [0.0, 0.999, 800.1, 1000.0, -60.0, math.inf, math.nan])
def test_an_energy_outside_the_tables_is_refused(energy_kev: float) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        attenuation_per_mm({"H": 1.0}, 1.0, energy_kev)
    (problem,) = refusal.value.problems
    assert problem.path == "/beam/energy_kev"
    assert "1 to 800 keV" in problem.message


def test_an_unknown_element_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="/composition/Xx"):
        attenuation_per_mm({"Xx": 1.0}, 1.0, 60)
