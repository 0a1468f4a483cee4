"""Spectra: what they hold, and their half-value layers against other programs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging.spectrum import Spectrum, monochromatic, relative
from phantom.imaging.spectrum_tables import ANODES, KVP_LIMITS, anode_spectrum
from phantom.materials import attenuation_per_mm, k_edges_kev
from tests.imaging import tg195

SPEKPY: dict[str, Any] = json.loads((Path(__file__).parent / "spekpy_values.json").read_text())
"""Written by docs/make_spectra.py."""

NAMES = {
    "Al": "aluminium",
    "Cu": "copper",
    "Be": "beryllium",
    "Rh": "rhodium",
    "Ag": "silver",
    "Mo": "molybdenum",
}


def case_id(case: dict[str, Any]) -> str:
    filters = "+".join(f"{mm}{name}" for name, mm in case["filters_mm"].items())
    return f"{case['anode']}-{case['kvp']}-{filters}"


def filtered(anode: Any, kvp: float, filters_mm: dict[str, float]) -> Spectrum:
    spectrum = anode_spectrum(anode, kvp).cut_at(np.array(k_edges_kev(filters_mm)))
    for name, thickness_mm in filters_mm.items():
        spectrum = spectrum.behind(NAMES[name], thickness_mm)
    return spectrum


@pytest.mark.parametrize("case", SPEKPY["cases"], ids=case_id)
def test_spekpy_finds_the_same_quality_and_output(case: dict[str, Any]) -> None:
    # Spekpy has the same photons but other coefficients, PENELOPE's; with NIST's, which it
    # interpolates in straight lines, it differs from itself by as much.
    spectrum = filtered(case["anode"], case["kvp"], case["filters_mm"])
    theirs, other = case["pene"], case["nist"]
    first = spectrum.half_value_layer_mm()
    assert first == pytest.approx(theirs["first_half_value_layer_mm"], rel=0.006)
    assert first == pytest.approx(other["first_half_value_layer_mm"], rel=0.008)
    second = spectrum.second_half_value_layer_mm()
    assert second == pytest.approx(theirs["second_half_value_layer_mm"], rel=0.006)
    kerma = spectrum.air_kerma_ugy_per_mas_at_1m
    assert kerma == pytest.approx(theirs["air_kerma_ugy_per_mas_at_1m"], rel=0.02)
    assert kerma == pytest.approx(other["air_kerma_ugy_per_mas_at_1m"], rel=0.01)
    assert spectrum.mean_energy_kev == pytest.approx(theirs["mean_energy_kev"], rel=0.004)


def test_a_voltage_between_two_tables_is_as_near_to_spekpy_as_its_neighbour() -> None:
    by_kvp = {
        case["kvp"]: filtered("tungsten", case["kvp"], case["filters_mm"]).half_value_layer_mm()
        / case["pene"]["first_half_value_layer_mm"]
        for case in SPEKPY["cases"]
        if case["anode"] == "tungsten" and case["filters_mm"] == {"Al": 2.5}
    }
    assert by_kvp[69.9] == pytest.approx(by_kvp[70], abs=2e-4)
    assert by_kvp[90.25] == pytest.approx((by_kvp[70] + by_kvp[100]) / 2, abs=3e-4)


@pytest.mark.parametrize("name", tg195.LAYERS_MM)
def test_layers_of_aapm_report_195_leave_what_its_four_codes_found(name: str) -> None:
    source = relative(*tg195.photons(name)).behind("air", tg195.AIR_MM)
    if name in tg195.MEAN_ENERGY_KEV:
        printed = tg195.MEAN_ENERGY_KEV[name]
        assert source.mean_energy_kev == pytest.approx(printed, abs=0.05)
    energies = source.energies_kev
    kerma = (
        source.shares
        * energies
        * (tg195.absorption_cm2_g(energies) if len(energies) > 1 else np.ones(1))
    )
    open_field, *behind = tg195.KERMA[name]
    for layer_mm, expected in zip(tg195.LAYERS_MM[name], behind, strict=True):
        mu = [attenuation_per_mm({"Al": 1.0}, tg195.ALUMINIUM_G_CM3, e) for e in energies.tolist()]
        left = kerma @ np.exp(-np.array(mu) * layer_mm) / kerma.sum()
        assert left == pytest.approx(expected / open_field, rel=1e-3)
        if name == "30 keV" and layer_mm == tg195.LAYERS_MM[name][0]:
            assert 0.5000 <= left <= 0.5007  # least and greatest of the four


def test_our_own_air_kerma_moves_those_layers_by_little() -> None:
    for name, rel in (("30 kVp", 2e-3), ("100 kVp", 5e-3)):
        source = relative(*tg195.photons(name)).behind("air", tg195.AIR_MM)
        half, quarter = tg195.LAYERS_MM[name]
        assert source.half_value_layer_mm() == pytest.approx(half, rel=rel)
        assert source.transmitting_layer_mm(0.25) == pytest.approx(quarter, rel=rel)


def test_a_single_energy_has_the_layers_of_its_exponential() -> None:
    mu = attenuation_per_mm({"Al": 1.0}, 2.70, 30)
    mono = monochromatic(30)
    assert mono.half_value_layer_mm() == pytest.approx(np.log(2) / mu, rel=1e-12)
    assert mono.second_half_value_layer_mm() == pytest.approx(np.log(2) / mu, rel=1e-12)
    assert mono.homogeneity() == pytest.approx(1, rel=1e-12)
    assert mono.mean_energy_kev == 30


def test_behind_the_half_value_layer_is_half_the_air_kerma() -> None:
    tube = filtered("tungsten", 80, {"Al": 2.5})
    half = tube.behind("aluminium", tube.half_value_layer_mm())
    kerma = tube.air_kerma_ugy_per_mas_at_1m
    assert half.air_kerma_ugy_per_mas_at_1m == pytest.approx(kerma / 2, rel=1e-12)
    assert half.half_value_layer_mm() == pytest.approx(tube.second_half_value_layer_mm(), rel=1e-9)
    assert half.mean_energy_kev > tube.mean_energy_kev
    assert 0.5 < tube.homogeneity() < 1


@pytest.mark.parametrize("anode", ANODES)
def test_no_photon_has_more_energy_than_the_voltage_gives(anode: Any) -> None:
    least, greatest = KVP_LIMITS[anode]
    for kvp in (least, least + 0.01, 28.3, 28.5, 28.9, 33.999, greatest - 0.5, greatest):
        spectrum = anode_spectrum(anode, kvp)
        ends = spectrum.energies_kev + spectrum.widths_kev / 2
        assert ends.max() == pytest.approx(kvp, abs=1e-9)
        assert np.all(spectrum.photons_per_mm2_mas_at_1m >= 0)
        assert np.all(np.diff(spectrum.energies_kev) > 0)


@pytest.mark.parametrize(("anode", "kvp"), [("tungsten", 70), ("molybdenum", 28), ("rhodium", 34)])
def test_photons_rise_with_the_voltage_without_a_jump(anode: Any, kvp: int) -> None:
    voltages = kvp + np.array([-0.02, -0.01, 0.0, 0.01, 0.02])
    totals = [anode_spectrum(anode, v).photons_per_mm2_mas_at_1m.sum() for v in voltages]
    steps = np.diff(totals)
    assert np.all(steps > 0)
    assert steps.max() < 1.2 * steps.min()


def test_voltages_outside_the_tables_are_refused() -> None:
    for anode, kvp in (("tungsten", 19.9), ("tungsten", 150.1), ("rhodium", 51)):
        with pytest.raises(InvalidInputError) as refusal:
            anode_spectrum(anode, kvp)  # type: ignore[arg-type]
        assert [p.path for p in refusal.value.problems] == ["/beam/kvp"]


def test_cutting_and_grouping_keep_photons_and_energy() -> None:
    whole = anode_spectrum("tungsten", 80)
    edges = np.array([33.17, 37.44, 200.0, 50.0])
    cut = whole.cut_at(edges)
    low, high = cut.energies_kev - cut.widths_kev / 2, cut.energies_kev + cut.widths_kev / 2
    for edge in edges:
        assert not np.any((low < edge - 1e-9) & (high > edge + 1e-9))
    grouped = cut.grouped(1.0, edges)
    assert len(grouped.energies_kev) < 0.6 * len(cut.energies_kev)
    for made in (cut, grouped):
        assert made.shares @ made.energies_kev == pytest.approx(whole.mean_energy_kev, rel=1e-12)
        total = made.photons_per_mm2_mas_at_1m.sum()
        assert total == pytest.approx(whole.photons_per_mm2_mas_at_1m.sum(), rel=1e-12)
    for edge in edges[:2]:
        near = grouped.energies_kev[np.abs(grouped.energies_kev - edge) < 1]
        assert np.any(near < edge)
        assert np.any(near > edge)


@pytest.mark.compare
@pytest.mark.parametrize("case", SPEKPY["cases"], ids=case_id)
def test_the_kept_values_are_spekpys(case: dict[str, Any]) -> None:
    spekpy = pytest.importorskip("spekpy")
    target, angle = {
        "tungsten": ("W", 12),
        "molybdenum": ("Mo", 16),
        "rhodium": ("Rh", 16),
    }[case["anode"]]
    for source in ("pene", "nist"):
        spek = spekpy.Spek(kvp=case["kvp"], th=angle, targ=target, dk=0.1, mu_data_source=source)
        for name, thickness_mm in case["filters_mm"].items():
            spek.filter(name, thickness_mm)
        kept = case[source]
        assert spek.get_hvl1() == pytest.approx(kept["first_half_value_layer_mm"], rel=1e-5)
        assert spek.get_kerma() == pytest.approx(kept["air_kerma_ugy_per_mas_at_1m"], rel=1e-5)
