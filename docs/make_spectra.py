"""Write the shipped spectra, and what spekpy itself says of some of them.

    uv run --group spectra python docs/make_spectra.py

spekpy: R. Bujila, A. Omar and G. Poludniowski, A validation of SpekPy: a software toolkit for
modelling x-ray tube spectra, Phys. Med. 75 (2020) 44-54, doi:10.1016/j.ejmp.2020.04.026; G.
Poludniowski et al., Technical note: SpekPy v2.0, Med. Phys. 48 (2021) 3630-3637,
doi:10.1002/mp.14945. MIT licence.

The tables are spectra as they leave the anode: self-filtration by the anode is in them, window,
filters and air are not. Bremsstrahlung is counted in bins of 0.5 keV from 1 keV on. Characteristic
photons are kept apart, at the energies of their lines (lines that share a bin are one line at
their mean energy), since a line is not spread over a bin.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import spekpy

ROOT = Path(__file__).parents[1]
TABLES = ROOT / "phantom" / "imaging" / "data" / "spectra.npz"
OPINIONS = ROOT / "tests" / "imaging" / "spekpy_values.json"

BIN_KEV = 0.5
LINE_BIN_KEV = 0.05
LEAST_KEV = 1.0
ANODES = {  # spekpy's name, effective angle in degrees, least and greatest kVp
    "tungsten": ("W", 12.0, 20, 150),
    "molybdenum": ("Mo", 16.0, 20, 50),
    "rhodium": ("Rh", 16.0, 20, 50),
}

CASES = [  # anode, kVp, filters in mm; half of the kVp lie between those of the tables
    ("tungsten", 40, {"Al": 2.5}),
    ("tungsten", 50.5, {"Al": 2.5}),
    ("tungsten", 70, {"Al": 2.5}),
    ("tungsten", 69.9, {"Al": 2.5}),
    ("tungsten", 75.5, {"Al": 3.0, "Cu": 0.1}),
    ("tungsten", 90.25, {"Al": 2.5}),
    ("tungsten", 100, {"Al": 2.5}),
    ("tungsten", 120, {"Al": 2.5, "Cu": 0.2}),
    ("tungsten", 149.5, {"Al": 2.5}),
    ("tungsten", 28, {"Be": 0.5, "Rh": 0.05}),
    ("tungsten", 30.5, {"Be": 0.5, "Ag": 0.05}),
    ("tungsten", 28, {"Be": 0.5, "Al": 0.7}),
    ("molybdenum", 28, {"Be": 0.5, "Mo": 0.03}),
    ("molybdenum", 25.5, {"Be": 0.5, "Mo": 0.03}),
    ("molybdenum", 30, {"Be": 0.5, "Rh": 0.025}),
    ("rhodium", 30.5, {"Be": 0.5, "Rh": 0.025}),
    ("rhodium", 34, {"Be": 0.5, "Rh": 0.025}),
]


def model(anode: str, kvp: float, bin_kev: float = BIN_KEV, **options: object) -> spekpy.Spek:
    target, angle_deg, *_ = ANODES[anode]
    return spekpy.Spek(kvp=kvp, th=angle_deg, targ=target, dk=bin_kev, z=100, mas=1, **options)


def lines(anode: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the bins that hold lines, and the mean energy of the photons in each, in keV."""
    fine, photons = model(anode, ANODES[anode][3], LINE_BIN_KEV, brem=False).get_spectrum(
        edges=False, diff=False
    )
    bins = np.floor((fine - LEAST_KEV) / BIN_KEV).astype(int)
    held = np.unique(bins[photons > 0])
    energies = [np.average(fine[bins == b], weights=photons[bins == b]) for b in held]
    return held, np.array(energies)


def tables(anode: str) -> dict[str, np.ndarray]:
    *_, least, greatest = ANODES[anode]
    kvp = np.arange(least, greatest + 1)
    edges = np.arange(LEAST_KEV, greatest + BIN_KEV / 2, BIN_KEV)
    continuum = np.zeros((len(kvp), len(edges) - 1))
    held, energies = lines(anode)
    characteristic = np.zeros((len(kvp), len(held)))
    for row, potential in enumerate(kvp):
        middles, photons = model(anode, potential, char=False).get_spectrum(edges=False, diff=False)
        np.testing.assert_allclose(middles, edges[: len(middles)] + BIN_KEV / 2)
        continuum[row, : len(middles)] = photons
        _, photons = model(anode, potential, brem=False).get_spectrum(edges=False, diff=False)
        here = held[held < len(photons)]
        characteristic[row, : len(here)] = photons[here]
        assert np.isclose(characteristic[row].sum(), photons.sum(), rtol=1e-9), anode
    return {
        "kvp": kvp.astype(np.float64),
        "edges_kev": edges,
        "continuum_per_cm2": continuum.astype(np.float32),
        "line_energies_kev": np.round(energies, 3),
        "lines_per_cm2": characteristic.astype(np.float32),
    }


def opinion(anode: str, kvp: float, filters: dict[str, float]) -> dict[str, object]:
    """Return what spekpy says, with each of its two sets of coefficients."""
    said: dict[str, object] = {"anode": anode, "kvp": kvp, "filters_mm": filters}
    for source in ("pene", "nist"):
        # Bins of 0.1 keV: in wide ones spekpy puts a line at the middle of its bin.
        spek = model(anode, kvp, 0.1, mu_data_source=source)
        for name, thickness_mm in filters.items():
            spek.filter(name, thickness_mm)
        said[source] = {
            "first_half_value_layer_mm": round(spek.get_hvl1(), 6),
            "second_half_value_layer_mm": round(spek.get_hvl2(), 6),
            "air_kerma_ugy_per_mas_at_1m": round(spek.get_kerma(), 6),
            "mean_energy_kev": round(spek.get_emean(), 6),
        }
    return said


def main() -> None:
    TABLES.parent.mkdir(exist_ok=True)
    found = {f"{a}_{name}": array for a in ANODES for name, array in tables(a).items()}
    np.savez_compressed(TABLES, **found)
    said = [opinion(*case) for case in CASES]
    OPINIONS.write_text(json.dumps({"spekpy": spekpy.__version__, "cases": said}, indent=1) + "\n")


if __name__ == "__main__":
    main()
