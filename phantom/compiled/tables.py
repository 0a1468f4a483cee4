"""The gauge of a star-shaped contour as a table over the pseudo-angle.

The pseudo-angle T is that of :mod:`phantom.geometry.star`. Each cell holds a quintic in its own
local coordinate that meets g, g' and g'' at both ends (Hermite), so the table is C2 wherever the
contour is; cells are halved until the radius is right everywhere they are checked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.outlines import Outline
from phantom.geometry.polynomials import bernstein_matrix, derivative, evaluate
from phantom.geometry.refusal import RefusalError
from phantom.geometry.star import gauge, kinks, monotone_cells

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

MAX_CELLS = 20000
_CHECKS = np.array([-0.9, -0.6, -0.25, 0.1, 0.45, 0.75, 0.95])


@dataclass(frozen=True)
class StarTable:
    """g(T) of :func:`phantom.geometry.star.gauge`: the contour is ``X^2 g = 1``."""

    edges: Floats  # (cells + 1,) in T, from 0 to 8
    cells: Floats  # (cells, 6) powers of the local coordinate in [-1, 1]
    kinks: Floats  # (k, 3) T of each corner, the jump of h's slope there up and down


def star_table(outline: Outline, tolerance: float) -> StarTable:
    """Tabulate an outline so that its radius is right to ``tolerance`` (unit coordinates).

    Raises
    ------
    RefusalError
        At ``/contour``, where more than :data:`MAX_CELLS` cells would be needed.
    """
    starts, ends, owner = monotone_cells(outline)
    done: list[tuple[Floats, Floats]] = []
    total = 0
    for _ in range(40):
        cells, error = _hermite(outline, starts, ends, owner)
        good = error <= tolerance
        done.append((starts[good], cells[good]))
        total += int(good.sum())
        if good.all():
            break
        starts, ends, owner = starts[~good], ends[~good], owner[~good]
        middle = 0.5 * (starts + ends)
        starts, ends = np.concatenate([starts, middle]), np.concatenate([middle, ends])
        owner = np.concatenate([owner, owner])
        if total + len(starts) > MAX_CELLS:
            break
    else:
        good = np.zeros(1, dtype=bool)
    if not good.all():
        raise RefusalError(
            "/contour",
            "contour_detail",
            f"the contour is too sharp: {MAX_CELLS} cells leave {float(error.max()):.3g} of its "
            f"radius; expected at most {tolerance:.3g}",
        )
    low = np.concatenate([d[0] for d in done])
    order = np.argsort(low)
    cells = np.concatenate([d[1] for d in done])[order]
    at, jump = kinks(outline).T
    corners = np.stack([at, np.maximum(jump, 0.0), np.maximum(-jump, 0.0)], axis=-1)
    return StarTable(np.append(low[order], 8.0), cells, corners)


def _hermite_matrix() -> Floats:
    """Map (f, f', f'' at -1, then at 1) to the coefficients of the quintic."""
    rows = []
    for s in (-1.0, 1.0):
        powers = s ** np.arange(6)
        first = np.array([k * s ** (k - 1) if k else 0.0 for k in range(6)])
        second = np.array([k * (k - 1) * s ** (k - 2) if k > 1 else 0.0 for k in range(6)])
        rows += [powers, first, second]
    return np.linalg.inv(np.array(rows))


_HERMITE = _hermite_matrix()


def _hermite(outline: Outline, starts: Floats, ends: Floats, owner: Ints) -> tuple[Floats, Floats]:
    """Fit quintics to cells; return them and their errors of radius."""
    half = 0.5 * (ends - starts)
    # Ends are taken a hair inside, so that they fall into this cell's chart.
    data = []
    for T in (starts, ends):
        inside = np.clip(T, starts, np.nextafter(ends, starts))
        g, g1, g2 = gauge(outline, inside, owner)
        data += [g, g1 * half, g2 * half**2]
    cells = np.stack(data, axis=-1) @ _HERMITE.T
    checks = (0.5 * (starts + ends))[:, None] + half[:, None] * _CHECKS
    flat = np.repeat(owner, len(_CHECKS))
    truth = gauge(outline, checks.ravel(), flat)[0].reshape(checks.shape)
    # h = X^2 g - 1 has slope 2 / r across the contour: an error of g moves it by r X^2 / 2 of it.
    t = checks - 2.0 * np.minimum(checks // 2, 3) - 1.0
    radius = np.sqrt((1 + t**2) / truth)
    error = 0.5 * radius * np.abs(evaluate(cells[:, None, :], _CHECKS) - truth) / truth
    return cells, error.max(axis=1)


def derivative_ranges(table: StarTable) -> tuple[Floats, Floats, Floats]:
    """Bounds ``(cells, 2)`` of g, g' and g'' over each cell, from Bernstein coefficients."""
    half = (0.5 * np.diff(table.edges))[:, None]
    ranges = []
    coefficients = table.cells
    for order in range(3):
        control = coefficients @ bernstein_matrix(5).T / half**order
        ranges.append(np.stack([control.min(axis=1), control.max(axis=1)], axis=-1))
        coefficients = derivative(coefficients)
    return ranges[0], ranges[1], ranges[2]
