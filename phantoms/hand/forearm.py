"""The ends of radius and ulna, and the thumb's sesamoids. Shapes are estimates for mean size.

The radius slopes 23 degrees from its styloid to the ulna and 12 degrees toward the palm, in a joint
surface hollowed for scaphoid and lunate, and is notched for the ulna's head; the ulna has its
styloid on the side of the little finger. Their marrow canals taper off where the shafts widen.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from phantom.document import Cut, Difference, Point, Solid
from phantoms.hand.frames import Frame
from phantoms.hand.rows import Row, plus, times, upright
from phantoms.hand.tubular import CORTEX, MARROW, SPONGIOSA
from phantoms.parts import ellipsoid, layered, named, swept, union, within

END_Z_MM: Final = -130.0
"""Where the forearm is cut off: outside the field of the usual techniques."""

_RADIUS: Final[tuple[Row, ...]] = (
    (END_Z_MM, 4.4, 16.8, -6.0, 6.6),
    (-87.2, 3.0, 17.8, -6.4, 7.0),
    (-67.2, -0.2, 20.2, -7.2, 7.8),
    (-53.2, -4.4, 23.2, -8.6, 9.4),
    (-43.2, -8.2, 25.8, -9.8, 10.6),
    (-37.2, -9.4, 27.4, -10.3, 10.9),
    (-33.1, -8.0, 28.3, -10.0, 10.6),
    (-28.8, 0.0, 28.5, -8.6, 9.4),
    (-25.2, 10.0, 28.0, -6.2, 6.8),
    (-22.8, 18.4, 27.0, -3.4, 4.0),
    (-21.8, 22.4, 25.4, -1.4, 2.0),
)
_RADIUS_WALL: Final = (2.6, 2.4, 1.7, 0.9, 0.6, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5)
_RADIUS_CANAL: Final = ((10.4, 0.3, -95.0), (4.7, 4.2, 46.0))
_CARPAL_HOLLOW: Final = ((-1.2, -3.4, -10.4), (27.8, 20.5, 24.5))
"""What scaphoid, lunate and the discs beside them move in."""
_NOTCH: Final = ((-17.5, 0.2, -38.8), (10.2, 10.2, 10.2))
_LISTER: Final = ((9.0, 9.8, -37.3), (2.6, 1.7, 6.0))
_ULNA: Final[tuple[Row, ...]] = (
    (END_Z_MM, -24.0, -12.8, -5.7, 5.7),
    (-81.2, -24.0, -14.0, -5.1, 5.2),
    (-61.2, -24.2, -14.4, -5.0, 5.2),
    (-49.2, -25.0, -12.0, -6.2, 6.4),
    (-42.2, -25.8, -9.8, -7.5, 7.7),
    (-37.6, -25.8, -9.3, -7.8, 8.0),
    (-34.9, -24.0, -10.6, -6.2, 6.4),
    (-33.8, -21.4, -12.8, -3.8, 4.0),
)
_ULNA_WALL: Final = (2.4, 2.2, 1.8, 0.9, 0.6, 0.5, 0.5, 0.5)
_ULNA_CANAL: Final = ((-19.0, 0.1, -92.0), (2.9, 2.75, 44.0))
_STYLOID: Final = ((-23.3, 2.2, -35.6), (2.4, 2.7, 6.2))
_PLATE_MM: Final = 0.6
# The thumb's sesamoids, in the frame of its metacarpal: x, y, and z back from the head's end.
_SESAMOIDS: Final = {
    "radial sesamoid": ((3.6, -8.6, 4.6), (2.2, 1.7, 2.9)),
    "ulnar sesamoid": ((-4.0, -8.6, 4.2), (2.3, 1.8, 3.1)),
}


def forearm(scale: float) -> list[Solid]:
    """Return radius and ulna in the hand's frame."""
    cortex, spongiosa = _bone(_RADIUS, _RADIUS_WALL, scale)
    at, size = _LISTER
    lister = ellipsoid("tubercle", times(at, scale), times(size, scale), CORTEX)
    radius = layered(
        Difference(type="difference", solids=(union(cortex, lister), *_hollows(scale, 0.0))),
        Difference(type="difference", solids=(spongiosa, *_hollows(scale, _PLATE_MM))),
        _canal(_RADIUS_CANAL, scale),
    )
    cortex, spongiosa = _bone(_ULNA, _ULNA_WALL, scale)
    at, size = _STYLOID
    styloid = ellipsoid("styloid", times(at, scale), times(size, scale), CORTEX)
    core = ellipsoid(
        "styloid spongiosa", times(at, scale), plus(times(size, scale), -_PLATE_MM), SPONGIOSA
    )
    ulna = layered(union(cortex, styloid), union(spongiosa, core), _canal(_ULNA_CANAL, scale))
    return [named("radius", radius), named("ulna", ulna)]


def sesamoids(scale: float, frame: Frame, length_mm: float) -> list[Solid]:
    """Return the two sesamoids in front of the head of the thumb's metacarpal."""
    made: list[Solid] = []
    for name, ((x, y, back), size) in _SESAMOIDS.items():
        at = (scale * x, scale * y, length_mm - scale * back)
        shell = ellipsoid("cortex", at, times(size, scale), CORTEX)
        core = ellipsoid("spongiosa", at, plus(times(size, scale), -0.3), SPONGIOSA)
        made.append(frame.placed(name, layered(shell, core)))
    return made


def _hollows(scale: float, wall_mm: float) -> list[Solid]:
    """Return what is taken out of the radius, or of what is a wall's thickness inside."""
    inner = "inner " if wall_mm else ""
    return [
        ellipsoid(f"{inner}{name}", times(at, scale), plus(times(size, scale), wall_mm))
        for name, (at, size) in (("hollow", _CARPAL_HOLLOW), ("notch", _NOTCH))
    ]


def _bone(rows: Sequence[Row], walls: Sequence[float], scale: float) -> tuple[Solid, Solid]:
    """Return cortex and spongiosa."""
    outer = upright(rows, scale)
    inner = within(outer, [scale * wall for wall in walls], closed=(False, True))
    return swept("cortex", outer, CORTEX), swept("spongiosa", inner, SPONGIOSA)


def _canal(canal: tuple[Point, Point], scale: float) -> Solid:
    """Return the marrow canal, an ellipsoid that thins out where the shaft widens."""
    at, size = canal
    whole = ellipsoid("marrow", times(at, scale), times(size, scale), MARROW)
    end = Cut(point=(0.0, 0.0, scale * END_Z_MM), normal=(0.0, 0.0, -1.0))
    return whole.model_copy(update={"cuts": (end,)})
