"""The patella: a rounded triangle with a blunt apex below; two planes cut its back to facets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from phantom.document import Cut, Solid
from phantoms.knee.sizes import Sizes
from phantoms.parts import Station, ellipsoid, layered, swept, within

_WALL_MM: Final = 1.1
_FACETS_DEG: Final = (24.0, 31.0)
"""How far the lateral and the medial facet fall away from the ridge (estimates)."""
_RIDGE: Final = 0.04
"""Where the ridge is, toward the medial side, as a share of the width."""
# From apex to base: height as a share of the patella's, half-width as a share of its width, front
# and back as shares of its thickness (before the facets cut what is behind the ridge).
_ROWS: Final = (
    (-0.5, 0.08, -0.68, -0.49),
    (-0.46, 0.18, -0.79, -0.33),
    (-0.34, 0.325, -0.91, -0.07),
    (-0.14, 0.465, -0.985, 0.12),
    (0.1, 0.51, -0.995, 0.16),
    (0.32, 0.425, -0.92, 0.08),
    (0.45, 0.265, -0.78, -0.13),
    (0.5, 0.1, -0.6, -0.33),
)


def cartilage(sizes: Sizes) -> Solid:
    """Return the cartilage behind the patella's facets, and what of it the bone will replace."""
    thick = 0.62 * sizes.joint_space
    solid = ellipsoid(
        "patellar cartilage",
        (0.0, -0.42 * sizes.patella_thickness, 0.04 * sizes.patella_height),
        (
            0.49 * sizes.patella_width,
            0.55 * sizes.patella_thickness,
            0.42 * sizes.patella_height,
        ),
        "cartilage",
    )
    return solid.model_copy(update={"cuts": _facets(sizes, thick)})


def patella(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the patella, the middle of its ridge at the origin, as far as ``cuts`` keep it."""
    wide, thick, high = sizes.patella_width, sizes.patella_thickness, sizes.patella_height
    stations = [
        Station(
            (0.0, -0.5 * thick, at * high),
            (-half * wide, half * wide),
            ((front + 0.5) * thick, (back + 0.5) * thick),
        )
        for at, half, front, back in _ROWS
    ]
    inner = within(stations, _WALL_MM)
    outside, inside = (*_facets(sizes, 0.0), *cuts), (*_facets(sizes, -_WALL_MM), *cuts)
    return layered(
        swept("cortex", stations, "cortical bone", cuts=outside),
        swept("spongiosa", inner, "spongiosa", cuts=inside),
    )


def _facets(sizes: Sizes, behind_mm: float) -> tuple[Cut, ...]:
    """Return the planes of the facets, moved back by a thickness."""
    found = []
    for side, fall_deg in zip((-1.0, 1.0), _FACETS_DEG, strict=True):
        fall = math.radians(fall_deg)
        normal = (side * math.sin(fall), math.cos(fall), 0.0)
        ridge = (_RIDGE * sizes.patella_width, 0.0, 0.0)
        point = (ridge[0] + behind_mm * normal[0], behind_mm * normal[1], 0.0)
        found.append(Cut(point=point, normal=normal))
    return tuple(found)
