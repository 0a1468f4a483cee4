"""Where the bones of a knee stand: the joint space is kept, the patella glides in its groove."""

from __future__ import annotations

from dataclasses import dataclass

from phantom.document import Point
from phantoms.knee import femur
from phantoms.knee.sizes import Sizes
from phantoms.parts import chord_lengths

_FRONT = 0.88
"""Of the femur's outline, what is in front of the shaft, where the patella's ridge begins."""
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
    lowest = _lowest(sizes)
    _, along = femur.scales(sizes)
    at_z = _PATELLA_Z * along
    front_y = _front_y(sizes, at_z)
    ridge = (-0.035 * sizes.patella_width, front_y - _PATELLA_GAP * sizes.joint_space, at_z + half)
    return Placed(half, lowest - half, ridge)


def _lowest(sizes: Sizes) -> float:
    """Return z of the middle of a plateau that just touches the medial condyle."""
    from phantoms.knee.shin import plateau

    cut = plateau(sizes)
    slope = cut.normal[1] / cut.normal[2]
    points = _profile(sizes, 1.0)
    return min(z + slope * (y - cut.point[1]) for y, z in points)


def _front_y(sizes: Sizes, z: float) -> float:
    """Return y of the trochlea's front at a height."""
    points = _profile(sizes, _FRONT)
    return min(((abs(at - z), y) for y, at in points if y < 0.0))[1]


def _profile(sizes: Sizes, share: float) -> list[tuple[float, float]]:
    """Return points (y, z) of the femur's outside where its outline is at ``share``.

    The same splines as the engine's, through the same stations.
    """
    import numpy as np
    from scipy.interpolate import CubicSpline

    stations = femur.stations_of(sizes)[0]
    points = [station.at for station in stations]
    at = chord_lengths(points)
    u = np.linspace(at[-8], at[-1], 400)
    axis = CubicSpline(at, np.array(points))
    first = axis(u, 1)
    b_high = CubicSpline(at, np.array([station.b for station in stations]))(u)
    reach = (b_high.sum(axis=1) + share * (b_high[:, 1] - b_high[:, 0])) / 2.0
    # b = t x n with n = +x: (0, t_z, -t_y).
    length = np.hypot(first[:, 1], first[:, 2])
    y = axis(u)[:, 1] + reach * first[:, 2] / length
    z = axis(u)[:, 2] - reach * first[:, 1] / length
    return list(zip(y.tolist(), z.tolist(), strict=True))
