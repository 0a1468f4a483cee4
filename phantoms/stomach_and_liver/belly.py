"""What else a belly shows: kidneys, spleen, gas in the bowel, the wings of the hips and the sacrum.

Shapes and places are estimates, for the mean adult; they grow with stature.
"""

from __future__ import annotations

from typing import Final

from phantom.document import Ellipsoid, Point, Rotation, Solid, Transformed
from phantoms.parts import Station, ellipsoid, layered, named, swept, union, within
from phantoms.stomach_and_liver.organs import AIR
from phantoms.stomach_and_liver.spine import CORTEX, SPONGIOSA
from phantoms.stomach_and_liver.trunk import MUSCLE, Trunk

# Middle of a bubble, as shares of the cavity's half-width and half-depth, and its height; its size.
_GAS: Final = (
    ((-0.70, -0.32, -46.0), (14.0, 11.0, 11.0)),
    ((-0.66, -0.28, -58.0), (17.0, 14.0, 13.0)),
    ((-0.71, -0.26, -75.0), (18.0, 12.0, 15.0)),
    ((-0.63, -0.24, -88.0), (19.0, 15.0, 15.0)),
    ((-0.68, -0.22, -106.0), (20.0, 14.0, 16.0)),
    ((-0.60, -0.20, -122.0), (19.0, 15.0, 15.0)),
    ((0.72, 0.10, -31.0), (7.0, 8.0, 11.0)),
    ((0.75, 0.10, -46.0), (10.0, 9.0, 12.0)),
    ((0.71, 0.08, -64.0), (9.0, 9.0, 12.0)),
    ((0.36, -0.45, -90.0), (13.0, 9.0, 8.0)),
    ((0.22, -0.42, -99.0), (15.0, 8.0, 9.0)),
    ((-0.16, -0.50, -86.0), (9.0, 7.0, 7.0)),
)


def viscera(trunk: Trunk, scale: float) -> list[Solid]:
    """Return kidneys, spleen and bowel gas, for other organs to replace."""
    organs: list[Solid] = []
    for side, sign, height in (("right", -1.0, 56.0), ("left", 1.0, 70.0)):
        middle = (sign * 60.0 * scale, 50.0 * scale, height * scale)
        kidney = ellipsoid(
            f"{side} kidney", middle, (25.0 * scale, 21.0 * scale, 52.0 * scale), MUSCLE
        )
        turn = Rotation(axis=(0.0, 1.0, 0.0), angle_deg=sign * 14.0, about=middle)
        organs.append(Transformed(type="transformed", solid=kidney, rotate=turn))
    place = (0.66 * trunk.half_width, 0.36 * trunk.half_depth, 108.0 * scale)
    organs.append(ellipsoid("spleen", place, (27.0 * scale, 36.0 * scale, 46.0 * scale), MUSCLE))
    bubbles = [
        ellipsoid(
            f"gas {index + 1}",
            (x * trunk.half_width, y * trunk.half_depth, z * scale),
            (a * scale, b * scale, c * scale),
            AIR,
        )
        for index, ((x, y, z), (a, b, c)) in enumerate(_GAS)
    ]
    return [union(*organs), named("bowel", union(*bubbles))]


# Height under the origin, how far back, half-width and half-depth of the sacrum there.
_SACRUM: Final = (
    (-96.0, 44.0, 27.0, 14.0),
    (-102.0, 47.0, 44.0, 17.0),
    (-112.0, 52.0, 53.0, 18.0),
    (-126.0, 60.0, 52.0, 17.0),
    (-142.0, 68.0, 46.0, 15.0),
    (-160.0, 75.0, 38.0, 12.0),
)


def pelvis(trunk: Trunk, scale: float) -> list[Solid]:
    """Return the wings of the hips, their crests and the sacrum, as far as they are seen."""
    cuts = trunk.ends[1:]
    made: list[Solid] = []
    for side, sign in (("right", -1.0), ("left", 1.0)):
        middle = (sign * 82.0 * scale, 22.0 * scale, -112.0 * scale)
        layers = []
        for part, material, less in (("cortex", CORTEX, 0.0), ("spongiosa", SPONGIOSA, 1.2)):
            wing = Ellipsoid(
                type="ellipsoid",
                name=part,
                material=material,
                center=middle,
                semi_axes=(7.0 * scale - less, 70.0 * scale - less, 66.0 * scale - less),
            )
            layers.append(_turned(wing, middle, sign))
        made.append(named(f"{side} wing", layered(*layers)))
    rows = [
        Station(
            (0.0, y * scale, z * scale),
            (-wide * scale, wide * scale),
            (-deep * scale, deep * scale),
        )
        for z, y, wide, deep in _SACRUM
    ]
    shell = swept("cortex", rows, CORTEX, cuts=cuts)
    core = swept("spongiosa", within(rows, 0.9, closed=(True, False)), SPONGIOSA, cuts=cuts)
    made.append(named("sacrum", layered(shell, core)))
    return made


def _turned(wing: Solid, middle: Point, sign: float) -> Solid:
    """Return a wing whose front and top lean outward."""
    outward = Rotation(axis=(0.0, 0.0, 1.0), angle_deg=sign * 32.0, about=middle)
    flared = Rotation(axis=(0.0, 1.0, 0.0), angle_deg=sign * 24.0, about=middle)
    inner = Transformed(type="transformed", solid=wing, rotate=outward)
    return Transformed(type="transformed", solid=inner, rotate=flared)
