"""Everything of the reference table that is not a body tissue, as numbers.

Fractions of pure compounds follow from the formula and the 2021 IUPAC atomic weights; those of the
two contrast media follow from the stated masses of compound and water in a volume.
"""

from __future__ import annotations

from typing import Final

from phantom.materials.tissues import Row

# fmt: off
TABLE: Final[dict[str, Row]] = {
    "water": ("Water, liquid", 1.00, {
        "H": 0.111907, "O": 0.888093}, "H2O; rounded density, 0.998 at 20 degrees Celsius"),
    "air": ("Air, dry, near sea level", 0.001205, {
        "C": 0.000124, "N": 0.755268, "O": 0.231781, "Ar": 0.012827},
        "NISTIR 5632 table 2; 20 degrees Celsius, 101.325 kPa"),
    "pmma": ("Poly(methyl methacrylate)", 1.19, {
        "H": 0.080546, "C": 0.599848, "O": 0.319606},
        "C5H8O2; density of NISTIR 5632 table 2"),
    "aluminium": ("Aluminium", 2.70, {"Al": 1.0}, "pure element; NISTIR 5632 table 1 (2.699)"),
    "titanium": ("Titanium", 4.54, {"Ti": 1.0}, "pure element; NISTIR 5632 table 1"),
    "steel": ("Stainless steel AISI 316L", 8.00, {
        "C": 0.0003, "Si": 0.01, "P": 0.00045, "S": 0.0003, "Cr": 0.17, "Mn": 0.02, "Fe": 0.65395,
        "Ni": 0.12, "Mo": 0.025},
        "AISI 316L at its nominal limits; PNNL-15870 Rev. 1 (2011), stainless steel 316L"),
    "glass": ("Glass, fused silica at the density of window glass", 2.50, {
        "O": 0.532563, "Si": 0.467437}, "SiO2; density of soda-lime glass"),
    "calcium_oxalate": ("Calcium oxalate monohydrate", 2.20, {
        "H": 0.013798, "C": 0.164409, "O": 0.547495, "Ca": 0.274298},
        "CaC2O4.H2O (whewellite); mineral density"),
    "hydroxyapatite": ("Hydroxyapatite", 3.16, {
        "H": 0.002007, "O": 0.414064, "P": 0.18499, "Ca": 0.398939},
        "Ca5(PO4)3OH; crystal density"),
    "iodine_350": ("Iohexol solution, 350 mg iodine per mL", 1.406, {
        "H": 0.068959, "C": 0.149217, "N": 0.027476, "O": 0.505415, "I": 0.248933},
        "755 mg iohexol (C19H26I3N3O9) per mL and water to 1.406 g/mL, the specific gravity at 37 "
        "degrees Celsius on the label of Omnipaque 350; buffer (0.1 %) left out"),
    "barium_sulfate_suspension": ("Barium sulfate suspension, 60 % w/v", 1.467, {
        "H": 0.066127, "O": 0.636959, "S": 0.056197, "Ba": 0.240717},
        "60 g BaSO4 (4.50 g/cm3) and water to 100 mL, volumes adding; additives left out"),
}
# fmt: on
