"""The ends of radius and ulna, and the thumb's sesamoids. Shapes are estimates for mean size.

The radius slopes 22 degrees from its styloid to the ulna, in a joint surface hollowed for scaphoid
and lunate; the ulna's head is round and has its styloid on the side of the little finger.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from phantom.document import Difference, Solid
from phantoms.hand.frames import Frame
from phantoms.hand.tubular import CORTEX, MARROW, SPONGIOSA
from phantoms.parts import Station, ellipsoid, layered, named, swept, union, within

END_Z_MM: Final = -72.0
"""Where the forearm is cut off."""

# z, then x of the ulnar and of the radial border, y of the palmar and of the back face.
_RADIUS: Final = (
    (-72.0, 2.0, 17.9, -6.2, 7.2),
    (-68.0, 1.0, 18.6, -6.5, 7.5),
    (-64.0, -0.6, 19.8, -7.0, 8.0),
    (-58.0, -2.8, 21.6, -7.8, 8.8),
    (-51.0, -5.4, 24.2, -9.0, 9.8),
    (-46.0, -6.7, 25.6, -9.8, 10.4),
    (-42.0, -6.9, 26.4, -10.0, 10.6),
    (-39.0, -5.6, 26.9, -9.8, 10.4),
    (-36.8, 1.0, 27.6, -9.2, 9.8),
    (-34.8, 10.0, 28.0, -8.0, 8.6),
    (-32.8, 18.0, 28.0, -6.4, 6.8),
    (-31.2, 22.4, 27.4, -4.2, 4.6),
    (-30.2, 24.6, 26.4, -1.8, 2.2),
)
_RADIUS_WALL: Final = (2.2, 2.1, 1.8, 1.4, 1.0, 0.8, 0.7, 0.7, 0.7, 0.7, 0.7, 0.7, 0.6)
_CARPAL_HOLLOW: Final = ((4.6, -0.3, -19.0), (23.0, 15.0, 18.2))
_ULNA: Final = (
    (-72.0, -24.4, -14.5, -5.0, 5.2),
    (-68.0, -24.4, -14.4, -5.0, 5.2),
    (-63.0, -24.4, -14.0, -5.2, 5.4),
    (-56.0, -24.8, -12.8, -5.8, 6.0),
    (-50.0, -25.4, -10.9, -6.8, 7.0),
    (-46.0, -25.8, -9.6, -7.6, 7.8),
    (-43.0, -25.7, -9.0, -7.8, 8.0),
    (-40.8, -25.0, -9.2, -7.2, 7.4),
    (-39.2, -23.6, -10.2, -5.8, 6.0),
    (-38.2, -21.4, -12.2, -3.6, 3.8),
)
_ULNA_WALL: Final = (1.9, 1.9, 1.7, 1.3, 1.0, 0.8, 0.7, 0.7, 0.7, 0.6)
_STYLOID: Final = ((-23.6, 3.0, -38.6), (2.1, 2.4, 4.8))
# The thumb's sesamoids, in the frame of its metacarpal: x, y, and z back from the head's end.
_SESAMOIDS: Final = {
    "radial sesamoid": ((3.6, -8.6, 4.6), (2.2, 1.7, 2.9)),
    "ulnar sesamoid": ((-4.0, -8.6, 4.2), (2.3, 1.8, 3.1)),
}


def forearm(scale: float) -> list[Solid]:
    """Return radius and ulna in the hand's frame."""
    radius = _stations(_RADIUS, scale)
    ulna = _stations(_ULNA, scale)
    center, axes = _CARPAL_HOLLOW
    hollow = ellipsoid("hollow", _times(center, scale), _times(axes, scale))
    plate = ellipsoid("inner hollow", _times(center, scale), _plus(_times(axes, scale), 0.8))
    cortex, spongiosa, marrow = _bone(radius, _RADIUS_WALL, 6, scale)
    hollowed = layered(
        Difference(type="difference", solids=(cortex, hollow)),
        Difference(type="difference", solids=(spongiosa, plate)),
        marrow,
    )
    at, size = _STYLOID
    styloid = ellipsoid("styloid", _times(at, scale), _times(size, scale), CORTEX)
    core = ellipsoid(
        "styloid spongiosa", _times(at, scale), _plus(_times(size, scale), -0.7), SPONGIOSA
    )
    cortex, spongiosa, marrow = _bone(ulna, _ULNA_WALL, 5, scale)
    return [
        named("radius", hollowed),
        named("ulna", layered(union(cortex, styloid), union(spongiosa, core), marrow)),
    ]


def sesamoids(scale: float, frame: Frame, length_mm: float) -> list[Solid]:
    """Return the two sesamoids in front of the head of the thumb's metacarpal."""
    made: list[Solid] = []
    for name, ((x, y, back), size) in _SESAMOIDS.items():
        at = (scale * x, scale * y, length_mm - scale * back)
        shell = ellipsoid("cortex", at, _times(size, scale), CORTEX)
        core = ellipsoid("spongiosa", at, _plus(_times(size, scale), -0.5), SPONGIOSA)
        made.append(frame.placed(name, layered(shell, core)))
    return made


def _stations(
    rows: Sequence[tuple[float, float, float, float, float]], scale: float
) -> list[Station]:
    made = []
    for row in rows:
        z, low, high, palm, back = (scale * value for value in row)
        x, y = (low + high) / 2, (palm + back) / 2
        made.append(Station((x, y, z), (low - x, high - x), (palm - y, back - y)))
    return made


def _bone(
    rows: Sequence[Station], walls: Sequence[float], canal: int, scale: float
) -> tuple[Solid, Solid, Solid]:
    """Return cortex, spongiosa and marrow; the first ``canal`` sections have a marrow canal."""
    straight = _upright(rows)
    inner = within(straight, [scale * wall for wall in walls], closed=(False, True))
    marrow = []
    for index, station in enumerate(inner[:canal]):
        share = (0.96, 0.93, 0.84, 0.66, 0.36, 0.04)[index + (6 - canal)] if index else 0.96
        marrow.append(
            Station(
                station.at,
                (share * station.x[0], share * station.x[1]),
                (share * station.b[0], share * station.b[1]),
            )
        )
    return (
        swept("cortex", straight, CORTEX),
        swept("spongiosa", inner, SPONGIOSA),
        swept("marrow", marrow, MARROW),
    )


def _upright(rows: Sequence[Station]) -> list[Station]:
    """Return the sections on one upright axis, so that each stays level."""
    x = float(np.mean([row.at[0] for row in rows[:4]]))
    y = float(np.mean([row.at[1] for row in rows]))
    return [
        Station(
            (x, y, row.at[2]),
            (row.at[0] + row.x[0] - x, row.at[0] + row.x[1] - x),
            (row.at[1] + row.b[0] - y, row.at[1] + row.b[1] - y),
        )
        for row in rows
    ]


def _times(values: tuple[float, float, float], by: float) -> tuple[float, float, float]:
    x, y, z = values
    return (by * x, by * y, by * z)


def _plus(values: tuple[float, float, float], more: float) -> tuple[float, float, float]:
    x, y, z = values
    return (x + more, y + more, z + more)
