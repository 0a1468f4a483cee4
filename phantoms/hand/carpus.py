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


HEAD: Final = Ball((1.1, 0.6, -17.0), (7.1, 7.0, 6.0))
"""The capitate's head, which lunate and scaphoid hold."""
_PISIFORM: Final = Ball((-19.4, -11.4, -20.6), (4.6, 4.3, 5.4))
_HOOK: Final = Ball((-15.2, -9.2, -9.0), (2.8, 5.6, 3.5))

CARPALS: Final[dict[str, tuple[Row, ...]]] = {
    "scaphoid": (
        (-31.4, 8.2, 10.0, -2.5, 2.4),
        (-30.5, 7.3, 12.0, -4.4, 4.0),
        (-28.2, 7.0, 15.2, -6.6, 5.2),
        (-25.6, 7.0, 17.0, -8.6, 4.3),
        (-23.6, 7.1, 19.8, -10.2, 3.0),
        (-21.8, 7.3, 22.0, -11.6, 1.4),
        (-20.2, 7.7, 22.6, -12.4, 0.2),
        (-18.8, 8.6, 19.8, -12.2, -1.0),
        (-17.0, 11.0, 14.8, -9.0, -3.2),
    ),
    "lunate": (
        (-32.5, -3.6, 2.2, -4.2, 2.8),
        (-31.9, -6.0, 4.2, -6.0, 4.8),
        (-29.7, -8.8, 5.6, -7.5, 7.5),
        (-26.4, -9.4, 5.7, -8.6, 8.4),
        (-22.9, -8.6, 5.6, -8.6, 8.2),
        (-20.6, -7.2, 4.0, -7.0, 6.4),
    ),
    "triquetrum": (
        (-29.6, -14.6, -12.2, -1.8, 3.8),
        (-28.3, -16.8, -11.1, -3.4, 6.0),
        (-24.8, -20.6, -10.7, -4.9, 7.8),
        (-20.8, -23.8, -11.8, -5.0, 8.0),
        (-17.4, -25.6, -15.8, -5.0, 7.6),
        (-14.4, -26.3, -20.1, -4.4, 6.6),
        (-12.8, -25.8, -22.8, -2.6, 4.8),
    ),
    "trapezium": (
        (-19.2, 23.6, 27.0, -10.0, -4.8),
        (-18.3, 20.6, 29.8, -12.4, -2.6),
        (-15.3, 17.0, 31.8, -14.3, -0.8),
        (-11.6, 16.3, 30.6, -14.4, -0.8),
        (-8.3, 17.0, 25.6, -12.8, -2.6),
        (-6.7, 18.6, 21.8, -10.6, -4.6),
    ),
    "trapezoid": (
        (-15.7, 11.4, 14.8, 0.6, 6.4),
        (-14.6, 9.4, 17.0, -1.8, 8.6),
        (-10.7, 8.0, 18.2, -3.9, 10.0),
        (-6.5, 8.8, 18.0, -3.2, 9.4),
        (-5.6, 9.8, 17.0, -1.6, 8.0),
    ),
    "capitate": (
        (-18.8, -4.6, 6.2, -6.0, 7.4),
        (-15.3, -5.6, 6.9, -7.0, 8.6),
        (-10.9, -5.9, 6.3, -8.3, 9.8),
        (-4.4, -6.9, 6.9, -8.5, 10.3),
        (-2.1, -6.8, 6.8, -7.4, 9.4),
        (-1.3, -6.0, 6.0, -5.8, 7.8),
    ),
    "hamate": (
        (-19.2, -10.6, -8.7, -1.6, 3.4),
        (-17.8, -12.6, -7.6, -3.4, 5.8),
        (-13.7, -18.7, -7.3, -6.0, 8.4),
        (-10.0, -24.0, -7.8, -6.9, 9.0),
        (-7.6, -25.1, -8.0, -6.9, 9.0),
        (-5.5, -20.8, -8.4, -5.8, 8.2),
        (-3.5, -12.0, -9.0, -3.0, 6.2),
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
