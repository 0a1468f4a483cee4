"""Body tissues of ICRU Report 44, as numbers.

Compositions and densities: ICRU Report 44, *Tissue Substitutes in Radiation Dosimetry and
Measurement* (1989), appendix A; also in White, Woodard & Hammond, *Average soft-tissue and bone
models for use in radiation dosimetry*, Br. J. Radiol. 60 (1987) 907-913, and, where NIST repeats
them, in J. H. Hubbell and S. M. Seltzer, *X-Ray Mass Attenuation Coefficients*, NISTIR 5632,
table 2 (doi:10.18434/T4D01F).
"""

from __future__ import annotations

from typing import Final

_ICRU = "ICRU Report 44 (1989)"
_ICRU_NIST = "ICRU Report 44 (1989), repeated in NISTIR 5632 table 2"

Row = tuple[str, float, dict[str, float], str]
"""Title, density in g/cm³, mass fractions, source."""

# fmt: off
TABLE: Final[dict[str, Row]] = {
    "cortical_bone_icru44": ("Cortical bone, adult", 1.92, {
        "H": 0.034, "C": 0.155, "N": 0.042, "O": 0.435, "Na": 0.001, "Mg": 0.002, "P": 0.103,
        "S": 0.003, "Ca": 0.225}, _ICRU_NIST),
    "spongiosa_icru44": ("Spongiosa, adult", 1.18, {
        "H": 0.085, "C": 0.404, "N": 0.028, "O": 0.367, "Na": 0.001, "Mg": 0.001, "P": 0.034,
        "S": 0.002, "Cl": 0.002, "K": 0.001, "Ca": 0.074, "Fe": 0.001}, _ICRU),
    "red_marrow_icru44": ("Red bone marrow, adult", 1.03, {
        "H": 0.105, "C": 0.414, "N": 0.034, "O": 0.439, "P": 0.001, "S": 0.002, "Cl": 0.002,
        "K": 0.002, "Fe": 0.001}, _ICRU),
    "yellow_marrow_icru44": ("Yellow bone marrow, adult", 0.98, {
        "H": 0.115, "C": 0.644, "N": 0.007, "O": 0.231, "Na": 0.001, "S": 0.001, "Cl": 0.001},
        _ICRU),
    "soft_tissue_icru44": ("Average soft tissue, adult male", 1.06, {
        "H": 0.102, "C": 0.143, "N": 0.034, "O": 0.708, "Na": 0.002, "P": 0.003, "S": 0.003,
        "Cl": 0.002, "K": 0.003}, _ICRU_NIST),
    "muscle_icru44": ("Skeletal muscle, adult", 1.05, {
        "H": 0.102, "C": 0.143, "N": 0.034, "O": 0.710, "Na": 0.001, "P": 0.002, "S": 0.003,
        "Cl": 0.001, "K": 0.004}, _ICRU_NIST),
    "adipose_icru44": ("Adipose tissue, adult", 0.95, {
        "H": 0.114, "C": 0.598, "N": 0.007, "O": 0.278, "Na": 0.001, "S": 0.001, "Cl": 0.001},
        _ICRU_NIST),
    "skin_icru44": ("Skin, adult", 1.09, {
        "H": 0.100, "C": 0.204, "N": 0.042, "O": 0.645, "Na": 0.002, "P": 0.001, "S": 0.002,
        "Cl": 0.003, "K": 0.001}, _ICRU),
    "lung_icru44": ("Lung, adult, inflated", 0.26, {
        "H": 0.103, "C": 0.105, "N": 0.031, "O": 0.749, "Na": 0.002, "P": 0.002, "S": 0.003,
        "Cl": 0.003, "K": 0.002}, _ICRU_NIST + "; density of the inflated lung"),
    "breast_gland_icru44": ("Mammary gland, adult", 1.02, {
        "H": 0.106, "C": 0.332, "N": 0.030, "O": 0.527, "Na": 0.001, "P": 0.001, "S": 0.002,
        "Cl": 0.001}, _ICRU_NIST),
    "cartilage_icru44": ("Cartilage, adult", 1.10, {
        "H": 0.096, "C": 0.099, "N": 0.022, "O": 0.744, "Na": 0.005, "P": 0.022, "S": 0.009,
        "Cl": 0.003}, _ICRU),
    "blood_icru44": ("Whole blood, adult", 1.06, {
        "H": 0.102, "C": 0.110, "N": 0.033, "O": 0.745, "Na": 0.001, "P": 0.001, "S": 0.002,
        "Cl": 0.003, "K": 0.002, "Fe": 0.001}, _ICRU_NIST),
}
# fmt: on
