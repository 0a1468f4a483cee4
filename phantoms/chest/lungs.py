"""Lungs and what bounds them below: the domes of the diaphragm on liver, stomach and spleen.

A lung fills its half of the cage to within the thickness of the wall, down to below the sharp angle
where the diaphragm meets the wall; heart, vessels, spine and diaphragm then take their place in it.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from phantom.document import Cut, Ellipsoid, Instance, Intersection, Solid, SplineContour
from phantoms.chest.cage import OUTLINE, Cage
from phantoms.chest.shapes import Row, column, fitted, rounded
from phantoms.parts import ellipsoid

MEDIAL: Final = 0.05
"""Where a lung begins, as a share of the chest's half-width."""
PLEURA_MM: Final = 2.0
"""From the inner side of the ribs to the lung."""
TOP_Z: Final = 121.0
FLOOR_Z: Final = -196.0
# Each dome: drawn x, y and z of its top, and its half-axes across, along y and down.
_DOMES: Final = {
    "right": ((-68.0, -24.0, -92.0), (83.0, 104.0, 102.0)),
    "left": ((66.0, -22.0, -106.0), (86.0, 104.0, 96.0)),
}
_DOME_SHAPE: Final = rounded(2.4)


def wall_mm(cage: Cage) -> float:
    """Return the distance from the middle of the ribs to the lung."""
    return 0.5 * cage.frame.sizes.rib_thickness_mm * 1.05 + PLEURA_MM


def lung_outline(side: str) -> SplineContour:
    """Return the section of a lung, in the square [-1, 1]²."""
    back, front = OUTLINE[1:], ()
    inner = [(x, y) for x, y in back if x >= 0.2]
    # The medial side is straight from front to back, its corners rounded.
    ends = [(0.10, -0.975), (MEDIAL, -0.86), (MEDIAL + 0.004, -0.4), (MEDIAL + 0.004, 0.0),
            (MEDIAL, 0.36), (0.10, 0.53)]  # fmt: skip
    sign = 1.0 if side == "left" else -1.0
    points = [*inner[:], *ends, *front]
    middle, half = (1.0 + MEDIAL) / 2, (1.0 - MEDIAL) / 2
    return SplineContour(
        type="spline", points=tuple((sign * (x - middle) / half, y) for x, y in points)
    )


def lung_rows(cage: Cage, side: str) -> list[Row]:
    """Return the sections of a lung from its floor to its apex."""
    f = cage.frame
    wall = wall_mm(cage)
    floor, top = (FLOOR_Z - max(f.deeper_mm, 0.0)) * f.z, TOP_Z * f.z
    # Close together toward the round apex.
    share = np.sin(np.linspace(0.0, np.pi / 2, 13))
    rows: list[Row] = []
    for z in floor + (top - floor) * share:
        half, front, back = cage.section(z)
        step = 1.0
        slope = (cage.section(z + step)[0] - half) / step
        inward = wall * min(float(np.hypot(1.0, slope)), 2.6)
        half = max(half - inward, 3.0)
        depth, middle = (back - front) / 2, (back + front) / 2
        depth = max(depth - inward, 3.0)
        reach = (MEDIAL * half, half) if side == "left" else (-half, -MEDIAL * half)
        rows.append((float(z), *reach, middle - depth, middle + depth))
    # The last sections close over the apex.
    return rows


def lung(cage: Cage, side: str, name: str | None = None) -> Solid:
    """Return a lung, uncut by heart and diaphragm."""
    return column(name or f"{side} lung", lung_rows(cage, side), "lung", lung_outline(side))


def dome_rows(cage: Cage, side: str) -> list[Row]:
    """Return the sections of what lies under one half of the diaphragm."""
    f = cage.frame
    (x, y, z), (across, along, down) = _DOMES[side]
    top = z - f.deeper_mm
    centre = top - down
    rows: list[Row] = []
    floor = (FLOOR_Z - max(f.deeper_mm, 0.0)) - 10.0
    for angle in np.linspace(0.02, 0.5 * np.pi, 9):
        h = centre + down * np.cos(angle)
        s = float(np.sin(angle))
        rows.append((h, x - across * s, x + across * s, y - along * s, y + along * s))
    if rows[-1][0] > floor:
        _, *rest = rows[-1]
        rows.append((floor, *rest))  # type: ignore[arg-type]
    return fitted(f, rows)


def angle_z(cage: Cage, side: str) -> float:
    """Return the height of the costophrenic angle: where dome and lung reach out alike."""
    lung, under = np.array(sorted(lung_rows(cage, side))), np.array(sorted(dome_rows(cage, side)))
    z = np.linspace(under[0, 0], under[-1, 0], 400)
    column = 2 if side == "left" else 1
    apart = np.abs(np.interp(z, under[:, 0], under[:, column])) - np.abs(
        np.interp(z, lung[:, 0], lung[:, column])
    )
    return float(z[apart > 0].max(initial=z[0]))


def dome(cage: Cage, side: str) -> Solid:
    """Return what lies under one half of the diaphragm: liver; stomach and spleen.

    It is kept within the chest's wall, which the drawn lung fills.
    """
    name = "liver" if side == "right" else "stomach and spleen"
    whole = column(name, dome_rows(cage, side), "soft_tissue", _DOME_SHAPE)
    room = Instance(type="instance", of=f"{side} lung", name=f"bounds of the {name}")
    return Intersection(type="intersection", solids=(whole, room))


def tendon(cage: Cage) -> Solid:
    """Return the middle of the diaphragm, on which the heart rests."""
    f = cage.frame
    half = (80.0 * f.x, 66.0 * f.y, 62.0 * f.z)
    x, y, z = f.at(8.0, -28.0, -104.0 - f.deeper_mm)
    return ellipsoid("middle of the diaphragm", (x, y, z - half[2]), half, "soft_tissue")


def stomach_bubble(cage: Cage) -> Solid:
    """Return the air in the stomach over its fluid level, under the left dome."""
    f = cage.frame
    (x, y, z), _ = _DOMES["left"]
    top = f.at(x - 6.0, y - 4.0, z - f.deeper_mm - 8.0)
    half = (27.0 * f.x, 30.0 * f.y, 20.0 * f.z)
    level = (top[0], top[1], top[2] - 0.9 * half[2])
    return Ellipsoid(
        type="ellipsoid",
        name="air in the stomach",
        material="air",
        center=(top[0], top[1], top[2] - half[2]),
        semi_axes=half,
        cuts=(Cut(point=level, normal=(0.0, 0.0, -1.0)),),
    )
