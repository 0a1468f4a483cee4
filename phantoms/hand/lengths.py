"""Lengths of the hand's tubular bones, of the mean adult and of a person.

From joint space to joint space: Buryanov and Kotiuk 2010, 66 adults of both sexes, means and
standard deviations. Women's lengths are taken as 92 % of men's, as Ozsoy, Oner and Oner (2019, 30
men and 30 women) found of proximal and of middle phalanges (88 % of distal ones); the correlation
with stature is that of the metacarpals, 0.71 (Archives of Bone and Joint Surgery 2024, 80233).
"""

from __future__ import annotations

import math
from typing import Annotated, Final

from phantom.document import told
from phantom.document.base import Number
from phantom.library import Person, PersonParameters
from phantoms.hand.frames import KINDS
from phantoms.hand.sizes import DIGITS, DISTAL, METACARPAL, MIDDLE, PROXIMAL
from phantoms.people import Measure

LENGTHS_MM: Final[dict[str, dict[str, tuple[float, float]]]] = {
    METACARPAL: {
        "thumb": (46.2, 3.9),
        "index": (68.1, 6.3),
        "middle": (64.6, 5.4),
        "ring": (58.0, 5.1),
        "little": (53.7, 4.4),
    },
    PROXIMAL: {
        "thumb": (31.6, 3.1),
        "index": (39.8, 4.9),
        "middle": (44.6, 3.8),
        "ring": (41.4, 3.9),
        "little": (32.7, 2.8),
    },
    MIDDLE: {
        "index": (22.4, 2.5),
        "middle": (26.3, 3.0),
        "ring": (25.7, 3.3),
        "little": (18.1, 2.5),
    },
    DISTAL: {
        "thumb": (21.7, 1.6),
        "index": (15.8, 2.3),
        "middle": (17.4, 1.9),
        "ring": (17.3, 2.2),
        "little": (16.0, 2.5),
    },
}
"""Mean and standard deviation of each bone."""

_DIMORPHISM: Final = 0.0415
"""How far the sexes' means lie from the common one; (1 - d) / (1 + d) is 0.92."""
_CORRELATION: Final = 0.71
_MOST_SPREAD: Final = 0.075
"""Spread of a length over its mean, at most: short bones were measured less well (estimate)."""

BONES: Final = tuple(f"{digit} {kind}" for digit in DIGITS for kind in KINDS[digit])
"""Names of the tubular bones, ray by ray."""

_Metacarpal = Annotated[Number | None, told("Metacarpal", "mm", "Length.", ge=28.0, le=95.0)]
_Proximal = Annotated[Number | None, told("Proximal phalanx", "mm", "Length.", ge=20.0, le=65.0)]
_Middle = Annotated[Number | None, told("Middle phalanx", "mm", "Length.", ge=11.0, le=38.0)]
_Distal = Annotated[Number | None, told("Distal phalanx", "mm", "Length.", ge=9.0, le=30.0)]


class BoneLengths(PersonParameters):
    """A person and the lengths of the hand's bones; null is what the stature gives."""

    thumb_metacarpal_mm: _Metacarpal = None
    thumb_proximal_phalanx_mm: _Proximal = None
    thumb_distal_phalanx_mm: _Distal = None
    index_metacarpal_mm: _Metacarpal = None
    index_proximal_phalanx_mm: _Proximal = None
    index_middle_phalanx_mm: _Middle = None
    index_distal_phalanx_mm: _Distal = None
    middle_metacarpal_mm: _Metacarpal = None
    middle_proximal_phalanx_mm: _Proximal = None
    middle_middle_phalanx_mm: _Middle = None
    middle_distal_phalanx_mm: _Distal = None
    ring_metacarpal_mm: _Metacarpal = None
    ring_proximal_phalanx_mm: _Proximal = None
    ring_middle_phalanx_mm: _Middle = None
    ring_distal_phalanx_mm: _Distal = None
    little_metacarpal_mm: _Metacarpal = None
    little_proximal_phalanx_mm: _Proximal = None
    little_middle_phalanx_mm: _Middle = None
    little_distal_phalanx_mm: _Distal = None


def field(digit: str, kind: str) -> str:
    """Return the name of the parameter that holds a bone's length."""
    return f"{digit}_{kind.replace(' ', '_')}_mm"


def length_mm(person: Person, digit: str, kind: str, scatter: float = 0.0) -> float:
    """Return the length of a bone that goes with a person's stature.

    ``scatter`` is a standard normal number, for what stature leaves unexplained.
    """
    mean, spread = LENGTHS_MM[kind][digit]
    # Half of what lies between the sexes is no scatter within one.
    within = min(math.sqrt(spread**2 - (_DIMORPHISM * mean) ** 2), _MOST_SPREAD * mean)
    male, female = (1 + _DIMORPHISM) * mean, (1 - _DIMORPHISM) * mean
    return Measure((male, within), (female, within), _CORRELATION).of(person, scatter)


def hand_scale(person: Person) -> float:
    """Return how much larger a person's hand is than that of the mean adult."""
    return length_mm(person, "middle", METACARPAL) / LENGTHS_MM[METACARPAL]["middle"][0]
