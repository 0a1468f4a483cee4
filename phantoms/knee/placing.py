"""Where the bones of a knee stand: the joint space is kept, the patella glides in its groove."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from phantom.document import Point
from phantoms.knee import condyles, femur, plateau
from phantoms.knee.sizes import Sizes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

_GROOVE = 0.88
"""Of the femur's outline in front, where the patella's ridge glides."""
_PATELLA_Z = 32.0
_PATELLA_GAP = 0.6
"""Distance of patella and femur over the joint space (an estimate)."""


@dataclass(frozen=True, slots=True)
class Placed:
    """Heights and points, in mm, of a right knee whose joint space is around the origin.

    ``femur_z`` lifts the femur, ``plateau_z`` is the middle of the plateau, ``ridge`` that of the
    patella's ridge.
    """

    femur_z: float
    plateau_z: float
    ridge: Point


def placed(sizes: Sizes) -> Placed:
    """Return where the bones stand."""
    half = sizes.joint_space / 2.0
    points = condyles.surface(sizes)
    _, along = condyles.scales(sizes)
    at_z = _PATELLA_Z * along
    ridge = (
        -0.035 * sizes.patella_width,
        _groove_y(sizes, at_z) - _PATELLA_GAP * sizes.joint_space,
        at_z + half,
    )
    return Placed(half, _least_gap(sizes, points) - half, ridge)


def _least_gap(sizes: Sizes, points: FloatArray) -> float:
    """Return the least height of the medial condyle over a plateau whose middle is at z = 0."""
    return float((points[:, 2] - plateau.surface_z(sizes, points[:, 0], points[:, 1])).min())


def _groove_y(sizes: Sizes, z: float) -> float:
    """Return y of the groove of the trochlea at a height."""
    ((_, _, _, front, back, _),) = femur.shaft_rows(sizes, [z])
    return (front + back) / 2.0 - _GROOVE * (back - front) / 2.0
