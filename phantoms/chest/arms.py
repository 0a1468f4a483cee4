"""Where the shoulder girdle is when the arms hang and when they are raised.

Hanging, for a PA view: shoulders rolled forward, so that the scapulae clear the lungs, and the arms
away from the sides. Raised, for a lateral: the arms go up beside the head, the blades turn outward
and up with them and the collar bones rise, so that no arm lies over the lungs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal, NamedTuple

from phantom.document import Point

Arms = Literal["at_sides", "raised"]
Trunk = tuple[tuple[float, float, float, float], ...]


class Girdle(NamedTuple):
    """One pose of the left shoulder, drawn.

    Attributes
    ----------
    clavicle
        Points of its axis, and half its height and depth there.
    root, turn_deg
        Where the spine of the scapula begins at the blade's medial border, and how far the blade is
        turned in its own plane, its socket up.
    arm
        Points of the humerus, from its head to beyond where it is cut.
    trunk
        z, half-width, front and back of the muscles' surface from the nipples up.
    """

    clavicle: tuple[tuple[Point, float, float], ...]
    root: Point
    turn_deg: float
    arm: tuple[Point, ...]
    trunk: Trunk


GIRDLES: Final[Mapping[Arms, Girdle]] = {
    "at_sides": Girdle(
        clavicle=(
            ((17.0, -52.0, 88.0), 10.5, 9.5),
            ((27.0, -54.5, 89.5), 9.0, 8.5),
            ((45.0, -57.0, 92.0), 6.6, 6.4),
            ((70.0, -53.0, 94.0), 5.8, 6.0),
            ((95.0, -39.0, 96.5), 5.6, 6.2),
            ((120.0, -23.0, 98.5), 5.4, 7.5),
            ((141.0, -12.0, 99.5), 5.2, 9.0),
            ((153.0, -7.0, 99.5), 4.6, 8.5),
        ),
        root=(119.0, 78.0, 42.0),
        turn_deg=0.0,
        arm=(
            (185.0, 2.5, 72.0),
            (196.0, 2.0, 55.0),
            (210.0, -1.0, 32.0),
            (226.0, -5.0, 4.0),
            (244.0, -9.0, -28.0),
            (296.0, -19.0, -118.0),
        ),
        trunk=(
            (0.0, 161.0, -106.0, 115.0),
            (28.0, 167.0, -98.0, 115.0),
            (53.0, 173.0, -89.0, 112.0),
            (75.0, 177.0, -79.0, 106.0),
            (90.0, 174.0, -73.0, 101.0),
            (103.0, 162.0, -67.0, 95.0),
            (116.0, 133.0, -59.0, 89.0),
            (131.0, 95.0, -51.0, 80.0),
            (150.0, 67.0, -46.0, 69.0),
            (170.0, 58.0, -46.0, 60.0),
            (188.0, 56.0, -48.0, 56.0),
            (235.0, 57.0, -52.0, 54.0),
        ),
    ),
    "raised": Girdle(
        clavicle=(
            ((17.0, -52.0, 88.0), 10.5, 9.5),
            ((27.0, -53.5, 90.5), 9.0, 8.5),
            ((45.0, -52.0, 96.0), 6.6, 6.4),
            ((67.0, -42.0, 104.0), 5.8, 6.0),
            ((90.0, -26.0, 113.0), 5.6, 6.2),
            ((110.0, -6.0, 122.0), 5.4, 7.5),
            ((124.0, 13.0, 129.0), 5.2, 9.0),
            ((132.0, 25.0, 133.0), 4.6, 8.5),
        ),
        root=(121.0, 72.0, 36.0),
        turn_deg=38.0,
        arm=(
            (162.0, 21.0, 116.0),
            (167.0, 11.0, 135.0),
            (170.0, -6.0, 159.0),
            (172.0, -26.0, 186.0),
            (174.0, -50.0, 218.0),
            (178.0, -104.0, 290.0),
        ),
        trunk=(
            (0.0, 159.0, -106.0, 115.0),
            (35.0, 161.0, -97.0, 114.0),
            (62.0, 162.0, -87.0, 110.0),
            (84.0, 160.0, -77.0, 104.0),
            (98.0, 157.0, -71.0, 99.0),
            (110.0, 151.0, -65.0, 95.0),
            (122.0, 141.0, -57.0, 90.0),
            (136.0, 121.0, -51.0, 82.0),
            (152.0, 86.0, -47.0, 71.0),
            (170.0, 62.0, -46.0, 61.0),
            (188.0, 56.0, -48.0, 56.0),
            (235.0, 57.0, -52.0, 54.0),
        ),
    ),
}
CUT_X_MM: Final = 214.0
"""Arms that hang are drawn to here."""
TOP_Z_MM: Final = 235.0
"""The neck, and arms that are raised, are drawn to here."""
