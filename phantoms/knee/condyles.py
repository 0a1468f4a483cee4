"""The condyles of the femur: two wheels with the outline of a spiral, the notch between them.

The medial one is a generalized cylinder whose axis runs across the knee: the outline seen from the
side is its contour, which shrinks toward the side and toward the notch. The lateral one is its
mirror image, a little higher. Drawn for a man's right femur whose medial condyle touches z = 0
(estimates between published sizes).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from phantom.document import Instance, Solid, Transformed
from phantoms.knee.sizes import Sizes
from phantoms.parts import Outline, Station, chord_lengths, swept, within

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

WIDTH: Final = 87.02
DEPTH: Final = 61.57
"""Across and from front to back of the tables' condyles, as traced."""
NOTCH: Final = 22.0
WALL_MM: Final = 0.9

# (y, z) from the top of the trochlea down its front, under the joint and up behind. From behind the
# condyle goes over into the shaft without a ledge.
_OUTLINE: Final = (
    (-12.0, 50.0),
    (-19.0, 37.0),
    (-17.4, 21.5),
    (-7.5, 7.4),
    (6.0, 1.2),
    (20.0, 0.0),
    (34.0, 4.6),
    (41.3, 18.5),
    (37.6, 32.6),
    (24.0, 44.6),
    (6.0, 53.4),
)
_AXIS: Final = (16.0, 24.0)
# Sections: x out from the border of the notch, then from the middle of the knee; height of bottom
# and top; y of front and back. The first, and all tops, hide in the shaft and the epicondyles.
_FROM_BORDER: Final = (
    (-6.0, 26.0, 42.0, -4.0, 16.0),
    (-1.4, 10.5, 44.0, -6.0, 31.0),
    (2.5, 4.3, 46.0, -13.0, 37.0),
)
_TO_SIDE: Final = (
    (23.8, 0.0, 50.0, -19.4, 41.5),
    (34.0, 2.6, 41.0, -17.0, 39.8),
    (39.9, 8.7, 31.5, -9.0, 33.8),
    (41.8, 13.7, 27.0, 0.0, 27.8),
)
_LATERAL: Final = (-0.2, -0.2, 1.0)
"""How far the lateral condyle is from the mirror image of the medial one."""
OUTSIDE: Final = "cortex of a condyle"
INSIDE: Final = "spongiosa of a condyle"


class Wheel(NamedTuple):
    """The medial condyle: its contour in the square [-1, 1]², n up and b forward, and its stations.

    ``inside`` are those a wall's thickness inside.
    """

    outline: Outline
    outside: list[Station]
    inside: list[Station]


def scales(sizes: Sizes) -> tuple[float, float]:
    """Return the factors across (x) and along (y and z) of the condyles."""
    return sizes.bicondylar_width / WIDTH, sizes.condylar_depth / DEPTH


def wheel(sizes: Sizes) -> Wheel:
    """Return the medial condyle, drawn toward the left."""
    across, along = scales(sizes)
    ys, zs = zip(*_OUTLINE, strict=True)
    contour = tuple(
        (
            (2.0 * z - max(zs) - min(zs)) / (max(zs) - min(zs)),
            -(2.0 * y - max(ys) - min(ys)) / (max(ys) - min(ys)),
        )
        for y, z in _OUTLINE
    )
    border = sizes.notch_width / 2.0
    rows = [(border + row[0] * across, row[1:]) for row in _FROM_BORDER]
    # What is left beside the notch is shared out as in the table, however wide the notch is.
    start, side = rows[-1][0], _TO_SIDE[-1][0] * across
    first, last = NOTCH / 2.0 + _FROM_BORDER[-1][0], _TO_SIDE[-1][0]
    share = (side - start) / (last - first)
    rows += [(start + (at[0] - first) * share, at[1:]) for at in _TO_SIDE]
    y0, z0 = (at * along for at in _AXIS)
    stations = []
    for x, row in rows:
        bottom, top, front, back = (along * value for value in row)
        stations.append(Station((x, y0, z0), (bottom - z0, top - z0), (y0 - back, y0 - front)))
    return Wheel(contour, stations, within(stations, WALL_MM))


def definitions(sizes: Sizes) -> dict[str, Solid]:
    """Return the outside and the inside of the medial condyle, to be used for both."""
    outline, outside, inside = wheel(sizes)
    up = (0.0, 0.0, 1.0)
    drawn = {
        OUTSIDE: swept(OUTSIDE, outside, "cortical bone", outline, up=up),
        INSIDE: swept(INSIDE, inside, "spongiosa", outline, up=up),
    }
    # Their labels are those of where they are used.
    return {name: solid.model_copy(update={"name": None}) for name, solid in drawn.items()}


def condyles(sizes: Sizes, layer: str, of: str) -> list[Solid]:
    """Return a layer of both condyles, which is defined by the name ``of``."""
    solid = Instance(type="instance", name=f"{layer} of the medial condyle", of=of)
    rows = tuple(
        (*row, scales(sizes)[1] * away)
        for row, away in zip(
            ((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), _LATERAL, strict=True
        )
    )
    other = Instance(type="instance", of=of)
    name = f"{layer} of the lateral condyle"
    return [solid, Transformed(type="transformed", name=name, solid=other, matrix=rows)]


def surface(sizes: Sizes) -> FloatArray:
    """Return points ``(N, 3)``, in mm, of the medial condyle, as the engine's splines draw it."""
    import numpy as np
    from scipy.interpolate import CubicSpline

    contour, stations, _ = wheel(sizes)
    closed = np.array([*contour, contour[0]])
    chords = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    section = CubicSpline(chords, closed, bc_type="periodic")(np.linspace(0, chords[-1], 400))
    points = [station.at for station in stations]
    u = np.linspace(0.0, 1.0, 80)
    at = CubicSpline(chord_lengths(points), np.array(points))(u)
    reach = CubicSpline(chord_lengths(points), np.array([(*s.x, *s.b) for s in stations]))(u)
    half = (reach[:, 1::2] - reach[:, ::2]) / 2.0
    middle = (reach[:, 1::2] + reach[:, ::2]) / 2.0
    found = middle[:, None, :] + half[:, None, :] * section[None]
    x = np.broadcast_to(at[:, None, 0], found.shape[:2])
    return np.stack(
        [x, at[:, None, 1] - found[..., 1], at[:, None, 2] + found[..., 0]], axis=-1
    ).reshape(-1, 3)
