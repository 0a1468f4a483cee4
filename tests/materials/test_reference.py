"""The reference table: every name, whole compositions, and printed coefficients to meet."""

from __future__ import annotations

import pytest

from phantom.errors import InvalidInputError
from phantom.materials import ELEMENTS, REFERENCE_NAMES, attenuation_per_mm, reference

DOCUMENTED_NAMES = """
water air cortical_bone_icru44 spongiosa_icru44 red_marrow_icru44 yellow_marrow_icru44
soft_tissue_icru44 muscle_icru44 adipose_icru44 skin_icru44 lung_icru44 breast_gland_icru44
cartilage_icru44 blood_icru44 pmma aluminium titanium steel glass calcium_oxalate hydroxyapatite
iodine_350 barium_sulfate_suspension
"""

ENERGIES_KEV = (20, 30, 40, 50, 60, 80, 100)

# Linear attenuation in 1/cm with coherent scattering, at ENERGIES_KEV; None where none is printed.
PRINTED_PER_CM: dict[str, tuple[float | None, ...]] = {
    "cortical_bone_icru44": (7.68, 2.556, 1.278, 0.815, 0.605, 0.428, 0.356),
    "spongiosa_icru44": (2.08, 0.783, 0.458, 0.337, 0.281, 0.230, 0.206),
    "yellow_marrow_icru44": (0.537, 0.295, 0.233, 0.207, 0.193, 0.176, 0.165),
    "soft_tissue_icru44": (0.873, 0.402, 0.285, 0.240, 0.217, 0.193, 0.180),
    "muscle_icru44": (0.862, 0.397, 0.282, 0.238, 0.215, 0.191, 0.178),
    "adipose_icru44": (0.539, 0.291, 0.228, 0.202, 0.188, 0.171, 0.160),
    "breast_gland_icru44": (0.703, 0.347, 0.258, 0.223, 0.205, 0.184, 0.172),
    "cartilage_icru44": (1.04, 0.456, 0.312, 0.257, 0.229, 0.202, 0.186),
    "lung_icru44": (0.216, 0.099, 0.070, 0.059, 0.053, 0.047, 0.044),
    "water": (0.810, 0.376, 0.268, 0.227, 0.206, 0.184, 0.171),
    "pmma": (0.680, 0.361, 0.280, 0.247, 0.229, 0.208, 0.195),
    "aluminium": (9.29, 3.05, 1.53, 0.994, 0.750, 0.545, 0.460),
    "titanium": (72.0, 22.6, 10.1, 5.51, 3.48, 1.84, 1.24),
    "glass": (6.37, 2.18, 1.16, 0.796, 0.629, 0.484, 0.421),
    "calcium_oxalate": (9.09, 3.02, 1.50, 0.950, 0.700, 0.490, 0.406),
    "hydroxyapatite": (20.7, 6.63, 3.12, 1.85, 1.29, 0.818, 0.638),
    "iodine_350": (None, 3.37, 8.00, 4.54, 2.86, 1.41, 0.85),
}


def test_the_table_holds_the_documented_names_and_no_other() -> None:
    assert sorted(REFERENCE_NAMES) == sorted(DOCUMENTED_NAMES.split())


@pytest.mark.parametrize("name", REFERENCE_NAMES)
def test_a_composition_is_whole_and_names_known_elements(name: str) -> None:
    material = reference(name)
    assert sum(material.composition.values()) == pytest.approx(1, abs=2e-6)
    assert set(material.composition) <= set(ELEMENTS)
    assert material.density_g_cm3 > 0
    assert material.source
    assert material.name == name


@pytest.mark.parametrize("name", PRINTED_PER_CM)
def test_attenuation_agrees_with_the_printed_table(name: str) -> None:
    material = reference(name)
    for energy_kev, printed in zip(ENERGIES_KEV, PRINTED_PER_CM[name], strict=True):
        if printed is None:
            continue
        digit = 10 ** -(len(str(printed).partition(".")[2]))
        per_cm = 10 * attenuation_per_mm(material.composition, material.density_g_cm3, energy_kev)
        assert per_cm == pytest.approx(printed, rel=0.01, abs=digit / 2), energy_kev


@pytest.mark.parametrize(
    ("name", "formula"),
    [
        ("water", "H2O"),
        ("pmma", "C5H8O2"),
        ("glass", "SiO2"),
        ("calcium_oxalate", "CaC2O4H2O"),
        ("hydroxyapatite", "Ca5(PO4)3OH"),
    ],
)
def test_a_compound_has_the_mass_fractions_of_its_formula(name: str, formula: str) -> None:
    import xraydb

    moles = xraydb.chemparse(formula)
    mass = {symbol: count * xraydb.atomic_mass(symbol) for symbol, count in moles.items()}
    total = sum(mass.values())
    for symbol, fraction in reference(name).composition.items():
        assert fraction == pytest.approx(mass[symbol] / total, abs=3e-4)


def test_contrast_media_hold_the_stated_mass_in_a_volume() -> None:
    iodine = reference("iodine_350")
    assert iodine.composition["I"] * iodine.density_g_cm3 == pytest.approx(0.350, abs=1e-4)
    barium = reference("barium_sulfate_suspension")
    sulfate = barium.composition["Ba"] * 233.39 / 137.327
    assert sulfate * barium.density_g_cm3 == pytest.approx(0.60, abs=1e-3)


def test_an_unknown_name_is_refused_with_the_known_ones() -> None:
    with pytest.raises(InvalidInputError, match="cortical_bone_icru44") as refusal:
        reference("bone")
    assert refusal.value.problems[0].kind == "unknown_reference"


def test_a_reference_composition_cannot_be_changed() -> None:
    with pytest.raises(TypeError):
        reference("water").composition["H"] = 0.2  # type: ignore[index]
