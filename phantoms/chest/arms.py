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
    root, facing_deg, turn_deg
        Where the spine of the scapula begins at the blade's medial border, how far from there the
        blade runs forward of sideways, and how far it is turned in its own plane, its socket up.
    acromion
        Where the root puts the end of the scapula to which the collar bone comes.
    arm
        Points of the humerus from the middle of its head to beyond where it is cut, from the
        socket on.
    shoulder
        Middle and radius of the muscle about the joint, from the socket on.
    trunk
        z, half-width, front and back of the muscles' surface from the nipples up.
    """

    clavicle: tuple[tuple[Point, float, float], ...]
    root: Point
    facing_deg: float
    turn_deg: float
    acromion: Point
    arm: tuple[Point, ...]
    shoulder: tuple[Point, float]
    trunk: Trunk


GIRDLES: Final[Mapping[Arms, Girdle]] = {
    "at_sides": Girdle(
        clavicle=(
            ((17.6, -53.2, 89.3), 10.5, 9.5),
            ((27.0, -54.5, 89.5), 9.0, 8.5),
            ((45.0, -57.0, 92.0), 6.6, 6.4),
            ((70.0, -53.0, 94.0), 5.8, 6.0),
            ((95.0, -39.0, 96.5), 5.6, 6.2),
            ((120.0, -23.0, 98.5), 5.4, 7.5),
            ((141.0, -12.0, 99.5), 5.2, 9.0),
            ((153.0, -7.0, 99.5), 4.6, 8.5),
        ),
        root=(121.5, 78.5, 42.0),
        facing_deg=51.0,
        turn_deg=0.0,
        acromion=(177.7, 9.8, 98.0),
        arm=(
            (17.5, -15.7, 8.0),
            (28.5, -16.2, -9.0),
            (42.5, -19.2, -32.0),
            (58.5, -23.2, -60.0),
            (76.5, -27.2, -92.0),
            (128.5, -37.2, -182.0),
        ),
        shoulder=((17.5, -12.0, 8.0), 43.0),
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
            ((17.6, -53.2, 89.3), 10.5, 9.5),
            ((27.0, -53.5, 90.5), 9.0, 8.5),
            ((45.0, -52.0, 96.0), 6.6, 6.4),
            ((67.0, -42.0, 104.0), 5.8, 6.0),
            ((89.0, -23.0, 113.0), 5.6, 6.2),
            ((107.0, -4.0, 122.0), 5.4, 7.5),
            ((120.0, 11.0, 129.0), 5.2, 9.0),
            ((128.0, 21.0, 133.0), 4.6, 8.5),
        ),
        root=(123.0, 72.0, 36.0),
        facing_deg=63.0,
        turn_deg=38.0,
        acromion=(141.3, 40.4, 135.5),
        arm=(
            (9.6, -16.0, 15.3),
            (13.6, -36.0, 33.3),
            (17.6, -61.0, 54.3),
            (20.6, -87.0, 75.3),
            (23.6, -119.0, 101.3),
            (30.0, -300.0, 240.0),
        ),
        shoulder=((4.6, -3.0, 10.3), 45.0),
        trunk=(
            (0.0, 164.0, -106.0, 115.0),
            (35.0, 166.0, -97.0, 114.0),
            (62.0, 165.0, -87.0, 111.0),
            (84.0, 162.0, -77.0, 106.0),
            (98.0, 153.0, -71.0, 101.0),
            (110.0, 138.0, -65.0, 96.0),
            (122.0, 115.0, -57.0, 90.0),
            (136.0, 92.0, -51.0, 82.0),
            (152.0, 71.0, -47.0, 71.0),
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
