"""Beer's law over a spectrum, against the sum written out and against what must follow from it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phantom.document import FixedMaterial, ReferenceMaterial
from phantom.errors import CancelledError
from phantom.imaging import (
    Acquisition,
    Beam,
    DetectorModel,
    attenuations_per_mm,
    preset_view,
    radiograph,
)
from phantom.imaging.beer import through_spectrum
from phantom.materials import attenuation_per_mm, reference
from phantom.scene import Phantom, load


def read_by(response: Any) -> Acquisition:
    return Acquisition(quantum_noise="off", detector=DetectorModel(response=response))


def ball_of(*materials: dict[str, Any], radius: float = 30) -> Phantom:
    """Balls about one centre, each material over all others."""
    names = [f"m{index}" for index in range(len(materials))]
    balls = [
        {"type": "sphere", "center": [0, 0, 0], "radius": radius, "material": name}
        for name in names
    ]
    solid = balls[0] if len(balls) == 1 else {"type": "overlap", "solids": balls}
    table = dict(zip(names, materials, strict=True))
    return load({"format": "phantom/1", "name": "ball", "materials": table, "solid": solid})


WATER = {"reference": "water"}
BONE = {"reference": "cortical_bone_icru44"}
FIXED = {"attenuation_per_mm": 0.02}


def test_it_is_the_weighted_sum_of_exponentials() -> None:
    rng = np.random.default_rng(5)
    lengths = rng.random((7, 11, 3)) * 40
    lengths[2, 3] = 0
    mu = rng.random((9, 3)) * 0.1
    weights = rng.random((2, 9))
    found = through_spectrum(lengths, mu, weights)
    for row in range(7):
        for column in range(11):
            each = [np.exp(-sum(mu[k] * lengths[row, column])) for k in range(9)]
            for sum_ in range(2):
                expected = sum(weights[sum_, k] * each[k] for k in range(9))
                assert found[sum_, row, column] == pytest.approx(expected, rel=1e-13)


def test_a_pixel_depends_neither_on_its_place_nor_on_threads() -> None:
    rng = np.random.default_rng(6)
    lengths = rng.random((300, 700, 4)) * 30 * (rng.random((300, 700, 1)) > 0.4)
    mu, weights = rng.random((61, 4)) * 0.05, rng.random((1, 61))
    whole = through_spectrum(lengths, mu, weights, workers=2)[0]
    alone = through_spectrum(lengths[101:104, 37:300], mu, weights, workers=1)[0]
    np.testing.assert_array_equal(whole[101:104, 37:300], alone)
    order = rng.permutation(300 * 700)
    shuffled = lengths.reshape(-1, 4)[order].reshape(700, 300, 4)
    found = through_spectrum(shuffled, mu, weights, workers=1)[0]
    np.testing.assert_array_equal(whole.ravel()[order], found.ravel())


def test_it_can_be_cancelled() -> None:
    with pytest.raises(CancelledError):
        through_spectrum(
            np.ones((4, 4, 1)), np.ones((2, 1)), np.ones((1, 2)), cancelled=lambda: True
        )


@pytest.mark.parametrize("response", ["energy_integrating", "photon_counting"])
def test_a_radiograph_sums_the_signal_of_every_energy(response: Any) -> None:
    phantom = ball_of(WATER, BONE, radius=12)
    view = preset_view(phantom, "ap", columns=9, rows=9)
    image = radiograph(phantom, view, Beam(kvp=80), acquisition=read_by(response))
    fine = Beam(kvp=80).spectrum()  # bins of 0.5 keV, where the image has 1 keV
    counted = fine.photons_per_mm2_mas_at_1m * (
        fine.energies_kev if response == "energy_integrating" else 1
    )
    for row, column in ((4, 4), (3, 6), (0, 0)):
        water, bone = image.path_lengths[row, column]
        mu_water, mu_bone = (
            np.array(
                [
                    attenuation_per_mm(r.composition, r.density_g_cm3, e)
                    for e in fine.energies_kev.tolist()
                ]
            )
            for r in (reference("water"), reference("cortical_bone_icru44"))
        )
        left = counted @ np.exp(-mu_water * water - mu_bone * bone) / counted.sum()
        assert image.transmission[row, column] == pytest.approx(left, rel=2e-4)
        expected = -np.log(image.transmission[row, column])
        assert image.line_integral[row, column] == pytest.approx(expected, abs=1e-15)
    assert image.transmission[0, 0] == 1
    assert image.line_integral[0, 0] == 0


def test_bins_of_one_kev_are_fine_enough_from_50_kv_on() -> None:
    for kvp in (50.5, 70, 120):
        beam = Beam(kvp=kvp)
        for name, longest_mm in (("water", 200), ("cortical_bone_icru44", 40), ("iodine_350", 8)):
            materials: dict[str, Any] = {"m": ReferenceMaterial(reference=name)}
            coarse, fine = beam.imaging_spectrum(materials), beam.spectrum(np.array([33.1694]))
            left = []
            for spectrum in (coarse, fine):
                mu = attenuations_per_mm(materials, spectrum.energies_kev)[:, 0]
                weights = spectrum.photons_per_mm2_mas_at_1m * spectrum.energies_kev
                left.append(weights @ np.exp(-mu * longest_mm) / weights.sum())
            assert left[0] == pytest.approx(left[1], rel=2e-3)


def test_a_beam_hardens() -> None:
    thin, thick = (
        radiograph(p, preset_view(p, "ap", columns=1, rows=1), Beam(kvp=70))
        for p in (ball_of(WATER, radius=5), ball_of(WATER, radius=50))
    )
    per_mm = [i.line_integral[0, 0] / i.path_lengths[0, 0, 0] for i in (thin, thick)]
    assert per_mm[1] < 0.93 * per_mm[0]
    counted = radiograph(
        thick.phantom, thick.view, Beam(kvp=70), acquisition=read_by("photon_counting")
    )
    assert counted.transmission[0, 0] < thick.transmission[0, 0]  # soft photons count for more


def test_only_fixed_materials_give_the_exponential_at_any_voltage() -> None:
    phantom = ball_of(FIXED)
    view = preset_view(phantom, "ap", columns=5, rows=5)
    tube, mono = radiograph(phantom, view, Beam(kvp=90)), radiograph(phantom, view)
    np.testing.assert_allclose(tube.transmission, mono.transmission, rtol=1e-14)
    (warning,) = tube.warnings
    assert "90 kV has no effect" in warning


def test_a_fixed_material_has_one_coefficient_at_every_energy_of_a_spectrum() -> None:
    materials: dict[str, Any] = {
        "fixed": FixedMaterial(attenuation_per_mm=0.05),
        "water": ReferenceMaterial(reference="water"),
    }
    mu = attenuations_per_mm(materials, np.array([30.0, 60.0, 90.0]))
    assert mu.shape == (3, 2)
    assert mu[:, 0].tolist() == [0.05] * 3
    assert np.all(np.diff(mu[:, 1]) < 0)
    assert mu[1].tolist() == attenuations_per_mm(materials, 60.0).tolist()


def test_the_result_tells_the_tube_and_its_quality() -> None:
    phantom = ball_of(WATER)
    beam = Beam(kvp=70, filtration_mm={"aluminium": 2.5, "copper": 0.1})
    image = radiograph(phantom, preset_view(phantom, "ap", columns=3, rows=3), beam)
    _, spectrum, beer, signal = image.stages
    assert (spectrum["stage"], spectrum["anode"], spectrum["kvp"]) == ("spectrum", "tungsten", 70)
    assert spectrum["filtration_mm"] == {"aluminium": 2.5, "copper": 0.1}
    assert spectrum["inherent_filtration_mm"] == {"beryllium": 0.5}
    own = beam.spectrum()
    assert spectrum["half_value_layer_mm_aluminium"] == own.half_value_layer_mm()
    assert spectrum["mean_energy_kev"] == own.mean_energy_kev
    assert len(beer["energies_kev"]) == len(beer["weights"]) == len(image.spectrum.energies_kev)
    assert sum(beer["weights"]) == pytest.approx(1, abs=1e-12)
    assert signal["response"] == "energy_integrating"
    told = image.metadata()["beam"]
    assert Beam.model_validate(told) == beam


@pytest.mark.parametrize("beam", [Beam(energy_kev=60), Beam(kvp=80)], ids=["energy", "spectrum"])
def test_a_picture_traced_in_bands_has_the_same_bytes(beam: Beam) -> None:
    ball = ball_of(WATER, BONE)
    view = preset_view(ball, "ap", columns=150, rows=333)
    whole = radiograph(ball, view, beam, keep_path_lengths=True)
    bands = radiograph(ball, view, beam)
    assert (whole.kept is None, bands.kept is None) == (False, True)
    for name in ("signal", "transmission", "line_integral", "path_lengths"):
        np.testing.assert_array_equal(bands.quantity(name), whole.quantity(name))


def test_a_detectors_image_needs_no_path_lengths_afterwards() -> None:
    ball = ball_of(WATER)
    view = preset_view(ball, "ap", columns=40, rows=30)
    asked = Acquisition(quantum_noise="off")
    whole = radiograph(ball, view, acquisition=asked)
    light = radiograph(ball, view, acquisition=asked, keep_path_lengths=False)
    np.testing.assert_array_equal(light.signal, whole.signal)
    np.testing.assert_array_equal(light.transmission, whole.transmission)
