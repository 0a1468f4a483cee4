"""What is inside a breast: gland, ducts, ligaments and vessels, drawn at random.

Drawn in the frame of the compressed breast of the right side: x from the axilla's side (-) to the
other, y from the nipple (-) to the chest wall at 0, z through the thickness. Sizes and numbers of
lobules and strands are estimates that make a mammogram look like one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from phantom.document import (
    CircleContour,
    Ellipsoid,
    GeneralizedCylinder,
    KnotProfile,
    LinearSweep,
    Point,
    Rotation,
    Solid,
    SplineAxis,
    Transformed,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

_POINTS = 30_000
"""Places at which the share of the gland is counted: 0.3 % of the volume, one standard error."""

_LOBES = 16
"""A breast has 15 to 20 lobes, each with a duct of its own."""

_SUBCUTANEOUS_MM = 5.0
"""Fat between the skin and the middle of any lobule."""


class Body(NamedTuple):
    """An ellipsoid about the origin, cut at the chest wall and by the plates.

    Attributes
    ----------
    semi_axes
        Along x, y, z, in mm.
    half_mm
        Half the thickness between the plates.
    """

    semi_axes: tuple[float, float, float]
    half_mm: float

    def holds(self, points: FloatArray, margin_mm: float = 0.0) -> NDArray[np.bool_]:
        """Tell which of the (N, 3) points lie inside, by a margin."""
        axes = np.asarray(self.semi_axes) - margin_mm
        inside: NDArray[np.bool_] = np.sum((points / axes) ** 2, axis=1) <= 1.0
        inside &= np.abs(points[:, 2]) <= self.half_mm - margin_mm
        return inside & (points[:, 1] <= -margin_mm)

    def fill(self, number: int) -> FloatArray:
        """Return (N, 3) points spread evenly through it, always the same."""
        from scipy.stats import qmc

        a, b, _ = self.semi_axes
        box = np.array([2 * a, b, 2 * self.half_mm])
        unit = qmc.Halton(3, scramble=False).random(2 * number)[1:]
        points: FloatArray = unit * box - [a, b, self.half_mm]
        return points[self.holds(points)][:number]


class Lobule(NamedTuple):
    """A piece of gland: an ellipsoid of revolution whose long axis points to the nipple."""

    center: FloatArray
    long_mm: float
    thin_mm: float
    along: FloatArray


def lobules(body: Body, number: int, share: float, generator: np.random.Generator) -> list[Lobule]:
    """Return lobules that fill this share of the body together, where they lie in it.

    All are scaled alike to fill it: a point is inside when its least gauge is below the square of
    the scale, so the scale is a quantile.
    """
    a, b, _ = body.semi_axes
    nipple = np.array([0.0, -b, 0.0])
    # The far end of each lobe's duct, drawn over a disc behind the nipple, more of it outward.
    ends = generator.standard_normal((_LOBES, 3)) * [0.42 * a, 0.13 * b, 0.42 * body.half_mm]
    ends += [-0.10 * a, -0.30 * b, 0.0]
    drawn: list[Lobule] = []
    while len(drawn) < number:
        end = ends[int(generator.integers(_LOBES))]
        reach = float(generator.beta(2.2, 1.5))
        jitter = generator.standard_normal(3) * [0.10 * a, 0.06 * b, 0.16 * body.half_mm]
        center = nipple + reach * (end - nipple) + (0.35 + reach) * (0.7 + share) * jitter
        long_mm, thin_mm = np.exp(generator.normal((1.8, 0.9), (0.5, 0.6)))
        turn = generator.standard_normal(3)
        if not body.holds(center[None], _SUBCUTANEOUS_MM)[0]:
            continue
        along = nipple - center
        along = along / np.linalg.norm(along) + 0.3 * turn
        drawn.append(Lobule(center, long_mm, thin_mm, along / np.linalg.norm(along)))
    points = body.fill(_POINTS)
    least = np.full(len(points), np.inf)
    for lobule in drawn:
        apart = points - lobule.center
        far = apart @ lobule.along
        gauge = (np.sum(apart**2, axis=1) - far**2) / lobule.thin_mm**2
        np.minimum(least, gauge + (far / lobule.long_mm) ** 2, out=least)
    scale = math.sqrt(float(np.quantile(least, share)))
    return [
        lobule._replace(long_mm=scale * lobule.long_mm, thin_mm=scale * lobule.thin_mm)
        for lobule in drawn
    ]


def lobule_solid(name: str, lobule: Lobule) -> Solid:
    """Return the lobule as a solid."""
    center = _point(lobule.center)
    x, y, z = lobule.along
    ellipsoid = Ellipsoid(
        type="ellipsoid",
        name=name,
        material="gland",
        center=center,
        semi_axes=(lobule.thin_mm, lobule.thin_mm, lobule.long_mm),
    )
    angle = math.degrees(math.acos(min(1.0, max(-1.0, z))))
    if math.hypot(x, y) < 1e-9:
        return ellipsoid
    turn = Rotation(axis=(-float(y), float(x), 0.0), angle_deg=angle, about=center)
    return Transformed(type="transformed", solid=ellipsoid, rotate=turn)


def strands(body: Body, number: int, generator: np.random.Generator) -> list[Solid]:
    """Return ducts from the nipple (a third), ligaments and vessels, as tubes that taper."""
    a, b, _ = body.semi_axes
    inner = body._replace(semi_axes=(0.97 * a, 0.97 * b, body.semi_axes[2]))
    tubes: list[Solid] = []
    for index in range(number):
        duct = index % 3 == 0
        if duct:
            start = np.array([0.0, -0.95 * b, 0.0]) + generator.normal(0.0, 1.5, 3)
        else:
            start = _inside(inner, generator)
        end = _inside(inner, generator)
        thick = math.exp(generator.normal(-0.5 if duct else -1.1, 0.4))
        # A parabola; its bend is no tighter than its length, so it never folds into itself.
        sag = np.clip(generator.normal(0.0, 0.07, 3), -0.125, 0.125) * np.linalg.norm(end - start)
        steps = np.linspace(0.0, 1.0, 5)[:, None]
        points = start + steps * (end - start) + 4 * steps * (1 - steps) * sag
        if np.linalg.norm(end - start) < 15.0:
            continue
        tubes.append(_tube(f"{'duct' if duct else 'strand'}-{index + 1:03d}", points, thick))
    return tubes


def _tube(name: str, points: FloatArray, radius_mm: float) -> Solid:
    taper = KnotProfile(knots=((0.0, radius_mm), (1.0, 0.45 * radius_mm)))
    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material="gland",
        axis=SplineAxis(points=tuple(_point(p) for p in points)),
        contour=CircleContour(radius=1.0),
        sweep=LinearSweep(scale=taper),
    )


def _inside(body: Body, generator: np.random.Generator) -> FloatArray:
    """Return a point inside, by 4 mm, from the middle out."""
    a, b, _ = body.semi_axes
    while True:
        x, y, z = generator.random(3)
        point = np.array([(2 * x - 1) * a, -y * b, (2 * z - 1) * body.half_mm])
        if body.holds(point[None], 4.0)[0]:
            return point


def _point(p: FloatArray) -> Point:
    return (float(p[0]), float(p[1]), float(p[2]))
