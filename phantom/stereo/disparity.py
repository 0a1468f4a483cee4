"""How far apart the two eyes see each structure, along a row.

The disparity of a point is its column in the left eye's picture less its column in the right one's:
positive, or crossed, nearer than the plane of the screen. A ray crosses many structures, so a pixel
has many disparities; each structure has a range, that of the box around it.

A column is the same along the picture's vertical, so that a box's extremes lie on its outline as
seen along it: the gradients of two such columns agree only on the line through both eyes. Along a
straight line c = (a + b t) / (d + e t), and the difference of two such has its extremes at the ends
and at one place between, where its derivative is 0. So the twelve edges of a box have the extremes.
"""

from __future__ import annotations

import math
from collections.abc import Container, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.vectors import box_corners
from phantom.stereo.screen import Screen

if TYPE_CHECKING:
    from phantom.scene import Phantom

Floats = NDArray[np.float64]

_EDGES: Final = np.array(
    [(i, i | 1 << axis) for axis in range(3) for i in range(8) if not i >> axis & 1]
)
"""(12, 2) corners at the ends of each edge of a box, as :func:`box_corners` numbers them."""

NEAREST_DEPTH_MM: Final = 1e-3
"""What is nearer to an eye than this, or behind it, has no place in its picture."""


class Structure(NamedTuple):
    """Something with a place: a leaf, a finding or a landmark.

    Attributes
    ----------
    kind
        ``leaf``, ``finding`` or ``landmark``.
    name
        The leaf's label, or the finding's or landmark's name.
    boxes_mm
        (B, 2, 3) boxes around its parts; those of a landmark have no size.
    """

    kind: str
    name: str
    boxes_mm: Floats


@dataclass(frozen=True, slots=True)
class Disparity:
    """The disparity of a structure; None where part of it lies beside or behind an eye.

    Attributes
    ----------
    kind, name
        Of the structure.
    pixels
        Least and greatest, along a row; positive is crossed, nearer than the screen.
    degrees
        The same on the screen that was told.
    vertical_px
        Greatest difference of the rows; 0 but for rounding where the tube is shifted.
    """

    kind: str
    name: str
    pixels: tuple[float, float] | None
    degrees: tuple[float, float] | None
    vertical_px: float | None

    @property
    def worst_deg(self) -> float:
        """The greatest on either side of the screen; infinite where there is none."""
        return math.inf if self.degrees is None else max(map(abs, self.degrees))

    def told(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        return {
            "kind": self.kind,
            "name": self.name,
            "pixels": None if self.pixels is None else list(self.pixels),
            "degrees": None if self.degrees is None else list(self.degrees),
            "vertical_px": self.vertical_px,
        }


def surfacing_boxes(phantom: Phantom, shown: Container[int] | None = None) -> dict[int, Floats]:
    """Return the (2, 3) box of every leaf that can surface, inside the box of the whole.

    ``shown`` has the numbers of the leaves that count; by default all do.
    """
    least, greatest = np.asarray(phantom.bounds, dtype=np.float64)
    found = {}
    for leaf in phantom.surfacing_leaves:
        if shown is not None and leaf not in shown:
            continue
        low, high = np.asarray(phantom.leaf_bounds[leaf], dtype=np.float64)
        low, high = np.maximum(low, least), np.minimum(high, greatest)
        if np.all(low <= high):
            found[leaf] = np.stack([low, high])
    return found


def structures(phantom: Phantom, shown: Container[int] | None = None) -> tuple[Structure, ...]:
    """Return the named leaves, the findings and the landmarks of a phantom, in this order.

    A finding is where its leaves are; without any in the solid it is its centre, and without that
    it is left out. ``shown`` has the numbers of the leaves that count; by default all do.
    """
    boxes = surfacing_boxes(phantom, shown)
    named = [leaf for leaf in phantom.named_leaves if leaf in boxes]
    found = [Structure("leaf", phantom.leaf_names[i], boxes[i][np.newaxis]) for i in named]
    for finding in phantom.document.findings:
        parts = [boxes[i] for i in named if phantom.leaf_names[i] in finding.leaves]
        if not parts and finding.center is not None:
            parts = [np.array([finding.center, finding.center], dtype=np.float64)]
        if parts:
            found.append(Structure("finding", finding.name, np.stack(parts)))
    for name, point in phantom.document.landmarks.items():
        place = np.array([[point, point]], dtype=np.float64)
        found.append(Structure("landmark", name, place))
    return tuple(found)


def disparities(
    wanted: Sequence[Structure], left: Floats, right: Floats, screen: Screen
) -> tuple[Disparity, ...]:
    """Return the disparity of each structure.

    Parameters
    ----------
    wanted
        Structures in the world.
    left, right
        (3, 4) projection matrices of the two eyes' pictures.
    screen
        Where they are shown.
    """
    found = []
    for structure in wanted:
        across = differences(structure.boxes_mm, left, right, axis=0)
        down = differences(structure.boxes_mm, left, right, axis=1)
        if across is None or down is None:
            found.append(Disparity(structure.kind, structure.name, None, None, None))
            continue
        low, high = (float(screen.degrees(value)) for value in across)
        vertical = max(abs(down[0]), abs(down[1]))
        found.append(
            Disparity(structure.kind, structure.name, across, (low, high), float(vertical))
        )
    return tuple(found)


def disparity_of_all(
    phantom: Phantom,
    left: Floats,
    right: Floats,
    screen: Screen,
    shown: Container[int] | None = None,
) -> Disparity:
    """Return the disparity of everything that can be seen, named or not."""
    boxes = [*surfacing_boxes(phantom, shown).values()] or [np.asarray(phantom.bounds)]
    whole = Structure("whole", "", np.stack(boxes))
    return disparities([whole], left, right, screen)[0]


def differences(
    boxes_mm: Floats, left: Floats, right: Floats, *, axis: int
) -> tuple[float, float] | None:
    """Return the least and greatest difference, left less right, of columns or rows of boxes.

    Parameters
    ----------
    boxes_mm
        (B, 2, 3).
    left, right
        (3, 4) projection matrices.
    axis
        0 for columns, 1 for rows.

    Returns
    -------
    tuple or None
        In pixels; None where a corner lies at or behind an eye.
    """
    corners = np.stack([box_corners(box) for box in boxes_mm])
    corners = np.concatenate([corners, np.ones((*corners.shape[:2], 1))], axis=-1)
    over, under = [], []
    for matrix in (left, right):
        depth = corners @ matrix[2]
        if float(depth.min()) < NEAREST_DEPTH_MM:
            return None
        over.append(corners @ matrix[axis])
        under.append(depth)
    values = over[0] / under[0] - over[1] / under[1]
    ends = [(part[:, _EDGES[:, 0]], part[:, _EDGES[:, 1]]) for part in (*over, *under)]
    (a, c, d, e) = ends
    bends = [_bend(a, d), _bend(c, e)]
    with np.errstate(invalid="ignore", divide="ignore"):
        # b1/(d0 + d1 t)² = b2/(e0 + e1 t)², with both denominators above 0.
        roots = [np.sqrt(bend) for bend in _same_sign(*bends)]
        share = (roots[1] * d[0] - roots[0] * e[0]) / (
            roots[0] * (e[1] - e[0]) - roots[1] * (d[1] - d[0])
        )
    share = np.where(np.isfinite(share), np.clip(share, 0.0, 1.0), 0.0)
    between = _at(a, share) / _at(d, share) - _at(c, share) / _at(e, share)
    return (
        float(min(values.min(), between.min())),
        float(max(values.max(), between.max())),
    )


_Ends = tuple[Floats, Floats]
"""A number at both ends of every edge, between which it is linear."""


def _bend(over: _Ends, under: _Ends) -> Floats:
    """Return the numerator of the derivative of over / under."""
    return (over[1] - over[0]) * under[0] - over[0] * (under[1] - under[0])


def _same_sign(one: Floats, other: Floats) -> tuple[Floats, Floats]:
    """Return sizes where both have the same sign, nan where the derivative cannot vanish."""
    same = one * other > 0
    return np.where(same, np.abs(one), np.nan), np.where(same, np.abs(other), np.nan)


def _at(ends: _Ends, share: Floats) -> Floats:
    found: Floats = ends[0] + share * (ends[1] - ends[0])
    return found
