"""The eight carpal bones, each by level sections from its proximal to its distal end.

The sections are estimates for a person of mean size, drawn to what radiographs show: from the front
three smooth arcs (Gilula) along both sides of the proximal row and along capitate and hamate, with
joints of 1 to 2 mm between bones; from the side the lunate's crescent on the radius, the
capitate's head in its cup, the scaphoid slanting toward the palm, trapezium and pisiform before
the others.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from phantom.document import Difference, Point, Solid
from phantoms.hand.rows import Row, plus, times, upright
from phantoms.hand.tubular import CORTEX, SPONGIOSA
from phantoms.parts import ellipsoid, layered, named, swept, union, within

SHELL_MM: Final = 0.4
"""Thickness of the carpal bones' cortex; an estimate."""
_THIN_MM: Final = 0.25
"""That of the pisiform and of the hamate's hook; an estimate."""
GAP_MM: Final = 1.5
"""Between the capitate's head and what holds it."""


class Ball(NamedTuple):
    """An ellipsoid along the hand's axes."""

    center: Point
    semi_axes: Point


HEAD: Final = Ball((0.9, 0.6, -19.3), (6.7, 7.0, 6.7))
"""The capitate's head, which lunate and scaphoid hold."""
_PISIFORM: Final = Ball((-19.4, -11.4, -23.4), (4.7, 4.3, 5.6))
_HOOK: Final = Ball((-15.2, -9.2, -10.2), (2.8, 5.6, 3.7))

CARPALS: Final[dict[str, tuple[Row, ...]]] = {
    "scaphoid": (
        (-35.8, 8.4, 10.4, -2.5, 3.5),
        (-35.1, 7.6, 12.4, -4.2, 5.2),
        (-33.2, 7.1, 15.2, -5.8, 6.2),
        (-30.6, 7.0, 17.0, -7.2, 5.6),
        (-28.2, 7.0, 18.6, -9.0, 4.2),
        (-26.0, 7.1, 22.0, -11.2, 2.0),
        (-24.2, 7.4, 24.8, -12.4, 0.4),
        (-22.7, 7.9, 24.0, -12.4, -0.6),
        (-21.0, 9.0, 19.4, -11.4, -1.6),
        (-19.4, 11.0, 14.8, -9.0, -3.2),
    ),
    "lunate": (
        (-36.9, -3.4, 2.0, -3.4, 3.4),
        (-36.5, -5.2, 3.6, -4.8, 4.8),
        (-35.2, -7.8, 5.2, -6.6, 6.6),
        (-32.6, -9.2, 5.7, -8.0, 8.0),
        (-29.4, -9.4, 5.7, -8.6, 8.4),
        (-26.4, -8.7, 5.6, -8.6, 8.2),
        (-24.2, -7.9, 4.8, -8.0, 7.4),
        (-23.4, -7.2, 4.0, -7.0, 6.4),
    ),
    "triquetrum": (
        (-33.6, -14.6, -12.2, -1.8, 3.8),
        (-32.6, -16.4, -11.2, -3.2, 5.6),
        (-29.8, -19.4, -10.8, -4.6, 7.4),
        (-26.4, -22.0, -10.8, -5.0, 8.0),
        (-23.2, -24.0, -12.0, -5.0, 8.0),
        (-19.8, -25.6, -15.8, -5.0, 7.6),
        (-16.6, -26.4, -19.8, -4.4, 6.6),
        (-14.6, -26.0, -22.6, -2.6, 4.8),
    ),
    "trapezium": (
        (-21.8, 23.6, 27.0, -10.0, -4.8),
        (-21.0, 21.0, 29.4, -12.2, -2.8),
        (-18.4, 17.6, 31.6, -14.2, -1.0),
        (-14.8, 16.4, 31.6, -14.4, -0.6),
        (-11.6, 16.4, 28.8, -14.2, -1.0),
        (-9.0, 17.0, 25.0, -12.8, -2.6),
        (-7.6, 18.2, 22.2, -10.6, -4.6),
    ),
    "trapezoid": (
        (-17.8, 10.6, 14.4, 0.6, 6.4),
        (-17.0, 9.2, 16.2, -1.4, 8.4),
        (-14.0, 8.1, 17.8, -3.4, 9.8),
        (-10.4, 8.2, 18.4, -4.0, 10.0),
        (-7.4, 8.8, 18.0, -3.2, 9.4),
        (-6.4, 9.8, 17.0, -1.6, 8.0),
    ),
    "capitate": (
        (-21.4, -4.6, 6.2, -6.0, 7.4),
        (-18.0, -5.6, 6.9, -7.0, 8.6),
        (-13.8, -5.8, 6.5, -8.0, 9.6),
        (-9.0, -6.4, 6.5, -8.6, 10.2),
        (-4.6, -6.9, 6.9, -8.4, 10.2),
        (-2.2, -6.7, 6.7, -7.2, 9.2),
        (-1.5, -6.0, 6.0, -5.8, 7.8),
    ),
    "hamate": (
        (-21.8, -10.4, -8.6, -1.6, 3.4),
        (-20.8, -11.8, -7.8, -3.0, 5.2),
        (-18.2, -15.2, -7.4, -4.8, 7.2),
        (-14.8, -19.8, -7.4, -6.2, 8.6),
        (-11.8, -23.6, -7.8, -6.8, 9.0),
        (-9.0, -25.2, -8.0, -7.0, 9.0),
        (-7.0, -23.4, -8.3, -6.4, 8.6),
        (-5.4, -18.6, -8.5, -5.2, 7.8),
        (-4.0, -12.0, -9.0, -3.0, 6.2),
    ),
}


def carpus(scale: float, *saddle: Solid) -> list[Solid]:
    """Return the carpal bones in the hand's frame, each named.

    ``saddle`` is cortex and spongiosa of the trapezium's joint surface for the thumb.
    """
    return [
        *(named(name, _carpal(name, scale, *saddle)) for name in CARPALS),
        named("pisiform", layered(*_ball(_PISIFORM, scale, ""))),
    ]


def _carpal(name: str, scale: float, *saddle: Solid) -> Solid:
    rows = upright(CARPALS[name], scale)
    cortex: Solid = swept("cortex", rows, CORTEX)
    spongiosa: Solid = swept("spongiosa", within(rows, SHELL_MM), SPONGIOSA)
    if name == "capitate":
        shell, core = _ball(HEAD, scale, "head ", SHELL_MM)
        return layered(union(cortex, shell), union(spongiosa, core))
    if name == "hamate":
        shell, core = _ball(_HOOK, scale, "hook ")
        return layered(union(cortex, shell), union(spongiosa, core))
    if name == "trapezium":
        shell, core = saddle
        return layered(union(cortex, shell), union(spongiosa, core))
    if name in ("lunate", "scaphoid"):
        center, semi_axes = times(HEAD.center, scale), times(HEAD.semi_axes, scale)
        hollow = ellipsoid("hollow", center, plus(semi_axes, GAP_MM * scale))
        plate = ellipsoid("inner hollow", center, plus(semi_axes, GAP_MM * scale + SHELL_MM))
        return layered(
            Difference(type="difference", solids=(cortex, hollow)),
            Difference(type="difference", solids=(spongiosa, plate)),
        )
    return layered(cortex, spongiosa)


def _ball(ball: Ball, scale: float, name: str, shell_mm: float = _THIN_MM) -> tuple[Solid, Solid]:
    """Return cortex and spongiosa of an ellipsoid of bone."""
    center, semi_axes = times(ball.center, scale), times(ball.semi_axes, scale)
    return (
        ellipsoid(f"{name}cortex", center, semi_axes, CORTEX),
        ellipsoid(f"{name}spongiosa", center, plus(semi_axes, -shell_mm), SPONGIOSA),
    )
