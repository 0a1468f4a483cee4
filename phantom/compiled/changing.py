"""Contours that change along a segment, as tensors over the pseudo-angle and tau."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.intervals import Interval
from phantom.compiled.sections import HessianGrid, SectionBounds, kink_bounds
from phantom.geometry.polynomials import (
    DEGREE,
    bernstein_matrix,
    derivative,
    interpolation_matrix,
    lobatto_nodes,
)
from phantom.geometry.refusal import RefusalError
from phantom.geometry.swept import ChangingShape

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_T_DEGREE = 5
_CHECKS_T = np.array([-0.93, -0.7, -0.35, 0.1, 0.5, 0.8, 0.96])
_CHECKS_TAU = np.array([-0.97, -0.75, -0.4, 0.05, 0.45, 0.8, 0.98])
MAX_CELLS = 200000


@dataclass(frozen=True)
class ChangingTable:
    """g(T, tau) of one segment: the contour is ``X^2 g = 1`` on each chart."""

    edges: Floats  # (cells + 1,) in T, from 0 to 8
    cells: Floats  # (cells, 6, 7) powers of the local coordinate and of tau
    kinks: Floats  # (k, 3) T of each corner, largest jump of h's slope up and down


def changing_tables(shape: ChangingShape, knots: Floats, tolerance: float) -> list[ChangingTable]:
    """Tabulate every segment so that the radius is right to ``tolerance`` (unit coordinates).

    Raises
    ------
    RefusalError
        At ``/sweep``, where more than :data:`MAX_CELLS` cells would be needed.
    """
    marks = shape.changing.marks
    count = len(knots) - 1
    low, high = np.tile(marks[:-1], count), np.tile(marks[1:], count)
    segment = np.repeat(np.arange(count), len(marks) - 1)
    start, end = knots[:-1, None], knots[1:, None]
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    nodes = np.clip(middle + half * lobatto_nodes(), start, end)
    checks = middle + half * _CHECKS_TAU
    powers = np.vander(_CHECKS_T, _T_DEGREE + 1, increasing=True)
    tau_powers = np.vander(_CHECKS_TAU, DEGREE + 1, increasing=True)
    done: list[tuple[Ints, Floats, Floats]] = []
    total = 0
    for _ in range(40):
        width = 0.5 * (high - low)
        at = (0.5 * (low + high))[:, None] + width[:, None] * lobatto_nodes(_T_DEGREE)
        values = _gauge(shape, at, nodes[segment])
        cells = interpolation_matrix(_T_DEGREE) @ values @ interpolation_matrix().T
        at = (0.5 * (low + high))[:, None] + width[:, None] * _CHECKS_T
        truth = _gauge(shape, at, checks[segment])
        found = powers @ cells @ tau_powers.T
        t = at - 2.0 * np.minimum(at // 2, 3) - 1.0
        radius = np.sqrt((1 + t[..., None] ** 2) / truth)
        error = (0.5 * radius * np.abs(found - truth) / truth).max(axis=(1, 2))
        good = error <= tolerance
        done.append((segment[good], low[good], cells[good]))
        total += int(good.sum())
        if good.all():
            break
        segment, low, high = segment[~good], low[~good], high[~good]
        if total + 2 * len(low) > MAX_CELLS:
            worst = segment[int(np.argmax(error[~good]))]
            raise RefusalError(
                "/sweep",
                "contour_detail",
                f"the section changes too sharply at u = {knots[worst]:.6g} to "
                f"{knots[worst + 1]:.6g}: {MAX_CELLS} cells leave {float(error.max()):.3g} of its "
                f"radius; expected {tolerance:.3g}",
            )
        middles = 0.5 * (low + high)
        low, high = np.concatenate([low, middles]), np.concatenate([middles, high])
        segment = np.concatenate([segment, segment])
    owner = np.concatenate([d[0] for d in done])
    starts = np.concatenate([d[1] for d in done])
    order = np.lexsort((starts, owner))
    cells = np.concatenate([d[2] for d in done])[order]
    first = np.searchsorted(owner[order], np.arange(count + 1))
    return [
        ChangingTable(
            np.append(starts[order][a:b], 8.0),
            np.ascontiguousarray(cells[a:b]),
            _kinks(shape, *knots[k : k + 2]),
        )
        for k, (a, b) in enumerate(itertools.pairwise(first))
    ]


def _kinks(shape: ChangingShape, start: float, end: float) -> Floats:
    """Largest jumps of h's slope at the corners over a segment, ``(k, 3)``."""
    corners, jumps = shape.changing.corners(np.linspace(start, end, 9))
    jumps = jumps * shape.unit**2
    # Smooth between the samples; a tenth more covers what they may miss.
    return np.stack(
        [
            corners,
            1.1 * np.maximum(jumps.max(axis=1, initial=0.0), 0.0),
            1.1 * np.maximum(-jumps.min(axis=1, initial=0.0), 0.0),
        ],
        axis=-1,
    )


def _gauge(shape: ChangingShape, T: Floats, u: Floats) -> Floats:
    """Return g ``(cells, T, u)`` at pseudo-angles (cells, T) and parameters (cells, u)."""
    inside = np.clip(T, np.min(T, axis=1, keepdims=True), np.nextafter(T[:, -1:], T[:, :1]))
    t = inside - 2.0 * np.minimum(inside // 2, 3) - 1.0
    radius = shape.changing.radii(inside, u) / shape.unit
    return np.asarray((1 + t[..., None] ** 2) / radius**2)


class ChangingSection:
    """h of a contour that changes along a segment, from bounds on a grid of squares."""

    def __init__(self, table: ChangingTable) -> None:
        rate = derivative(table.cells)
        self._grids = [
            HessianGrid(table.edges, _ranges(table.edges, cells))
            for cells in (table.cells, rate, derivative(rate))
        ]
        self._kinks = table.kinks

    def over(self, x: Interval, y: Interval) -> SectionBounds:
        """Take the hull of the squares that each rectangle touches, for all tau at once."""
        hessian, gradient, _ = self._grids[0].over(x, y)
        _, cross, along = self._grids[1].over(x, y)
        _, _, twice = self._grids[2].over(x, y)
        up, down = kink_bounds(self._kinks, x, y)
        return SectionBounds(gradient, hessian, (along, *cross, twice), up, down)


def _ranges(edges: Floats, cells: Floats) -> tuple[Floats, Floats, Floats]:
    """Bounds ``(cells, 2)`` of a tensor and its first two derivatives by T, over each cell."""
    half = (0.5 * np.diff(edges))[:, None, None]
    found = []
    powers = np.swapaxes(cells, 1, 2)
    for order in range(3):
        control = powers @ bernstein_matrix(_T_DEGREE).T / half**order
        control = np.einsum("bq,cqp->cbp", bernstein_matrix(DEGREE), control)
        found.append(np.stack([control.min(axis=(1, 2)), control.max(axis=(1, 2))], axis=-1))
        powers = derivative(powers)
    return found[0], found[1], found[2]
