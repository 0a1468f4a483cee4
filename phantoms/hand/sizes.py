"""Widths of the hand's tubular bones, and how their sections change along them.

The widths are estimates for the mean adult of both sexes; a bone's length is the person's own. In a
bone's frame z rises along it from the middle of its base, +x is the thumb's side and +y the back of
the hand.
"""

from __future__ import annotations

from typing import Final, Literal, NamedTuple

from phantoms.parts import Station

Digit = Literal["thumb", "index", "middle", "ring", "little"]
DIGITS: Final[tuple[Digit, ...]] = ("thumb", "index", "middle", "ring", "little")
METACARPAL, PROXIMAL, MIDDLE, DISTAL = (
    "metacarpal",
    "proximal phalanx",
    "middle phalanx",
    "distal phalanx",
)

RIM_MM: Final = 1.1
"""How far the rim of a hollow base reaches beyond its middle."""


class Width(NamedTuple):
    """Widths of a bone, then its depths (from palm to back): base, shaft or waist, head or tuft."""

    base: float
    shaft: float
    head: float
    base_depth: float
    shaft_depth: float
    head_depth: float

    def times(self, factor: float) -> Width:
        """Return the widths of a bone that much thicker."""
        return Width(*(factor * width for width in self))


WIDTHS: Final[dict[str, dict[str, Width]]] = {
    METACARPAL: {
        "thumb": Width(15.5, 11.2, 14.8, 14.5, 8.6, 12.2),
        "index": Width(14.4, 8.9, 15.4, 15.5, 9.4, 14.8),
        "middle": Width(13.3, 8.9, 15.0, 16.0, 9.6, 15.0),
        "ring": Width(10.6, 7.2, 13.0, 13.5, 8.0, 13.0),
        "little": Width(10.6, 7.6, 12.4, 11.5, 7.4, 12.0),
    },
    PROXIMAL: {
        "thumb": Width(15.0, 9.2, 12.4, 11.5, 6.8, 8.4),
        "index": Width(15.6, 9.9, 12.0, 11.5, 7.6, 8.8),
        "middle": Width(16.0, 10.3, 12.4, 12.0, 8.0, 9.2),
        "ring": Width(14.8, 9.5, 11.6, 11.5, 7.4, 8.6),
        "little": Width(13.4, 8.0, 9.8, 10.2, 6.2, 7.4),
    },
    MIDDLE: {
        "index": Width(13.4, 8.3, 10.6, 9.6, 6.0, 6.8),
        "middle": Width(14.0, 8.8, 11.1, 10.0, 6.4, 7.2),
        "ring": Width(13.2, 8.3, 10.5, 9.4, 6.0, 6.7),
        "little": Width(11.2, 6.7, 8.8, 8.0, 5.0, 5.7),
    },
    DISTAL: {
        "thumb": Width(14.6, 7.6, 11.0, 9.0, 5.4, 4.8),
        "index": Width(11.6, 5.2, 9.2, 7.4, 4.3, 3.9),
        "middle": Width(12.1, 5.6, 9.8, 7.7, 4.5, 4.1),
        "ring": Width(11.6, 5.4, 9.4, 7.3, 4.3, 3.9),
        "little": Width(9.8, 4.5, 7.8, 6.2, 3.7, 3.4),
    },
}

# Place as a share of the length, then how much of the way from the shaft's size to the end's.
_METACARPAL_BASE: Final = (
    (0.0, 0.8),
    (0.012, 0.94),
    (0.045, 1.0),
    (0.10, 0.84),
    (0.18, 0.48),
    (0.28, 0.17),
    (0.40, 0.02),
)
_PHALANX_BASE: Final = ((0.025, 0.92), (0.085, 1.0), (0.17, 0.72), (0.27, 0.33), (0.40, 0.07))
# Place back from the plane through the head's middle.
_METACARPAL_HEAD: Final = ((0.38, 0.02), (0.26, 0.16), (0.16, 0.45), (0.07, 0.84), (0.0, 0.97))
_PHALANX_HEAD: Final = ((0.32, 0.02), (0.2, 0.2), (0.11, 0.56), (0.045, 0.9), (0.0, 0.96))
_DISTAL_BASE: Final = ((0.04, 0.97), (0.11, 0.93), (0.24, 0.44), (0.40, 0.07))
_TUFT: Final = ((0.55, 0.0), (0.7, 0.38), (0.84, 0.98))
# Beyond the tuft's widest place: shares of its size itself.
_TIP: Final = ((0.93, 0.86), (0.98, 0.56), (1.0, 0.3))


def head_length_mm(kind: str, width: Width) -> float:
    """Return how far a head reaches beyond its middle."""
    return 0.46 * width.head_depth if kind == METACARPAL else 0.31 * width.head


def stations(kind: str, width: Width, length_mm: float, bow_mm: float) -> list[Station]:
    """Return the sections of a bone's shaft and base, up to the middle of its head.

    Parameters
    ----------
    kind
        :data:`METACARPAL`, :data:`PROXIMAL`, :data:`MIDDLE` or :data:`DISTAL`.
    bow_mm
        How far the shaft bows to the back of the hand.
    """
    half = [value / 2 for value in width]
    base, shaft, head = zip(half[:3], half[3:], strict=True)

    def between(end: tuple[float, float], share: float) -> tuple[float, float]:
        return (shaft[0] + share * (end[0] - shaft[0]), shaft[1] + share * (end[1] - shaft[1]))

    rows: list[tuple[float, tuple[float, float]]] = []
    if kind == METACARPAL:
        rows += [(at * length_mm, between(base, share)) for at, share in _METACARPAL_BASE]
    else:
        rows.append((-RIM_MM, (0.86 * base[0], 0.86 * base[1])))
        near = _DISTAL_BASE if kind == DISTAL else _PHALANX_BASE
        rows += [(at * length_mm, between(base, share)) for at, share in near]
    if kind == DISTAL:
        rows += [(at * length_mm, between(head, share)) for at, share in _TUFT]
        rows += [(at * length_mm, (share * head[0], share * head[1])) for at, share in _TIP]
    else:
        end = length_mm - head_length_mm(kind, width)
        table = _METACARPAL_HEAD if kind == METACARPAL else _PHALANX_HEAD
        # A stubby bone has less shaft, not less head.
        room = (end - rows[-1][0]) / (table[0][0] * length_mm)
        back_mm = min(1.0, 0.9 * room) * length_mm
        rows += [(end - back * back_mm, between(head, share)) for back, share in table]
    first, last = rows[0][0], rows[-1][0]

    def bowed(z: float) -> float:
        share = (z - first) / (last - first)
        return 4 * bow_mm * share * (1 - share)

    return [Station((0.0, bowed(z), z), (-x, x), (-y, y)) for z, (x, y) in rows]
