"""Which segments of a generalized cylinder may meet, though they lie apart along its axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.changing import ChangingTable
from phantom.compiled.segments import Segments
from phantom.compiled.tables import StarTable
from phantom.geometry.swept import Shape

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Table = StarTable | ChangingTable | None

_BATCH = 1000
_PARALLEL = 1e-14
"""Planes whose normals differ less meet far outside every solid."""


@dataclass(frozen=True)
class Traced:
    """One part of a cylinder as it is traced."""

    shape: Shape
    segments: Segments
    tables: tuple[Table, ...]


def meeting_pairs(parts: list[Traced]) -> tuple[Ints, Ints]:
    """Return pairs of segments that lie apart along u and whose boxes meet.

    Two arrays ``(n, 2)``: the part and the segment in it, of the one and of the other.
    """
    cut = [part.segments for part in parts]
    if all(_stacked(s) for s in cut):
        return np.empty((0, 2), dtype=np.intp), np.empty((0, 2), dtype=np.intp)
    where = np.concatenate(
        [
            np.stack([np.full(len(s.origins), p), np.arange(len(s.origins))], axis=-1)
            for p, s in enumerate(cut)
        ]
    ).astype(np.intp)
    axes = np.concatenate([s.axes for s in cut])
    boxes = np.concatenate([s.boxes for s in cut])
    middle = np.concatenate([s.origins for s in cut])
    middle = middle + np.einsum("nai,na->ni", axes, boxes.mean(axis=2))
    half = 0.5 * np.ptp(boxes, axis=2)
    radius = np.linalg.norm(half, axis=1)
    low = np.concatenate([s.knots[:-1] for s in cut])
    high = np.concatenate([s.knots[1:] for s in cut])
    i, j = _close(middle, 2 * float(radius.max()))
    span = high.max() - low.min()
    apart = (low[j] > high[i] + 1e-12 * span) | (low[i] > high[j] + 1e-12 * span)
    if parts[0].shape.curve.closed:
        around = (low[i] - low.min() + high.max() - high[j] <= 1e-12 * span) | (
            low[j] - low.min() + high.max() - high[i] <= 1e-12 * span
        )
        apart &= ~around
    apart &= np.linalg.norm(middle[i] - middle[j], axis=1) <= radius[i] + radius[j]
    i, j = i[apart], j[apart]
    met = _boxes_meet(axes[i], half[i], axes[j], half[j], middle[j] - middle[i])
    i, j = i[met], j[met]
    divided = _divided(parts, where[i], where[j]) | _divided(parts, where[j], where[i])
    return where[i[~divided]], where[j[~divided]]


def _stacked(segments: Segments) -> bool:
    """Whether parallel planes, each beyond the one before, divide all segments."""
    normals, levels = segments.planes[:, :3], segments.planes[:, 3]
    return bool(np.abs(normals - normals[0]).max() < _PARALLEL and (np.diff(levels) > 0).all())


def _close(points: Floats, distance: float) -> tuple[Ints, Ints]:
    """Return pairs of points no farther apart than this along the axis they spread most along."""
    along = points[:, int(np.argmax(np.ptp(points, axis=0)))]
    order = np.argsort(along)
    last = np.searchsorted(along[order], along[order] + distance, side="right")
    count = last - np.arange(len(points)) - 1
    first = np.repeat(np.arange(len(points)), count)
    second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    return order[first], order[second]


def _divided(parts: list[Traced], one: Ints, two: Ints) -> NDArray[np.bool_]:
    """Say of which pairs an end plane of the one divides them: its own body is on the inner side.

    Most segments that follow each other round a bend are told apart so.
    """
    found = np.zeros(len(one), dtype=bool)
    if not len(one):
        return found
    planes = np.zeros((len(one), 2, 4))
    for p, part in enumerate(parts):
        rows = np.flatnonzero(one[:, 0] == p)
        planes[rows] = part.segments.planes[one[rows, 1, None] + np.arange(2)]
    for q, part in enumerate(parts):
        mine = np.flatnonzero(two[:, 0] == q)
        if not len(mine):
            continue
        segments, index = np.unique(two[mine, 1], return_inverse=True)
        samples = _surfaces(part, segments)
        for start in range(0, len(mine), _BATCH):
            rows = mine[start : start + _BATCH]
            points = samples[index[start : start + _BATCH]]
            heights = points @ np.swapaxes(planes[rows, :, :3], 1, 2) - planes[rows, None, :, 3]
            lowest, highest = heights.min(axis=1), heights.max(axis=1)
            # What the surface may bulge beyond its samples.
            slack = 0.01 * (highest - lowest).max(axis=1)
            found[rows] = (highest[:, 0] < -slack) | (lowest[:, 1] > slack)
    return found


def _surfaces(traced: Traced, segments: Ints) -> Floats:
    """Points of the surfaces of segments, ``(S, P, 3)``."""
    knots = traced.segments.knots
    start, end = knots[segments], knots[segments + 1]
    u = (start[:, None] + np.linspace(0, 1, 5) * (end - start)[:, None]).ravel()
    placed = traced.shape.sections(u, np.repeat(traced.shape.pieces(knots)[segments], 5))
    phi = np.broadcast_to(points := traced.shape.points(u, 48), (len(u), *points.shape[1:]))
    found = placed.middle[:, None] + phi @ np.swapaxes(placed.spread, 1, 2)
    return np.asarray(found.reshape(len(segments), -1, 3))


def _boxes_meet(
    axes_i: Floats, half_i: Floats, axes_j: Floats, half_j: Floats, between: Floats
) -> NDArray[np.bool_]:
    """Separating axes of two boxes: their faces, then the products of their edges."""
    met = np.ones(len(between), dtype=bool)
    products = np.cross(axes_i[:, :, None], axes_j[:, None, :]).reshape(len(between), 9, 3)
    for directions in (axes_i, axes_j, products):
        reach = np.zeros(directions.shape[:2])
        for axes, half in ((axes_i, half_i), (axes_j, half_j)):
            reach = reach + np.einsum(
                "na,nka->nk", half, np.abs(np.einsum("nkx,nax->nka", directions, axes))
            )
        distance = np.abs(np.einsum("nkx,nx->nk", directions, between))
        met &= (distance <= reach + 1e-9).all(axis=1)
    return met
