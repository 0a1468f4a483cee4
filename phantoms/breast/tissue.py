"""The gland inside a breast: lobes that branch backwards from the nipple, lobules along them, fat.

Drawn in the frame of the compressed breast of the right side: x from the axilla's side (-) to the
other, y from the nipple (-) to the chest wall at 0, z through the thickness. Sizes and numbers of
branches, lobules and clefts are estimates that make a mammogram look like one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from phantom.document import Ellipsoid, Point, Solid, Transformed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

_POINTS: Final = 30_000
"""Places at which the share of the gland is counted: 0.3 % of the volume, one standard error."""

_LOBES: Final = 16
"""A breast has 15 to 20 lobes, each with a duct of its own."""

_SIDE_BRANCHES: Final = 6
_SUBCUTANEOUS_MM: Final = 14.0
_PLATE_MM: Final = 4.0
"""Fat between the skin and the middle of any lobule, at the edge and under the plates."""

_RETROMAMMARY: Final = 0.16
"""Share of the depth, before the chest wall, that is fat alone."""

_LOBULES_TO_A_CLEFT: Final = 6


class Body(NamedTuple):
    """An ellipsoid about the origin, cut at the chest wall and by the plates.

    Attributes
    ----------
    semi_axes
        Along x, y, z, in mm.
    half_mm
        Half the thickness between the plates.
    lean
        How much nearer to the nipple the gland's back is toward the axilla, as a share of x, where
        the pectoral muscle lies behind it.
    """

    semi_axes: tuple[float, float, float]
    half_mm: float
    lean: float = 0.0

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

    @property
    def volume_mm3(self) -> float:
        """Its volume."""
        a, b, c = self.semi_axes
        share = min(self.half_mm / c, 1.0)
        return math.pi * a * b * c * (share - share**3 / 3)

    @property
    def nipple(self) -> FloatArray:
        """The place below the nipple."""
        return np.array([0.0, -self.semi_axes[1], 0.0])

    def bears_gland(self, points: FloatArray) -> NDArray[np.bool_]:
        """Tell which of the (N, 3) points lie within the layers of fat around the gland.

        Under the skin the fat is thinner the nearer the nipple is, where all ducts meet.
        """
        a, b, _ = self.semi_axes
        apart = np.linalg.norm(points - self.nipple, axis=1)
        margin = np.minimum(_SUBCUTANEOUS_MM, 0.4 * apart) * min(1.0, b / 90.0)
        flat = (points[:, 0] / (a - margin)) ** 2 + (points[:, 1] / (b - margin)) ** 2
        inside: NDArray[np.bool_] = flat <= 1.0
        inside &= np.abs(points[:, 2]) <= self.half_mm - _PLATE_MM
        back = _RETROMAMMARY * b + self.lean * np.maximum(0.1 * a - points[:, 0], 0.0)
        return inside & (points[:, 1] <= -back)


class Branch(NamedTuple):
    """A branch of a lobe: (N, 3) points from the nipple outwards, and its radius at both ends."""

    points: FloatArray
    radii_mm: tuple[float, float]

    @property
    def length_mm(self) -> float:
        """Along its points."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


def curve(start: FloatArray, end: FloatArray, sag: FloatArray, pieces: int) -> FloatArray:
    """Return points of a parabola whose middle lies off that of its chord by ``sag``."""
    share = np.linspace(0.0, 1.0, pieces + 1)[:, None]
    points: FloatArray = start + share * (end - start) + 4.0 * share * (1.0 - share) * sag
    return points


def lobes(body: Body, generator: np.random.Generator) -> list[Branch]:
    """Return every lobe's duct, then the side branches of all: as many whatever the breast."""
    a, b, _ = body.semi_axes
    spread = generator.standard_normal((_LOBES, 3)) * [0.40, 0.10, 0.0]
    spread[:, 2] = generator.uniform(-0.8, 0.8, _LOBES)
    ends = spread * [a, b, body.half_mm] + [-0.09 * a, -0.30 * b, 0.0]
    mains, sides = [], []
    for end in ends:
        start = body.nipple + generator.normal(0.0, 1.2, 3) + [0.0, 1.0, 0.0]
        for _ in range(30):
            if not body.bears_gland(end[None])[0]:
                end = start + 0.92 * (end - start)
        reach = float(np.linalg.norm(end - start))
        sag = generator.normal(0.0, 0.05, 3) * reach
        main = Branch(curve(start, end, sag, 9), (0.9, 0.35))
        mains.append(main)
        for share in (np.arange(_SIDE_BRANCHES) + generator.random(_SIDE_BRANCHES)) / (
            _SIDE_BRANCHES
        ):
            sides.append(_side(main, 0.2 + 0.75 * float(share), generator))
    return [*mains, *sides]


def _side(main: Branch, share: float, generator: np.random.Generator) -> Branch:
    """Return a branch that leaves another and turns to run beside it."""
    points = main.points
    place = share * (len(points) - 1)
    index = min(int(place), len(points) - 2)
    start = points[index] + (place - index) * (points[index + 1] - points[index])
    along = _unit(points[index + 1] - points[index])
    way = generator.standard_normal(3) * [1.0, 1.0, 0.6]
    aside = _unit(way - (way @ along) * along)
    reach = main.length_mm * float(generator.uniform(0.16, 0.38))
    end = start + reach * (0.85 * along + 0.55 * aside)
    return Branch(curve(start, end, 0.12 * reach * aside, 5), (0.5, 0.2))


class Lobule(NamedTuple):
    """A piece of gland or of fat in it: an ellipsoid.

    Attributes
    ----------
    center
        Of it, in mm.
    axes
        Unit vectors along its semi-axes, in columns.
    half_mm
        The semi-axes.
    """

    center: FloatArray
    axes: FloatArray
    half_mm: FloatArray


def lobules(
    body: Body,
    branches: list[Branch],
    number: int,
    share: float,
    generator: np.random.Generator,
) -> tuple[list[Lobule], list[Lobule]]:
    """Return lobules that fill this share of the body, and clefts of fat that take from them.

    All lobules are scaled alike to fill it: a point is inside when its least gauge is below the
    square of the scale, so the scale is a quantile.
    """
    weights = np.array([branch.length_mm for branch in branches])
    weights[:_LOBES] *= 0.8
    drawn: list[Lobule] = []
    while len(drawn) < number:
        branch = branches[int(generator.choice(len(branches), p=weights / weights.sum()))]
        place = float(generator.beta(1.6, 1.1)) * (len(branch.points) - 1)
        index = min(int(place), len(branch.points) - 2)
        step = branch.points[index + 1] - branch.points[index]
        at = branch.points[index] + (place - index) * step
        reach = float(np.linalg.norm(at - body.nipple)) / body.semi_axes[1]
        center = at + generator.standard_normal(3) * (1.0 + (5.0 + 15.0 * share) * reach)
        thin, flat, long = np.exp(generator.normal((-0.2, 0.35, 1.3), (0.5, 0.3, 0.35)))
        thin = min(thin, 2.2)
        turns = generator.standard_normal((2, 3))
        along = _unit(_unit(step) + 0.25 * turns[0])
        half = thin * np.array([1.0, flat, long])
        ends = center + 1.1 * half[2] * np.array([[-1.0], [0.0], [1.0]]) * along
        if body.bears_gland(ends).all():
            drawn.append(Lobule(center, _axes(along, turns[1]), half))
    clefts = []
    for _ in range(number // _LOBULES_TO_A_CLEFT):
        host = drawn[int(generator.integers(number))]
        center = host.center + generator.normal(0.0, 3.0, 3)
        thin, flat, long = np.exp(generator.normal((0.55, 0.4, 0.9), (0.45, 0.3, 0.4)))
        turns = generator.standard_normal((2, 3))
        along = _unit(host.axes[:, 2] + 0.25 * turns[0])
        clefts.append(Lobule(center, _axes(along, turns[1]), thin * np.array([1.0, flat, long])))
    points = body.fill(_POINTS)
    least = _least_gauge(drawn, points)
    least[_least_gauge(clefts, points) <= 1.0] = np.inf
    scale = math.sqrt(float(np.quantile(least, share, method="lower")))
    return [lobule._replace(half_mm=scale * lobule.half_mm) for lobule in drawn], clefts


def _least_gauge(drawn: list[Lobule], points: FloatArray) -> FloatArray:
    """Return for each point the least gauge of any ellipsoid: 1 on its surface, as a square."""
    x, y, z = points.T
    terms = np.stack([x * x, y * y, z * z, x * y, x * z, y * z, x, y, z, np.ones_like(x)])
    rows = np.empty((len(drawn), 10))
    for row, lobule in zip(rows, drawn, strict=True):
        form = (lobule.axes / lobule.half_mm**2) @ lobule.axes.T
        pull = form @ lobule.center
        row[:3] = np.diag(form)
        row[3:6] = 2 * form[0, 1], 2 * form[0, 2], 2 * form[1, 2]
        row[6:9] = -2 * pull
        row[9] = lobule.center @ pull
    least = np.full(len(points), np.inf)
    for start in range(0, len(rows), 64):
        np.minimum(least, (rows[start : start + 64] @ terms).min(axis=0, initial=np.inf), out=least)
    return least


def lobule_solid(name: str, lobule: Lobule, material: str) -> Solid:
    """Return the lobule as a solid."""
    axes = np.column_stack([lobule.axes, lobule.center])
    rows = tuple((float(a), float(b), float(c), float(d)) for a, b, c, d in axes)
    ellipsoid = Ellipsoid(
        type="ellipsoid",
        name=name,
        material=material,
        center=(0.0, 0.0, 0.0),
        semi_axes=point(lobule.half_mm),
    )
    return Transformed(type="transformed", solid=ellipsoid, matrix=(rows[0], rows[1], rows[2]))


def _axes(along: FloatArray, way: FloatArray) -> FloatArray:
    """Return axes in columns, the third along, the others turned to ``way``."""
    first = _unit(way - (way @ along) * along)
    return np.column_stack([first, np.cross(along, first), along])


def _unit(vector: FloatArray) -> FloatArray:
    made: FloatArray = vector / np.linalg.norm(vector)
    return made


def point(p: FloatArray) -> Point:
    """Return a point or lengths as a document has them."""
    x, y, z = (float(c) for c in p)
    return (x, y, z)
