"""The chemical elements a composition may name: hydrogen to californium.

These are the elements whose attenuation the tables behind ``xraylib`` hold (Z = 1 to 98).
"""

from __future__ import annotations

from typing import Final

_SYMBOLS: Final = """
H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br
Kr Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho
Er Tm Yb Lu Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu Am Cm Bk Cf
"""

ELEMENTS: Final[tuple[str, ...]] = tuple(_SYMBOLS.split())
"""Symbols in order of atomic number: ``ELEMENTS[z - 1]``."""

ATOMIC_NUMBERS: Final[dict[str, int]] = {symbol: z for z, symbol in enumerate(ELEMENTS, start=1)}
"""Atomic number of every symbol in :data:`ELEMENTS`."""
