"""Bounds of the second derivatives of G(x) = h(phi(x, tau(x))) over a segment, by intervals.

With ``F = N.x - c`` and ``J = -dF/dtau``, differentiating the implicit tau twice gives

    grad phi_i = M_i + s_i N,                         s_i = (M_i'.x - m_i') / J
    Hess phi_i = (V_i N^T + N V_i^T + b_i N N^T / J) / J
                 V_i = M_i' + s_i N',   b_i = M_i''.x - m_i'' - s_i (c'' - N''.x)
    Hess G     = sum h_ij grad phi_i grad phi_j^T + sum h_i Hess phi_i

Every term is bounded over small cells of (tau, two box coordinates); the third coordinate follows
from the section plane. The polynomials are the traced ones, so the bounds hold for the surface that
is traced, not for an ideal one.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.changing import ChangingSection
from phantom.compiled.intervals import Interval, dot
from phantom.compiled.layout import CELLS
from phantom.compiled.sections import Section, SectionBounds
from phantom.compiled.segments import Segments
from phantom.geometry.polynomials import DEGREE, bernstein_matrix, derivative

Floats = NDArray[np.float64]

_TAU_CELLS = 4
_WIDEN = 1e-9
_BATCH = 64

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Entries of the Hessian along the box axes e1, e2, t, in stored order."""


@dataclass(frozen=True)
class Bounds:
    """What bounds the second derivative of G along any ray, by cell of a segment's box.

    A cell holds for all points of the segment whose coordinates along e1 and e2 lie in it.
    """

    hessians: Floats  # (K, CELLS, CELLS, 6, 2) entries along the box axes, per mm^2
    kinks: Floats  # (K, CELLS, CELLS, 3) jumps of the slope per mm: up, down; and 1/mm

    def scaled(self, scale: float) -> Bounds:
        """Return the bounds of a solid ``scale`` times as large."""
        return Bounds(self.hessians / scale**2, self.kinks / scale)


def hessian_bounds(segments: Segments, section: Section | list[ChangingSection]) -> Bounds:
    """Bound a part's segments; a contour that changes along them has a section for each.

    A ray crosses the ray of a corner once or, where its image in the contour plane bends, more
    often; then by Rolle each crossing is slower than the bend times the way to the next. The jumps
    of the slope over a length s therefore stay below ``kinks[..., :2] max(1, kinks[..., 2] s)``.
    """
    count = len(segments.origins)
    result = Bounds(np.empty((count, CELLS, CELLS, 6, 2)), np.zeros((count, CELLS, CELLS, 3)))
    step = 1 if isinstance(section, list) else _BATCH
    for first in range(0, count, step):
        chosen = slice(first, min(first + step, count))
        one = section[first] if isinstance(section, list) else section
        _batch(segments, one, chosen, result)
    return result


def _batch(
    segments: Segments, section: Section | ChangingSection, chosen: slice, result: Bounds
) -> None:
    polynomials = segments.polynomials[chosen]
    axes, boxes = segments.axes[chosen], segments.boxes[chosen]
    local = polynomials.copy()
    for row in (0, 4, 8):
        local[:, row : row + 3] = np.einsum("kai,kip->kap", axes, polynomials[:, row : row + 3])
    orders = [local, derivative(local), derivative(derivative(local))]
    ranges = [_tau_ranges(p) for p in orders]

    def vector(order: int, row: int) -> list[Interval]:
        return [_pick(ranges[order], row + j) for j in range(3)]

    def scalar(order: int, row: int) -> Interval:
        return _pick(ranges[order], row)

    n0, n1, n2 = (vector(order, 0) for order in range(3))
    x = _points(n0, scalar(0, 3), boxes)
    j = scalar(1, 3) - dot(n1, x)
    j = Interval(np.maximum(j.low, segments.j_min), np.maximum(j.high, segments.j_min))
    over_j = j.reciprocal()
    bend = scalar(2, 3) - dot(n2, x)
    phi, gradients, hessians = [], [], []
    for row in (4, 8):
        m0, m1, m2 = (vector(order, row) for order in range(3))
        phi.append(dot(m0, x) - scalar(0, row + 3))
        slope = (dot(m1, x) - scalar(1, row + 3)) * over_j
        gradients.append([m0[a] + slope * n0[a] for a in range(3)])
        v = [m1[a] + slope * n1[a] for a in range(3)]
        b = (dot(m2, x) - scalar(2, row + 3) - slope * bend) * over_j
        mixed = [v[a] * n0[a] * 2.0 if a == c else v[a] * n0[c] + v[c] * n0[a] for a, c in PAIRS]
        hessians.append(
            [(mixed[k] + b * (n0[a] * n0[c])) * over_j for k, (a, c) in enumerate(PAIRS)]
        )
    h = section.over(phi[0], phi[1])
    # A circle's h_xy is 0.
    skew = bool(np.any(h.hessian[1].low) or np.any(h.hessian[1].high))
    g = gradients
    bounds = result.hessians[chosen]
    for index, (a, c) in enumerate(PAIRS):
        entry = h.hessian[0] * (g[0][a].squared() if a == c else g[0][a] * g[0][c])
        if skew and a == c:
            entry = entry + h.hessian[1] * (g[0][a] * g[1][a]) * 2.0
        elif skew:
            entry = entry + h.hessian[1] * (g[0][a] * g[1][c] + g[0][c] * g[1][a])
        entry = entry + h.hessian[2] * (g[1][a].squared() if a == c else g[1][a] * g[1][c])
        entry = entry + h.gradient[0] * hessians[0][index] + h.gradient[1] * hessians[1][index]
        if h.along is not None:
            # tau(x) has gradient N / J, and its Hessian comes from J tau' = N.d once more.
            h_t, h_xt, h_yt, h_tt = h.along
            t_a, t_c = n0[a] * over_j, n0[c] * over_j
            turn = (n1[a] * n0[c] + n1[c] * n0[a]) * over_j.squared()
            turn = turn - bend * (n0[a] * n0[c]) * (over_j.squared() * over_j)
            entry = (
                entry
                + h_xt * (g[0][a] * t_c + g[0][c] * t_a)
                + h_yt * (g[1][a] * t_c + g[1][c] * t_a)
                + h_tt * (t_a * t_c)
                + h_t * turn
            )
        bounds[..., index, 0] = entry.low.min(axis=1)
        bounds[..., index, 1] = entry.high.max(axis=1)
    slack = _WIDEN * np.abs(bounds).max(axis=(-2, -1))[..., None]
    bounds[..., 0] -= slack
    bounds[..., 1] += slack
    if np.ndim(h.up) or np.ndim(h.down):
        result.kinks[chosen] = _kinks(h, g, hessians)


def _kinks(
    h: SectionBounds, gradients: list[list[Interval]], hessians: list[list[Interval]]
) -> Floats:
    """Jumps of the slope, from the speed and the bend of the ray's image in the contour plane."""
    speed2: Floats | float = 0.0
    bend2: Floats | float = 0.0
    for gradient, hessian in zip(gradients, hessians, strict=True):
        for entry in gradient:
            speed2 = speed2 + entry.squared().high
        for index, entry in enumerate(hessian):
            bend2 = bend2 + (1.0 if index < 3 else 2.0) * entry.squared().high
    speed, bend = np.sqrt(speed2), np.sqrt(bend2)
    up = (h.up * speed * np.ones_like(bend)).max(axis=1)
    down = (h.down * speed * np.ones_like(bend)).max(axis=1)
    growth = (2.0 * bend / speed).max(axis=1)
    return np.stack(np.broadcast_arrays(up, down, growth), axis=-1) * (1 + _WIDEN)


def _tau_ranges(polynomials: Floats) -> tuple[Floats, Floats]:
    """Ranges over the cells of tau: two arrays (K, cells, 12)."""
    edges = np.linspace(-1, 1, _TAU_CELLS + 1)
    low, high = [], []
    for a, b in itertools.pairwise(edges):
        control = polynomials @ bernstein_matrix(DEGREE, float(a), float(b)).T
        low.append(control.min(axis=-1))
        high.append(control.max(axis=-1))
    return np.stack(low, axis=1), np.stack(high, axis=1)


def _pick(ranges: tuple[Floats, Floats], row: int) -> Interval:
    return Interval(ranges[0][:, :, row, None, None], ranges[1][:, :, row, None, None])


def _points(normal: list[Interval], level: Interval, boxes: Floats) -> list[Interval]:
    """Cells of x along e1, e2 and t; x_t is what the section plane leaves of the box."""
    fractions = np.linspace(0, 1, CELLS + 1)
    edges = boxes[:, :2, :1] + fractions * (boxes[:, :2, 1:] - boxes[:, :2, :1])
    first = Interval(edges[:, 0, None, :-1, None], edges[:, 0, None, 1:, None])
    second = Interval(edges[:, 1, None, None, :-1], edges[:, 1, None, None, 1:])
    low, high = (boxes[:, 2, k][:, None, None, None] for k in (0, 1))
    upright = normal[2].low > 0
    safe = Interval(np.where(upright, normal[2].low, 1.0), np.where(upright, normal[2].high, 1.0))
    along = (level - normal[0] * first - normal[1] * second) * safe.reciprocal()
    third = Interval(
        np.where(upright, np.clip(along.low, low, high), low),
        np.where(upright, np.clip(along.high, low, high), high),
    )
    return [first, second, third]
