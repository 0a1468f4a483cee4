"""Which coefficient a document's material has at an energy."""

from __future__ import annotations

from typing import Any

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
