"""The plateau of the tibia: hollow facets, and the eminence with its two spines between them.

Everything is drawn in the plateau's own frame, whose z is square to it and whose origin is its
middle; :func:`laid` puts it there. Heights and hollows are estimates.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Literal

from phantom.document import (
    Cut,
    Difference,
    Ellipsoid,
    Point,
    Quadric,
    Rotation,
    Solid,
    Transformed,
)
from phantoms.knee.poses import ORIGIN
from phantoms.knee.sizes import Sizes
from phantoms.parts import ellipsoid, is_left

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

WIDTH: Final = 76.3
DEPTH: Final = 49.2
"""Of the table's plateau, as traced."""
NOTCH: Final = 22.0
MIDDLE_Y: Final = 12.0
PLATEAU_WALL_MM: Final = 1.2

Facet = Literal["medial facet", "lateral facet"]

# Facets: x and y of the middle, half-lengths of the hollow at the plateau's level, its depth.
_FACETS: Final[dict[Facet, tuple[tuple[float, float], tuple[float, float], float]]] = {
    "medial facet": ((24.0, 1.5), (14.0, 20.0), 1.8),
    "lateral facet": ((-23.8, 1.0), (13.5, 19.0), 1.1),
}
_HOLLOW_Z: Final = 14.0
"""Height of the middle of the ellipsoid that is taken away, over the bottom of the hollow."""

# Spines: x and y on the plateau, height, and half-widths there, across and along.
_SPINES: Final = {
    "medial spine": ((5.0, 1.5), 8.8, (7.6, 14.0)),
    "lateral spine": ((-5.4, 3.5), 7.4, (7.2, 13.0)),
}
_BLUNT_MM: Final = 2.2
"""How far a spine's tip is below that of the cone that its flanks are of."""
_EMINENCE: Final = ((0.0, 2.5, -1.6), (13.0, 15.0, 4.4))
"""Middle and semi-axes of the rise around them."""
_ROOT_MM: Final = 3.0


def scales(sizes: Sizes) -> tuple[float, float]:
    """Return the factors of the plateau across and from front to back."""
    return sizes.plateau_width / WIDTH, sizes.plateau_depth / DEPTH


def plane(sizes: Sizes, down_mm: float = 0.0) -> Cut:
    """Return the plane of the plateau, or one below it."""
    slope = math.radians(sizes.slope_deg)
    normal = (0.0, math.sin(slope), math.cos(slope))
    _, along = scales(sizes)
    point = (0.0, MIDDLE_Y * along - down_mm * normal[1], -down_mm * normal[2])
    return Cut(point=point, normal=normal)


def _from_plateau(sizes: Sizes, at: Point) -> Point:
    """Return a point of the plateau's frame in the tibia's."""
    slope = math.radians(sizes.slope_deg)
    cos, sin = math.cos(slope), math.sin(slope)
    x, y, z = at
    return (x, MIDDLE_Y * scales(sizes)[1] + cos * y + sin * z, -sin * y + cos * z)


def _hollow(sizes: Sizes, name: Facet) -> tuple[Point, Point]:
    """Return center, in the plateau's frame, and semi-axes of what is taken from a facet."""
    across, along = scales(sizes)
    (x, y), (a, b), depth = _FACETS[name]
    wider = 1.0 / math.sqrt(1.0 - (1.0 - depth / _HOLLOW_Z) ** 2)
    center = (x * across, y * along, _HOLLOW_Z - depth)
    return center, (a * across * wider, b * along * wider, _HOLLOW_Z)


def facets(sizes: Sizes, wall_mm: float) -> list[Solid]:
    """Return what is taken from the plateau, or from what is a wall's thickness under it."""
    return [facet(sizes, name, wall_mm) for name in _FACETS]


def facet(sizes: Sizes, name: Facet, wall_mm: float) -> Transformed:
    """Return what is taken from one facet, or a wall's thickness around it."""
    center, (a, b, c) = _hollow(sizes, name)
    label = name if wall_mm == 0.0 else f"wall of the {name}"
    axes = (a + wall_mm, b + wall_mm, c + wall_mm)
    return _laid(sizes, ellipsoid(label, center, axes))


def under_facet(sizes: Sizes, name: Facet, thick_mm: float, material: str) -> Difference:
    """Return a lens, so thick in its middle, under the wall of a facet; its leaf has no name."""
    across, along = scales(sizes)
    (x, y), (a, b), depth = _FACETS[name]
    lens = Ellipsoid(
        type="ellipsoid",
        material=material,
        center=(x * across, y * along, 0.0),
        semi_axes=(a * across, b * along, depth + PLATEAU_WALL_MM + thick_mm),
        cuts=(Cut(point=ORIGIN, normal=(0.0, 0.0, 1.0)),),
    )
    return Difference(
        type="difference", solids=(_laid(sizes, lens), facet(sizes, name, PLATEAU_WALL_MM))
    )


def _laid(sizes: Sizes, solid: Solid) -> Transformed:
    """Bring what is drawn in the plateau's frame to the tibia's."""
    turn = Rotation(axis=(1.0, 0.0, 0.0), angle_deg=-sizes.slope_deg, about=ORIGIN)
    middle = (0.0, MIDDLE_Y * scales(sizes)[1], 0.0)
    return Transformed(type="transformed", solid=solid, rotate=turn, translate=middle)


def surface_z(sizes: Sizes, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return z of the plateau with its medial facet, in mm; without rim or eminence."""
    import numpy as np

    (x0, y0, z0), (a, b, c) = _hollow(sizes, "medial facet")
    slope = math.radians(sizes.slope_deg)
    cos, sin = math.cos(slope), math.sin(slope)
    from_middle = y - MIDDLE_Y * scales(sizes)[1]
    # Along the vertical through (x, y): p + t d in the plateau's frame, z = t, with d = (sin, cos).
    u, v = (x - x0) / a, (cos * from_middle - y0) / b
    w = (sin * from_middle - z0) / c
    d_v, d_w = -sin / b, cos / c
    square, half = d_v**2 + d_w**2, v * d_v + w * d_w
    rest = half**2 - square * (u**2 + v**2 + w**2 - 1.0)
    bottom = (-half - np.sqrt(np.maximum(rest, 0.0))) / square
    plane = -from_middle * sin / cos
    return np.where(rest > 0.0, np.minimum(bottom, plane), plane)


def eminence(sizes: Sizes, wall_mm: float, cuts: Sequence[Cut]) -> list[Solid]:
    """Return what rises between the facets, or what is a wall's thickness inside it."""
    _, along = scales(sizes)
    # The spines stand in the notch.
    across = min(scales(sizes)[0], sizes.notch_width / NOTCH)
    layer, material = ("cortex", "cortical bone") if wall_mm == 0.0 else ("spongiosa", "spongiosa")
    (x, y, z), (a, b, c) = _EMINENCE
    middle = _from_plateau(sizes, (x * across, y * along, z))
    axes = (a * across - wall_mm, b * along - wall_mm, c * along - wall_mm)
    rise = ellipsoid(f"{layer} of the eminence", middle, axes, material)
    rise = rise.model_copy(update={"cuts": tuple(cuts)})
    found: list[Solid] = [rise] if is_left(rise) else []
    for name, ((x, y), high, (a, b)) in _SPINES.items():
        # On a steep flank, a wall square to it is higher than it is thick.
        lower = wall_mm * math.hypot(a * across, high * along) / (a * across)
        tip = _from_plateau(sizes, (x * across, y * along, high * along - lower))
        root = high * along + _ROOT_MM - lower
        within = ellipsoid("inside", (tip[0], tip[1], tip[2] - root / 2.0), (1.5, 1.5, root / 4.0))
        if is_left(within.model_copy(update={"cuts": tuple(cuts)})):
            slope = math.sqrt(high**2 + 2.0 * high * _BLUNT_MM)
            widths = (a * across / (slope * along), b / slope)
            found.append(_peak(f"{layer} of the {name}", tip, widths, root, material, cuts))
    return found


def _peak(
    name: str,
    tip: Point,
    widths: tuple[float, float],
    root_mm: float,
    material: str,
    cuts: Sequence[Cut],
) -> Quadric:
    """Return the lower sheet of a hyperboloid: a cone with a round tip.

    ``widths`` are those of its flanks for each mm down, far from the tip.
    """
    x, y, z = tip[0], tip[1], tip[2] + _BLUNT_MM
    a, b = (1.0 / width**2 for width in widths)
    constant = a * x * x + b * y * y - z * z + _BLUNT_MM**2
    low, high = tip[2] - root_mm, z
    return Quadric(
        type="quadric",
        name=name,
        material=material,
        coefficients=(a, b, -1.0, 0.0, 0.0, 0.0, -2 * a * x, -2 * b * y, 2 * z, constant),
        cuts=(
            Cut(point=(x, y, low), normal=(0.0, 0.0, -1.0)),
            Cut(point=(x, y, high), normal=(0.0, 0.0, 1.0)),
            *cuts,
        ),
    )
