"""Parts that anatomy is built of: sections along a bone's axis, the wall of a bone, names, sides.

A bone is drawn by *stations*: points of its axis, and how far its section reaches from each. One
outline that fills the square [-1, 1]² is swept through them (:func:`swept`). What lies a wall's
thickness inside a bone is drawn by the stations that :func:`within` makes of the bone's own, so
that cortex, spongiosa and marrow are nested whatever the person's sizes are.

World axes are the patient's: +x to the left, +y to the back, +z to the head; millimetres.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from phantom.document import (
    CircleContour,
    Cut,
    Ellipsoid,
    GeneralizedCylinder,
    KnotProfile,
    LinearSweep,
    Point,
    Replace,
    Solid,
    SplineAxis,
    SplineContour,
    Transformed,
    Union,
    UpFrame,
    Vector,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

Outline = tuple[tuple[float, float], ...]
ROUND: Final = "round"
"""The outline of a bone with elliptic sections."""

SAMPLES: Final = 600
"""Places along a bone at which its wall is taken off; sections are 0.1 to 1 mm apart."""


class Station(NamedTuple):
    """A section of a bone: a point of its axis, and how far the section reaches from it, in mm.

    ``x`` is the reach against and with n, the direction ``up`` of :func:`swept` made square to the
    axis; ``b`` that against and with b = t x n. On an axis that rises, with up = +x, b is +y.
    """

    at: Point
    x: tuple[float, float]
    b: tuple[float, float]


def round_station(at: Point, radius_x: float, radius_b: float | None = None) -> Station:
    """Return the station of a section whose middle lies on the axis."""
    other = radius_x if radius_b is None else radius_b
    return Station(at, (-radius_x, radius_x), (-other, other))


def chord_lengths(points: Sequence[Point]) -> list[float]:
    """Return u of the points of a spline axis: chord length scaled to [0, 1]."""
    lengths = [0.0]
    for start, end in pairwise(points):
        lengths.append(lengths[-1] + math.dist(start, end))
    return [length / lengths[-1] for length in lengths]


def knots(at: Sequence[float], values: Sequence[float]) -> KnotProfile:
    """Return the profile with these values there."""
    return KnotProfile(knots=tuple(zip(at, values, strict=True)))


def swept(
    name: str,
    stations: Sequence[Station],
    material: str | None,
    outline: Outline | Literal["round"] = ROUND,
    *,
    up: Vector = (1.0, 0.0, 0.0),
    cuts: Sequence[Cut] = (),
) -> GeneralizedCylinder:
    """Sweep an outline that fills the square [-1, 1]² through the stations.

    Parameters
    ----------
    outline
        Points [n, b] of a closed spline, or ``round``.
    up
        The direction that n stays nearest to; never along the axis.
    """
    points = [station.at for station in stations]
    at = chord_lengths(points)
    sides = ([station.x for station in stations], [station.b for station in stations])
    half_n, half_b = ([(high - low) / 2 for low, high in side] for side in sides)
    middle_n, middle_b = ([(high + low) / 2 for low, high in side] for side in sides)
    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material=material,
        axis=SplineAxis(type="spline", points=tuple(points)),
        contour=(
            CircleContour(type="circle", radius=1.0)
            if outline == ROUND
            else SplineContour(type="spline", points=outline)
        ),
        sweep=LinearSweep(
            type="linear",
            scale=(knots(at, half_n), knots(at, half_b)),
            offset=(knots(at, middle_n), knots(at, middle_b)),
        ),
        frame=UpFrame(up=up),
        cuts=tuple(cuts),
    )


def within(
    stations: Sequence[Station],
    wall_mm: float | Sequence[float],
    *,
    closed: tuple[bool, bool] = (True, True),
    least_mm: float = 0.3,
    count: int | None = None,
) -> list[Station]:
    """Return the stations of what lies a wall's thickness inside a bone.

    The bone's outermost line on each of the four sides, as a height over the axis, is eroded by
    discs of the wall's thickness, so that the wall is as thick across slopes and round ends.

    Parameters
    ----------
    wall_mm
        Thickness of the wall: one number, or one for each station.
    closed
        Whether there is a wall at the first and at the last end; without one the inside ends where
        the bone does.
    least_mm
        Half-widths are at least this, where the wall fills the bone.
    count
        Number of stations; by default as many as the bone has.
    """
    import numpy as np
    from scipy.interpolate import CubicSpline

    points = np.array([station.at for station in stations])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    walls = np.broadcast_to(np.asarray(wall_mm, dtype=np.float64), along.shape)
    first = along[0] + (walls[0] if closed[0] else 0.0)
    last = along[-1] - (walls[-1] if closed[1] else 0.0)
    new = _stretched(along, first, last, len(stations) if count is None else count)
    dense = np.linspace(along[0], along[-1], SAMPLES)
    reaches = np.array([(-s.x[0], s.x[1], -s.b[0], s.b[1]) for s in stations])
    heights = (
        CubicSpline(along, reaches)(dense)
        if len(stations) > 3
        else _straight(dense, along, reaches)
    )
    wall = np.interp(dense, along, walls)
    apart = new[:, None] - dense[None, :]
    fall = np.sqrt(np.maximum(wall**2 - apart**2, 0.0))
    covered = np.abs(apart) <= np.maximum(wall, along[-1] / SAMPLES)
    eroded = np.where(covered[:, :, None], heights[None] - fall[:, :, None], np.inf).min(axis=1)
    at = CubicSpline(along, points)(new) if len(stations) > 3 else _straight(new, along, points)
    return [
        Station(
            (float(p[0]), float(p[1]), float(p[2])),
            _at_least(-reach[0], reach[1], least_mm),
            _at_least(-reach[2], reach[3], least_mm),
        )
        for p, reach in zip(at, eroded, strict=True)
    ]


def _stretched(along: FloatArray, first: float, last: float, count: int) -> FloatArray:
    """Return ``count`` places from first to last, spread as those of ``along`` are."""
    import numpy as np

    spread: FloatArray = np.interp(
        np.linspace(0.0, 1.0, count), np.linspace(0.0, 1.0, len(along)), along
    )
    share: FloatArray = (spread - along[0]) / (along[-1] - along[0])
    return first + share * (last - first)


def _straight(new: FloatArray, along: FloatArray, values: FloatArray) -> FloatArray:
    import numpy as np

    return np.array([np.interp(new, along, column) for column in values.T]).T


def _at_least(low: float, high: float, least_mm: float) -> tuple[float, float]:
    """Return a reach about the same middle, at least so wide to both sides of it."""
    middle, half = (low + high) / 2, max((high - low) / 2, least_mm)
    return (float(middle - half), float(middle + half))


def ellipsoid(name: str, center: Point, semi_axes: Point, material: str | None = None) -> Ellipsoid:
    """Return an ellipsoid along the world's axes."""
    return Ellipsoid(
        type="ellipsoid", name=name, material=material, center=center, semi_axes=semi_axes
    )


def is_left(solid: Ellipsoid) -> bool:
    """Return whether each cut by itself leaves something of an ellipsoid."""

    def depth(cut: Cut) -> float:
        away = sum(n * (c - p) for n, c, p in zip(cut.normal, solid.center, cut.point, strict=True))
        reach = math.hypot(*(n * a for n, a in zip(cut.normal, solid.semi_axes, strict=True)))
        return (reach - away) / math.hypot(*cut.normal)

    return all(depth(cut) > 0.01 for cut in solid.cuts)


def union(*solids: Solid) -> Solid:
    """Join solids, the first before the later where they share space; one alone is itself."""
    return solids[0] if len(solids) == 1 else Union(type="union", solids=solids)


def layered(*solids: Solid) -> Solid:
    """Join solids, each in place of the earlier where they share space; one alone is itself."""
    return solids[0] if len(solids) == 1 else Replace(type="replace", solids=solids)


def named(name: str, solid: Solid, *, shift: Vector = (0.0, 0.0, 0.0)) -> Transformed:
    """Put a name before the labels of a solid's leaves, as in ``femur/cortex``."""
    return Transformed(type="transformed", name=name, solid=solid, translate=shift)


def sided(solid: Solid, side: Literal["right", "left"]) -> Solid:
    """Return a solid drawn on the right, or its mirror image on the left."""
    across = ((-1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    return solid if side == "right" else Transformed(type="transformed", solid=solid, matrix=across)


def sided_point(point: Point, side: Literal["right", "left"]) -> Point:
    """Return a point drawn on the right, or its mirror image on the left."""
    x, y, z = point
    return point if side == "right" else (-x, y, z)
