"""Case 1 of AAPM Report 195: the spectra, the layers of aluminium and the air kerma behind them.

I. Sechopoulos et al., *Monte Carlo Reference Data Sets for Imaging Research*, AAPM Report No. 195
(2015); summary in Med. Phys. 42 (2015) 5679-5691, doi:10.1118/1.4928676. A source, a slab of
aluminium (2.699 g/cm³) near it, a detector at 1 m, air everywhere. ``KERMA`` is the air kerma per
photon without aluminium, behind the half-value layer and behind the quarter-value layer, the mean
of the four codes' results; their ratios are what is compared.
"""

from __future__ import annotations

import numpy as np

AIR_MM = 1000.0
ALUMINIUM_G_CM3 = 2.699

LAYERS_MM = {
    "30 keV": (2.273, 4.546),
    "100 keV": (15.11, 30.22),
    "30 kVp": (0.3431, 0.7663),
    "100 kVp": (3.950, 9.840),
}

KERMA = {
    "30 keV": (5.732642e-2, 2.868487e-2, 1.435717e-2),
    "100 keV": (2.902460e-2, 1.448180e-2, 7.226802e-3),
    "30 kVp": (1.857530e-1, 9.281901e-2, 4.642190e-2),
    "100 kVp": (3.452395e-2, 1.725231e-2, 8.621281e-3),
}

MEAN_ENERGY_KEV = {"30 kVp": 16.8, "100 kVp": 50.6}
"""Of the photons that reach the detector through the air, as the report prints it."""

# Photons in bins of 0.5 keV by their middles, and the coefficients with which the report turns
# photons into air kerma: they are interpolated in another way, up to 0.9 % from ours.
# fmt: off
_ABSORPTION_CM2_G = """
7.25 12.92 7.75 10.50 8.25 8.649 8.75 7.219 9.25 6.073 9.75 5.154 10.25 4.411 10.75 3.804
11.25 3.301 11.75 2.880 12.25 2.528 12.75 2.230 13.25 1.976 13.75 1.759
14.25 1.572 14.75 1.410 15.25 1.270 15.75 1.146
16.25 1.038 16.75 .9434 17.25 .8599 17.75 .7864 18.25 .7204 18.75 .6611 19.25 .6083
19.75 .5612 20.25 .5211 21.25 .4496 22.25 .3901 23.25 .3411 24.25 .2974 25.25 .2621 26.25 .2325
27.25 .2070 28.25 .1851 29.25 .1663 30.25 .1501 31.25 .1360 32.25 .1240 33.25 .1133 34.25 .1041
35.25 .09581 36.25 .08868 37.25 .08236 38.25 .07670 39.25 .07165 40.25 .06715 41.25 .06310
42.25 .05947 43.25 .05629 44.25 .05332 45.25 .05069 46.25 .04832 47.25 .04610 48.25 .04411
49.25 .04233 50.25 .04068 52.25 .03781 54.25 .03532 56.25 .03334 58.25 .03166 60.25 .03020
62.25 .02893 64.25 .02788 66.25 .02704 68.25 .02629 70.25 .02568 72.25 .02518 74.25 .02476
76.25 .02452 78.25 .02425 80.25 .02407 84.25 .02378 88.25 .02355 92.25 .02341 96.25 .02331
99.75 .02328
"""
_30_KVP = """
1.551E-04 4.691E-04 1.199E-03 2.405E-03 4.263E-03 6.797E-03 9.761E-03 1.314E-02 1.666E-02 2.013E-02
2.349E-02 2.666E-02 2.933E-02 3.167E-02 3.365E-02 3.534E-02 3.644E-02 3.741E-02 3.796E-02 3.823E-02
3.445E-01 3.770E-02 3.704E-02 3.639E-02 9.200E-02 2.178E-03 2.048E-03 2.043E-03 2.098E-03 2.193E-03
2.327E-03 2.471E-03 2.625E-03 2.770E-03 2.907E-03 3.000E-03 3.062E-03 3.058E-03 2.988E-03 2.823E-03
2.575E-03 2.233E-03 1.815E-03 1.290E-03 6.696E-04 4.086E-05
"""
_100_KVP = """
1.423E-04 2.157E-04 3.102E-04 4.324E-04 5.840E-04 7.644E-04 9.784E-04 1.222E-03 1.491E-03 1.803E-03
2.129E-03 2.490E-03 2.863E-03 3.263E-03 3.658E-03 4.093E-03 4.504E-03 4.912E-03 5.347E-03 5.769E-03
6.168E-03 6.582E-03 6.965E-03 7.360E-03 7.710E-03 8.067E-03 8.368E-03 8.671E-03 8.975E-03 9.213E-03
9.476E-03 9.694E-03 9.903E-03 1.009E-02 1.025E-02 1.040E-02 1.053E-02 1.063E-02 1.073E-02 1.081E-02
1.087E-02 1.092E-02 1.096E-02 1.099E-02 1.100E-02 1.100E-02 1.099E-02 1.098E-02 1.095E-02 1.091E-02
1.086E-02 1.081E-02 1.076E-02 1.069E-02 1.063E-02 1.055E-02 1.048E-02 1.039E-02 1.031E-02 1.022E-02
1.012E-02 1.003E-02 9.933E-03 9.828E-03 9.732E-03 9.628E-03 9.516E-03 9.412E-03 9.302E-03 9.193E-03
9.084E-03 8.970E-03 8.862E-03 8.749E-03 8.637E-03 8.526E-03 8.409E-03 8.300E-03 8.185E-03 8.072E-03
7.959E-03 7.847E-03 7.737E-03 2.568E-02 7.513E-03 7.405E-03 3.920E-02 7.181E-03 7.071E-03 6.962E-03
6.854E-03 6.746E-03 6.640E-03 6.530E-03 6.425E-03 6.321E-03 6.214E-03 6.107E-03 6.006E-03 5.901E-03
5.797E-03 1.673E-02 5.592E-03 5.491E-03 5.390E-03 8.223E-03 5.055E-03 4.296E-03 4.236E-03 4.171E-03
4.110E-03 4.048E-03 3.982E-03 3.919E-03 3.852E-03 3.787E-03 3.719E-03 3.654E-03 3.585E-03 3.516E-03
3.449E-03 3.379E-03 3.308E-03 3.240E-03 3.169E-03 3.098E-03 3.026E-03 2.954E-03 2.882E-03 2.809E-03
2.736E-03 2.665E-03 2.592E-03 2.519E-03 2.445E-03 2.370E-03 2.296E-03 2.222E-03 2.148E-03 2.073E-03
1.999E-03 1.925E-03 1.850E-03 1.776E-03 1.700E-03 1.625E-03 1.550E-03 1.476E-03 1.400E-03 1.326E-03
1.251E-03 1.177E-03 1.101E-03 1.027E-03 9.529E-04 8.781E-04 8.041E-04 7.302E-04 6.559E-04 5.823E-04
5.089E-04 4.353E-04 3.623E-04 2.892E-04 2.166E-04 1.441E-04 7.193E-05 5.990E-06
"""
# fmt: on


def photons(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return energies in keV and photons of a beam of the report."""
    if name.endswith("keV"):
        return np.array([float(name.split()[0])]), np.ones(1)
    first, text = {"30 kVp": (7.25, _30_KVP), "100 kVp": (16.25, _100_KVP)}[name]
    weights = np.array(text.split(), dtype=float)
    return first + 0.5 * np.arange(len(weights)), weights


def absorption_cm2_g(energies_kev: np.ndarray) -> np.ndarray:
    """Return the report's mass energy-absorption coefficient of air."""
    table = np.array(_ABSORPTION_CM2_G.split(), dtype=float).reshape(-1, 2)
    return np.exp(np.interp(np.log(energies_kev), *np.log(table).T))
