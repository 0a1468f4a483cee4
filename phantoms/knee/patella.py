"""The patella: an ellipsoid whose back two planes cut to facets, with a ridge between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from phantom.document import Cut, Solid
from phantoms.knee.sizes import Sizes
from phantoms.parts import ellipsoid, layered

_WALL_MM: Final = 1.5
_WIDER: Final = 1.011
"""The facets cut into the ellipsoid's width."""
_FACETS_DEG: Final = (24.0, 31.0)
"""How far the lateral and the medial facet fall away from the ridge (estimates)."""
_RIDGE: Final = 0.04
"""Where the ridge is, toward the medial side, as a share of the width."""
_BLUNT: Final = 0.86
"""Share of the ellipsoid's half-depth behind at which the ridge is."""


def cartilage(sizes: Sizes) -> Solid:
    """Return the cartilage behind the patella's facets, and what of it the bone will replace."""
    thick = 0.62 * sizes.joint_space
    return _shape("patellar cartilage", sizes, "cartilage", 0.0, (), behind_mm=thick)


def patella(sizes: Sizes, cuts: Sequence[Cut]) -> Solid:
    """Return the patella, the middle of its ridge at the origin, as far as ``cuts`` keep it."""
    return layered(
        _shape("cortex", sizes, "cortical bone", 0.0, cuts),
        _shape("spongiosa", sizes, "spongiosa", _WALL_MM, cuts),
    )


def _shape(
    name: str,
    sizes: Sizes,
    material: str,
    wall_mm: float,
    cuts: Sequence[Cut],
    behind_mm: float = 0.0,
) -> Solid:
    """Return the patella, a wall's thickness inside, its facets moved back by a cartilage's."""
    half = sizes.patella_thickness / (1.0 + _BLUNT)
    facets = []
    for side, fall_deg in zip((-1.0, 1.0), _FACETS_DEG, strict=True):
        fall = math.radians(fall_deg)
        normal = (side * math.sin(fall), math.cos(fall), 0.0)
        ridge = (_RIDGE * sizes.patella_width, 0.0, 0.0)
        point = tuple(r + (behind_mm - wall_mm) * n for r, n in zip(ridge, normal, strict=True))
        facets.append(Cut(point=point, normal=normal))
    solid = ellipsoid(
        name,
        (0.0, -_BLUNT * half, 0.0),
        (
            _WIDER * sizes.patella_width / 2.0 - wall_mm,
            half - wall_mm,
            sizes.patella_height / 2.0 - wall_mm,
        ),
        material,
    )
    return solid.model_copy(update={"cuts": (*facets, *cuts)})
