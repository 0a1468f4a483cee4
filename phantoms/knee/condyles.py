"""The condyles of the femur: two wheels with the outline of a spiral, the notch between them.

Both are one generalized cylinder whose axis runs across the knee: the outline seen from the side
is its contour, which swells to each condyle, rounds it toward the side and the notch, and shrinks
to an axle between them, hidden in the shaft. Drawn for a man's right femur whose medial condyle
touches z = 0 (estimates between published sizes).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from phantom.document import Cut, GeneralizedCylinder
from phantoms.knee.sizes import Sizes
from phantoms.parts import Outline, Station, chord_lengths, swept, within

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

WIDTH: Final = 87.44
DEPTH: Final = 61.23
"""Across and from front to back of the tables' condyles, as traced."""
WALL_MM: Final = 0.9

# (y, z) from the top of the trochlea down its front, under the joint and up behind. From behind the
# condyle goes over into the shaft without a ledge.
_OUTLINE: Final = (
    (-12.0, 50.0),
    (-18.6, 41.0),
    (-19.4, 30.0),
    (-15.2, 17.0),
    (-6.5, 6.8),
    (6.0, 1.3),
    (19.0, 0.0),
    (31.0, 3.0),
    (39.2, 11.0),
    (41.5, 21.0),
    (38.6, 31.0),
    (30.0, 40.5),
    (18.0, 49.0),
    (3.0, 54.0),
)
_AXIS: Final = (16.0, 24.0)
# Sections: x from the middle of the knee, or out from the border of the notch; height of bottom and
# top; y of front and back. Tops hide in the epicondyles.
_LATERAL: Final = (
    (-42.0, 14.5, 26.5, 0.0, 28.0),
    (-40.1, 9.6, 31.0, -9.0, 34.0),
    (-34.2, 3.6, 40.0, -17.0, 39.5),
    (-23.8, 1.0, 49.5, -19.4, 41.2),
)
_FROM_BORDER: Final = ((2.5, 4.3, 46.0, -13.0, 37.0), (-1.4, 10.5, 44.0, -6.0, 31.0))
_AXLE: Final = (0.0, 27.0, 43.0, -4.0, 17.0)
_MEDIAL: Final = (
    (23.8, 0.0, 50.0, -19.4, 41.5),
    (34.0, 2.6, 41.0, -17.0, 39.8),
    (39.9, 8.7, 31.5, -9.0, 33.8),
    (41.8, 13.7, 27.0, 0.0, 27.8),
)


class Wheels(NamedTuple):
    """The condyles: their contour in the square [-1, 1]², n up and b forward, and stations."""

    outline: Outline
    stations: list[Station]


def scales(sizes: Sizes) -> tuple[float, float]:
    """Return the factors across (x) and along (y and z) of the condyles."""
    return sizes.bicondylar_width / WIDTH, sizes.condylar_depth / DEPTH


def wheels(sizes: Sizes) -> Wheels:
    """Return the condyles, drawn from the lateral side to the medial one."""
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
    near = [(border + row[0] * across, row[1:]) for row in _FROM_BORDER]
    rows = [
        *((row[0] * across, row[1:]) for row in _LATERAL),
        *((-x, row) for x, row in near),
        (0.0, _AXLE[1:]),
        *((x, row) for x, row in reversed(near)),
        *((row[0] * across, row[1:]) for row in _MEDIAL),
    ]
    y0, z0 = (at * along for at in _AXIS)
    stations = []
    for x, row in rows:
        bottom, top, front, back = (along * value for value in row)
        stations.append(Station((x, y0, z0), (bottom - z0, top - z0), (y0 - back, y0 - front)))
    return Wheels(contour, stations)


def condyles(sizes: Sizes, cuts: Sequence[Cut]) -> tuple[GeneralizedCylinder, ...]:
    """Return the outside and the inside of the condyles."""
    outline, outside = wheels(sizes)
    inside = within(outside, WALL_MM)
    up = (0.0, 0.0, 1.0)
    return (
        swept("cortex of the condyles", outside, "cortical bone", outline, up=up, cuts=cuts),
        swept("spongiosa of the condyles", inside, "spongiosa", outline, up=up, cuts=cuts),
    )


def surface(sizes: Sizes) -> FloatArray:
    """Return points ``(N, 3)`` of the surface, as the engine's splines draw it, in mm."""
    import numpy as np
    from scipy.interpolate import CubicSpline

    contour, stations = wheels(sizes)
    closed = np.array([*contour, contour[0]])
    chords = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    section = CubicSpline(chords, closed, bc_type="periodic")(np.linspace(0, chords[-1], 400))
    points = [station.at for station in stations]
    u = np.linspace(0.0, 1.0, 140)
    at = CubicSpline(chord_lengths(points), np.array(points))(u)
    reach = CubicSpline(chord_lengths(points), np.array([(*s.x, *s.b) for s in stations]))(u)
    half = (reach[:, 1::2] - reach[:, ::2]) / 2.0
    middle = (reach[:, 1::2] + reach[:, ::2]) / 2.0
    found = middle[:, None, :] + half[:, None, :] * section[None]
    x = np.broadcast_to(at[:, None, 0], found.shape[:2])
    return np.stack(
        [x, at[:, None, 1] - found[..., 1], at[:, None, 2] + found[..., 0]], axis=-1
    ).reshape(-1, 3)
