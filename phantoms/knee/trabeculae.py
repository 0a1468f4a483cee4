"""Trabeculae: plates of spongy bone that are denser than what is around them.

Thin ellipsoids along the lines that loads follow (upright in the tibia, a fan in the femur), each
turned about its length by chance, so that a ray that meets one edge-on sees a streak and others do
not. How many, how large and how dense they are is chosen by eye (estimates); real ones are thinner
and a thousand times as many.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from phantom.document import Cut, Solid, Transformed
from phantoms.parts import Station, ellipsoid

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

MATERIAL: Final = "trabeculae"
OVER_SPONGIOSA: Final = 1.12
"""Their density, as porous cortical bone, over that of the spongy bone around them."""
THICK_MM: Final = (0.35, 1.0)
WIDE_MM: Final = (1.6, 4.6)
LONG_MM: Final = (5.0, 16.0)
"""Semi-axes of a plate, from and to."""
_SCATTER: Final = 0.11
"""Standard deviation of a plate's direction about the field's, in radians."""
_AT_ONCE, _MOST_TRIES = 256, 40


class Region(NamedTuple):
    """Where plates may be: in the elliptic middle of a bone's sections, between two heights.

    Attributes
    ----------
    stations
        Of what lies inside the bone's wall.
    axis
        Along which they are, x or z.
    share
        Of the half-widths, what a plate may fill; outlines that are no ellipses ask for less.
    heights
        Lowest and highest z in mm.
    """

    stations: Sequence[Station]
    axis: Literal["x", "z"]
    share: float
    heights: tuple[float, float]

    def holds(self, points: FloatArray) -> NDArray[np.bool_]:
        """Return which of points ``(..., 3)`` lie in it."""
        import numpy as np

        rising = self.axis == "z" and self.stations[0].at[2] < self.stations[-1].at[2]
        along, n, b = (2, 0, 1) if self.axis == "z" else (0, 2, 1)
        rows = sorted((s.at[along], s.at[n], s.at[b], *s.x, *s.b) for s in self.stations)
        at, n0, b0, n_low, n_high, b_low, b_high = np.array(rows).T
        here = points[..., along]

        if not rising:
            b_low, b_high = -b_high, -b_low

        def away(side: int, middle: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
            center = np.interp(here, at, middle + (low + high) / 2.0)
            share: FloatArray = (points[..., side] - center) / np.interp(here, at, (high - low) / 2)
            return share

        far = np.hypot(away(n, n0, n_low, n_high), away(b, b0, b_low, b_high))
        z = points[..., 2]
        # Plates are no thicker than this; their flats are not asked about.
        least, most = at[0] + 1.5 * THICK_MM[1], at[-1] - 1.5 * THICK_MM[1]
        found: NDArray[np.bool_] = (far < self.share) & (here > least) & (here < most)
        found &= (z > self.heights[0]) & (z < self.heights[1])
        return found


def plates(
    region: Region,
    count: int,
    direction: Callable[[FloatArray], FloatArray],
    generator: np.random.Generator,
    size: float,
) -> list[FloatArray]:
    """Draw plates in a region: each a matrix ``(3, 4)``, its semi-axes as columns and its middle.

    Parameters
    ----------
    direction
        Of the lines of load at points ``(N, 3)``, in any length.
    size
        Scales what a plate measures.
    """
    import numpy as np

    low, high = (
        np.array([side * 60.0 * size, side * 60.0 * size, z])
        for side, z in zip((-1.0, 1.0), region.heights, strict=True)
    )
    found: list[FloatArray] = []
    for _ in range(_MOST_TRIES):
        middle = generator.uniform(low, high, (_AT_ONCE, 3))
        along = direction(middle)
        along /= np.linalg.norm(along, axis=1)[:, None]
        along += generator.normal(0.0, _SCATTER, along.shape)
        along /= np.linalg.norm(along, axis=1)[:, None]
        side = np.cross(along, generator.standard_normal(along.shape))
        side /= np.linalg.norm(side, axis=1)[:, None]
        spans = [generator.uniform(*span, (_AT_ONCE, 1)) for span in (THICK_MM, WIDE_MM, LONG_MM)]
        thick, wide, long = (size * span for span in spans)
        columns = [np.cross(side, along) * thick, side * wide, along * long]
        ends = np.stack([middle] + [middle + s * c for c in columns[1:] for s in (-1.0, 1.0)])
        kept = region.holds(ends).all(axis=0)
        found += list(np.stack([*columns, middle], axis=-1)[kept])
        if len(found) >= count:
            break
    return found[:count]


def solids_of(found: Sequence[FloatArray], cuts: Sequence[Cut]) -> list[Solid]:
    """Return plates as solids, as far as ``cuts`` keep them."""
    import numpy as np

    solids: list[Solid] = []
    for number, plate in enumerate(found, start=1):
        columns, middle = plate[:, :3], plate[:, 3]
        semi = np.linalg.norm(columns, axis=0)
        turn = columns / semi
        met = []
        for cut in cuts:
            normal = np.array(cut.normal)
            over = float(normal @ (middle - np.array(cut.point)))
            reach = float(np.linalg.norm(normal @ columns)) - 0.01
            if over > reach:
                break
            if over > -reach:
                point = turn.T @ (np.array(cut.point) - middle)
                met.append(Cut(point=_triple(point), normal=_triple(turn.T @ normal)))
        else:
            solid = ellipsoid(f"trabecula {number}", (0.0, 0.0, 0.0), _triple(semi), MATERIAL)
            rows = tuple((*_triple(turn[i]), float(middle[i])) for i in range(3))
            kept = solid.model_copy(update={"cuts": tuple(met)}) if met else solid
            solids.append(Transformed(type="transformed", solid=kept, matrix=rows))
    return solids


def _triple(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return (x, y, z)
