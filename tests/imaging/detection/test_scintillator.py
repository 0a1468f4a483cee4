"""What the absorbing layer stops, against independent tables."""

from __future__ import annotations

import numpy as np
import pytest
import xraydb

from phantom.imaging.detection import Absorber, DetectorModel
from phantom.imaging.detection.receptor import ABSORBERS
from phantom.imaging.detection.scintillator import response

FORMULAS = {
    "cesium_iodide": "CsI",
    "amorphous_selenium": "Se",
    "gadolinium_oxysulfide": "Gd2O2S",
}


@pytest.mark.parametrize(("name", "formula"), FORMULAS.items())
def test_compositions_follow_from_the_formulas(name: str, formula: str) -> None:
    masses = {s: n * xraydb.atomic_mass(s) for s, n in xraydb.chemparse(formula).items()}
    whole = sum(masses.values())
    found = ABSORBERS[name]  # type: ignore[index]
    assert found == pytest.approx({s: m / whole for s, m in masses.items()}, abs=2e-5)
    assert sum(found.values()) == pytest.approx(1, abs=1e-5)


@pytest.mark.parametrize(("name", "formula"), FORMULAS.items())
def test_the_stopped_fraction_is_that_of_other_tables(name: str, formula: str) -> None:
    energies = np.array([18.0, 25.0, 32.0, 45.0, 60.0, 90.0, 140.0])
    model = DetectorModel(absorber=Absorber(material=name, thickness_mg_cm2=180))  # type: ignore[arg-type]
    depth = sum(
        0.18
        * fraction
        * (xraydb.mu_elam(s, 1e3 * energies, "photo") + xraydb.mu_elam(s, 1e3 * energies, "incoh"))
        for s, fraction in ABSORBERS[name].items()  # type: ignore[index]
    )
    assert response(model, energies).stopped == pytest.approx(1 - np.exp(-depth), rel=0.02)


def test_more_is_stopped_above_the_k_edges() -> None:
    model = DetectorModel(absorber=Absorber(material="cesium_iodide", thickness_mg_cm2=100))
    # K edges: iodine 33.17 keV, caesium 35.98 keV.
    stopped = response(model, np.array([33.0, 33.3, 35.9, 36.1])).stopped
    assert stopped[1] > 1.5 * stopped[0]
    assert stopped[3] > 1.1 * stopped[2]


def test_an_ideal_detector_stops_all_and_reads_energy_or_photons() -> None:
    energies = np.array([30.0, 80.0])
    ideal = response(DetectorModel(gain_per_kev=2.0, swank_factor=0.8), energies)
    assert ideal.stopped.tolist() == [1, 1]
    assert ideal.gain.tolist() == [60, 160]
    assert ideal.weights == pytest.approx(np.array([[1, 60, 3600 / 0.8], [1, 160, 25600 / 0.8]]))
    counts = response(DetectorModel(response="photon_counting"), energies)
    assert counts.weights.tolist() == [[1, 1, 1], [1, 1, 1]]
