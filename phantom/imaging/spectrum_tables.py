"""The shipped spectra: what an anode gives at a tube voltage, before any window or filter.

The tables were made with spekpy by ``docs/make_spectra.py``, one spectrum a kilovolt. They are
never extrapolated. Between two voltages the photons of a bin are interpolated linearly in the
voltage, but for the tip: a bremsstrahlung spectrum falls to zero in a straight line at E = kVp, so
above the lower voltage n, of the tip of the spectrum at n + 1, the part w² is left at n + w, spread
as the straight line has it. So no photon has more energy than the voltage gives.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Final, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.spectrum import Spectrum

FloatArray = NDArray[np.float64]
Anode = Literal["tungsten", "molybdenum", "rhodium"]

ANODES: Final[tuple[Anode, ...]] = get_args(Anode)
"""Every anode there are tables of."""

KVP_LIMITS: Final[dict[Anode, tuple[float, float]]] = {
    "tungsten": (20.0, 150.0),
    "molybdenum": (20.0, 50.0),
    "rhodium": (20.0, 50.0),
}
"""Least and greatest tube voltage of each anode's tables, in kV."""

ANODE_ANGLE_DEG: Final[dict[Anode, float]] = {
    "tungsten": 12.0,
    "molybdenum": 16.0,
    "rhodium": 16.0,
}
"""Angle between the anode's face and the central ray."""

_MM2_PER_CM2: Final = 100.0


@dataclass(frozen=True, eq=False)
class _Table:
    """Spectra of one anode: photons per cm² and mAs at 1 m.

    Attributes
    ----------
    kvp
        (V,) tube voltages, 1 kV apart.
    edges_kev
        (B + 1,) edges of the bins of the bremsstrahlung.
    continuum_per_cm2
        (V, B) bremsstrahlung photons of each bin.
    line_energies_kev
        (L,) energies of the characteristic lines.
    lines_per_cm2
        (V, L) photons of each line.
    """

    kvp: FloatArray
    edges_kev: FloatArray
    continuum_per_cm2: FloatArray
    line_energies_kev: FloatArray
    lines_per_cm2: FloatArray


def check_kvp(kvp: float, anode: Anode) -> tuple[Problem, ...]:
    """Return what is wrong with a tube voltage; nothing where the anode's tables hold it."""
    least, greatest = KVP_LIMITS[anode]
    if least <= kvp <= greatest:
        return ()
    expected = f"expected {least:g} to {greatest:g} kV, which the tables of {anode} hold"
    return (Problem("/beam/kvp", "out_of_range", f"found {kvp:g} kV; {expected}"),)


def anode_spectrum(anode: Anode, kvp: float) -> Spectrum:
    """Return the photons that leave an anode, self-filtered only, in bins of 0.5 keV and lines.

    Raises
    ------
    InvalidInputError
        The voltage is outside the tables (``/beam/kvp``).
    """
    problems = check_kvp(kvp, anode)
    if problems:
        raise InvalidInputError(problems)
    table = _table(anode)
    row = min(int(kvp - table.kvp[0]), len(table.kvp) - 2)
    below, weight = float(table.kvp[row]), kvp - float(table.kvp[row])
    lower, upper = table.continuum_per_cm2[row], table.continuum_per_cm2[row + 1]
    body = table.edges_kev[1:] <= below
    low, high = table.edges_kev[:-1], np.minimum(table.edges_kev[1:], kvp)
    tip = ~body & (low < kvp)
    # What is left of the tip between two energies goes with the difference of the squares of
    # their distances from the end.
    left = weight**2 * upper[tip].sum() if tip.any() else 0.0
    spread = ((kvp - low[tip]) ** 2 - (kvp - high[tip]) ** 2) / max(kvp - below, 1e-300) ** 2
    lines = (1 - weight) * table.lines_per_cm2[row] + weight * table.lines_per_cm2[row + 1]
    alight = (lines > 0) & (table.line_energies_kev < kvp)
    energies = ((low[body] + high[body]) / 2, (low[tip] + high[tip]) / 2)
    photons = ((1 - weight) * lower[body] + weight * upper[body], left * spread)
    widths = (high[body] - low[body], high[tip] - low[tip])
    return _sorted(
        np.concatenate([*energies, table.line_energies_kev[alight]]),
        np.concatenate([*photons, lines[alight]]) / _MM2_PER_CM2,
        np.concatenate([*widths, np.zeros(int(alight.sum()))]),
    )


def _sorted(energies: FloatArray, photons: FloatArray, widths: FloatArray) -> Spectrum:
    order = np.argsort(energies, kind="stable")
    return Spectrum(energies[order], photons[order], widths[order], absolute=True)


@cache
def _table(anode: Anode) -> _Table:
    with (
        files("phantom.imaging").joinpath("data/spectra.npz").open("rb") as stream,
        np.load(stream, allow_pickle=False) as arrays,
    ):
        names = _Table.__dataclass_fields__
        return _Table(**{n: arrays[f"{anode}_{n}"].astype(np.float64) for n in names})
