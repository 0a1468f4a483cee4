"""The coefficient itself, against an independent data base and against its own definition."""

from __future__ import annotations

import math

import pytest

from phantom.errors import InvalidInputError
from phantom.materials import ELEMENTS, ENERGY_LIMITS_KEV, attenuation_per_mm, reference


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


# J. H. Hubbell and S. M. Seltzer, NISTIR 5632: mass attenuation with coherent scattering, cm²/g.
NIST_CM2_G = {
    ("water", 20.0): 0.8096,
    ("water", 60.0): 0.2059,
    ("water", 100.0): 0.1707,
    ("aluminium", 30.0): 1.128,
    ("aluminium", 60.0): 0.2778,
    ("cortical_bone_icru44", 30.0): 1.331,
    ("cortical_bone_icru44", 60.0): 0.3148,
}


@pytest.mark.parametrize(("name", "energy_kev"), NIST_CM2_G)
def test_nist_values_are_met(name: str, energy_kev: float) -> None:
    composition = reference(name).composition
    per_mm = attenuation_per_mm(composition, 1.0, energy_kev)
    assert 10 * per_mm == pytest.approx(NIST_CM2_G[name, energy_kev], rel=0.006)


def test_iodine_jumps_at_its_k_edge() -> None:
    iodine = reference("iodine_350")
    below, above = (
        10 * attenuation_per_mm(iodine.composition, iodine.density_g_cm3, energy)
        for energy in (33.1, 33.3)
    )
    assert below == pytest.approx(2.64, rel=0.01)
    assert above == pytest.approx(12.7, rel=0.01)


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
