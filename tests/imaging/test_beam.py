"""What a beam is asked to be, and which coefficient a document's material has at an energy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.document import CompositionMaterial, FixedMaterial, ReferenceMaterial
from phantom.errors import InvalidInputError
from phantom.imaging import Beam, attenuations_per_mm
from phantom.materials import attenuation_per_mm, reference


def test_each_kind_of_material_has_its_coefficient_in_the_documents_order() -> None:
    oxide = {"Si": 0.467, "O": 0.533}
    materials: dict[str, Any] = {
        "fixed": FixedMaterial(attenuation_per_mm=0.05),
        "tissue": ReferenceMaterial(reference="soft_tissue_icru44"),
        "dense": ReferenceMaterial(reference="soft_tissue_icru44", density_g_cm3=2.12),
        "own": CompositionMaterial(composition=oxide, density_g_cm3=2.2),
    }
    found = attenuations_per_mm(materials, 60)
    tissue = attenuation_per_mm(reference("soft_tissue_icru44").composition, 1.06, 60)
    expected = [0.05, tissue, 2 * tissue, attenuation_per_mm(oxide, 2.2, 60)]
    assert found.tolist() == pytest.approx(expected, rel=1e-14)
    assert attenuations_per_mm({}, 60).shape == (0,)


def test_only_a_fixed_coefficient_holds_at_any_energy() -> None:
    materials: dict[str, Any] = {
        "fixed": FixedMaterial(attenuation_per_mm=0.05),
        "bone": ReferenceMaterial(reference="cortical_bone_icru44"),
    }
    soft, hard = attenuations_per_mm(materials, 30), attenuations_per_mm(materials, 100)
    assert soft[0] == hard[0] == 0.05
    assert soft[1] > 5 * hard[1]


@pytest.mark.parametrize("energy_kev", [0, 0.5, 801, 1e9, -60, "60", True])
def test_an_energy_that_is_not_served_is_refused(energy_kev: Any) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Beam(energy_kev=energy_kev)
    assert [p.path for p in refusal.value.problems] == ["/beam/energy_kev"]


def test_what_is_left_out_is_filled_in_and_not_counted_as_said() -> None:
    assert Beam().energy_kev == Beam(energy_kev=None).energy_kev == 60
    assert Beam().model_fields_set == Beam(energy_kev=None).model_fields_set == set()
    tube = Beam(kvp=70)
    assert (tube.anode, tube.filtration_mm) == ("tungsten", {"aluminium": 2.5})
    assert tube.energy_kev is None
    assert tube.model_fields_set == {"kvp"}
    assert Beam(kvp=28, anode="molybdenum").filtration_mm == {"molybdenum": 0.03}
    assert Beam(kvp=28, anode="rhodium", filtration_mm={}).filtration_mm == {}


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"kvp": 70, "energy_kev": 60}, ("/beam/kvp", "contradiction")),
        ({"kvp": 200}, ("/beam/kvp", "out_of_range")),
        ({"kvp": 19.99}, ("/beam/kvp", "out_of_range")),
        ({"kvp": 60, "anode": "rhodium"}, ("/beam/kvp", "out_of_range")),
        ({"kvp": "70"}, ("/beam/kvp", "not_a_number")),
        ({"kvp": float("nan")}, ("/beam/kvp", "not_finite")),
        ({"kvp": 70, "anode": "gold"}, ("/beam/anode", "unknown_value")),
        ({"anode": "tungsten"}, ("/beam/anode", "no_effect")),
        ({"filtration_mm": {"copper": 1}}, ("/beam/filtration_mm", "no_effect")),
        (
            {"energy_kev": 60, "filtration_mm": {"copper": 1}},
            ("/beam/filtration_mm", "no_effect"),
        ),
        (
            {"kvp": 70, "filtration_mm": {"cheese": 1}},
            ("/beam/filtration_mm/cheese", "unknown_material"),
        ),
        (
            {"kvp": 70, "filtration_mm": {"copper": -1}},
            ("/beam/filtration_mm/copper", "out_of_range"),
        ),
        (
            {"kvp": 70, "filtration_mm": {"lead": 50}},
            ("/beam/filtration_mm", "no_beam"),
        ),
    ],
)
def test_a_tube_that_cannot_be_is_refused(fields: dict[str, Any], problem: tuple[str, str]) -> None:
    with pytest.raises(InvalidInputError) as refusal:
        Beam(**fields)
    assert [(p.path, p.kind) for p in refusal.value.problems] == [problem]


def test_filters_add_to_the_window_and_to_each_other() -> None:
    bare = Beam(kvp=60, filtration_mm={}).spectrum()
    filtered = Beam(kvp=60, filtration_mm={"copper": 0.1, "aluminium": 2}).spectrum()
    by_hand = bare.behind("aluminium", 2).behind("copper", 0.1)
    assert filtered.half_value_layer_mm() == pytest.approx(by_hand.half_value_layer_mm(), rel=1e-4)
    more_window = Beam(kvp=60, filtration_mm={"beryllium": 0.5}).spectrum()
    twice = bare.behind("beryllium", 0.5)
    np.testing.assert_allclose(
        more_window.photons_per_mm2_mas_at_1m, twice.photons_per_mm2_mas_at_1m, rtol=1e-12
    )


def test_a_filter_drops_what_lies_above_its_k_edge() -> None:
    spectrum = Beam(kvp=32, anode="tungsten", filtration_mm={"rhodium": 0.05}).spectrum()
    density = spectrum.photons_per_mm2_mas_at_1m / np.where(
        spectrum.widths_kev > 0, spectrum.widths_kev, np.inf
    )
    below = density[(spectrum.energies_kev > 22) & (spectrum.energies_kev < 23.2199)]
    above = density[(spectrum.energies_kev > 23.2199) & (spectrum.energies_kev < 24)]
    assert below.min() > 5 * above.max()
