"""How much scattered radiation leaves a slab of water: photons followed one by one.

An independent account of what ``phantom.imaging.detection.slab`` computes with an integral: a
pencil beam enters a slab of water that is wide without end; photoelectric absorption, Compton
scattering (incoherent scattering function) and Rayleigh scattering (form factor) are played with
the cross sections of xraylib.

Prints, for each energy and thickness: photons that leave the far side after one and after more
scatterings, over the photons that were never scattered; the energy they keep; and the width a of
``(1 + r²/a²)^-3``, fitted to where those scattered more than once arrive, on the far side and 200
mm behind it; and for one slab what arrives inside rings. With ``table`` the rows are those of
``phantom/imaging/detection/multiple.py``.

    uv run python bench/scatter_in_water.py [histories] [table]
"""

from __future__ import annotations

import math
import sys

import numba
import numpy as np
import xraylib

WATER = {1: 0.111907, 8: 0.888093}
ENERGIES_KEV = np.arange(8.0, 151.0)
COSINES = np.linspace(-1.0, 1.0, 401)


def tables() -> tuple[np.ndarray, ...]:
    """Coefficients in 1/mm at every energy, and cumulative distributions of the cosine."""
    total, compton, rayleigh, of_compton, of_rayleigh = [], [], [], [], []
    middles = np.arccos((COSINES[1:] + COSINES[:-1]) / 2)
    for energy in ENERGIES_KEV.tolist():
        rows = [np.zeros(len(middles)), np.zeros(len(middles))]
        sums = [0.0, 0.0, 0.0]
        for z, fraction in WATER.items():
            sums[0] += 0.1 * fraction * xraylib.CS_Total(z, energy)
            sums[1] += 0.1 * fraction * xraylib.CS_Compt(z, energy)
            sums[2] += 0.1 * fraction * xraylib.CS_Rayl(z, energy)
            rows[0] += [fraction * xraylib.DCS_Compt(z, energy, a) for a in middles.tolist()]
            rows[1] += [fraction * xraylib.DCS_Rayl(z, energy, a) for a in middles.tolist()]
        total.append(sums[0])
        compton.append(sums[1])
        rayleigh.append(sums[2])
        for row, kept in zip(rows, (of_compton, of_rayleigh), strict=True):
            kept.append(np.concatenate([[0.0], np.cumsum(row) / row.sum()]))
    return tuple(np.array(t) for t in (total, compton, rayleigh, of_compton, of_rayleigh))


# ruff: noqa: NPY002 - numba follows its own copy of numpy's older generator
@numba.njit(nogil=True)
def follow(histories, energy0, thickness, gaps, tabs, radii, seed):
    """Return leaving photons and energy by number of scatterings (1, more), and shares in rings."""
    total, compton, rayleigh, of_compton, of_rayleigh = tabs
    np.random.seed(seed)
    out = np.zeros(2)
    energy_out = np.zeros(2)
    rings = np.zeros((2, len(gaps), len(radii)))
    for _ in range(histories):
        x, y, z, u, v, w = 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
        energy, weight, count = energy0, 1.0, 0
        while True:
            place = min(max(energy - 8.0, 0.0), 141.999)
            i = int(place)
            f = place - i
            mu = total[i] * (1 - f) + total[i + 1] * f
            mu_c = compton[i] * (1 - f) + compton[i + 1] * f
            mu_r = rayleigh[i] * (1 - f) + rayleigh[i + 1] * f
            step = -math.log(1.0 - np.random.random()) / mu
            if count == 0:
                # The first scattering is forced to happen inside the slab.
                inside = 1.0 - math.exp(-mu * thickness)
                weight *= inside
                step = -math.log(1.0 - np.random.random() * inside) / mu
            x, y, z = x + u * step, y + v * step, z + w * step
            if z < 0.0:
                break
            if z > thickness:
                kind = 0 if count == 1 else 1
                out[kind] += weight
                energy_out[kind] += weight * energy / energy0
                for g in range(len(gaps)):
                    back = (thickness + gaps[g] - z) / w
                    radius = math.hypot(x + u * back, y + v * back)
                    for k in range(len(radii)):
                        if radius < radii[k]:
                            rings[kind, g, k] += weight
                break
            weight *= (mu_c + mu_r) / mu
            if weight < 1e-6 or energy < 8.5:
                break
            is_compton = np.random.random() * (mu_c + mu_r) < mu_c
            cumulative = of_compton[i] if is_compton else of_rayleigh[i]
            at = np.random.random()
            k = np.searchsorted(cumulative, at) - 1
            k = min(max(k, 0), len(cumulative) - 2)
            span = cumulative[k + 1] - cumulative[k]
            cosine = -1.0 + (k + (at - cumulative[k]) / span) * 2.0 / (len(cumulative) - 1)
            if is_compton:
                energy = energy / (1 + energy / 510.99895 * (1 - cosine))
            sine, turn = math.sqrt(max(0.0, 1 - cosine * cosine)), 2 * math.pi * np.random.random()
            a, b = sine * math.cos(turn), sine * math.sin(turn)
            side = math.sqrt(u * u + v * v)
            if side < 1e-9:
                u, v, w = a, b, cosine * (1.0 if w > 0 else -1.0)
            else:
                nu = u * cosine + (u * w * a - v * b) / side
                nv = v * cosine + (v * w * a + u * b) / side
                u, v, w = nu, nv, w * cosine - side * a
            count += 1
    rings[0] /= out[0]
    rings[1] /= out[1]
    return out / histories, energy_out / out, rings


def width_mm(radii: np.ndarray, shares: np.ndarray) -> float:
    """The a for which 1 − (1 + r²/a²)^-2 comes nearest to the shares inside the radii."""
    tried = np.geomspace(2, 2000, 4000)
    model = 1 - (1 + (radii / tried[:, None]) ** 2) ** -2
    return float(tried[((model - shares) ** 2).sum(axis=1).argmin()])


def main() -> None:
    """Print the table."""
    words = sys.argv[1:]
    as_table = "table" in words
    histories = next((int(w) for w in words if w.isdigit()), 400_000)
    tabs = tables()
    radii = np.array([10.0, 20, 30, 50, 70, 100, 150, 200, 300, 500])
    if not as_table:
        print("keV   mm  once/primary  more/once  energy kept once, more  width mm at 0, 200 mm")
    for energy in (20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0):
        row = []
        for thickness in (10.0, 20.0, 50.0, 100.0, 150.0, 200.0, 300.0, 400.0):
            primary = math.exp(-float(np.interp(energy, ENERGIES_KEV, tabs[0])) * thickness)
            if primary > 1e-4:
                gaps = np.array([0.0, 200.0])
                out, kept, rings = follow(histories, energy, thickness, gaps, tabs, radii, 1)
                near, far = (width_mm(radii, shares) for shares in rings[1])
                found = (out[1] / out[0], kept[1], near, (far - near) / 200)
            # Hardly anything passes unscattered: the last thickness that was followed stands in.
            row.append("({:.3f}, {:.3f}, {:.1f}, {:.2f})".format(*found))
            if not as_table and primary > 1e-4:
                print(
                    f"{energy:3.0f} {thickness:4.0f} {out[0] / primary:13.4f} {found[0]:10.3f} "
                    f"{kept[0]:12.3f} {kept[1]:9.3f} {near:14.1f} {far:6.1f}"
                )
        if as_table:
            print(f"    ({', '.join(row)}),  # {energy:.0f} keV")
    if not as_table:
        _, _, rings = follow(histories, 100.0, 100.0, np.array([50.0]), tabs, radii, 1)
        print("100 keV, 100 mm, 50 mm behind: radius, inside it scattered once, more")
        for radius, once, more in zip(radii, rings[0, 0], rings[1, 0], strict=True):
            print(f"{radius:5.0f} {once:.4f} {more:.4f}")


if __name__ == "__main__":
    main()
