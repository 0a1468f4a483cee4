"""Polynomials on [-1, 1]: Chebyshev-Lobatto interpolation and Bernstein form.

A polynomial stays inside the hull of its Bernstein coefficients (Farin, *Curves and Surfaces for
CAGD*, ch. 4), which turns ranges into a minimum and a maximum over a handful of numbers.
"""

from __future__ import annotations

from functools import cache
from math import comb

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

DEGREE = 6
"""Degree of every polynomial of a segment."""


@cache
def lobatto_nodes(degree: int = DEGREE) -> Floats:
    """Return the ``degree + 1`` Chebyshev-Lobatto nodes, increasing, both ends included."""
    nodes = -np.cos(np.pi * np.arange(degree + 1) / degree)
    return 0.5 * (nodes - nodes[::-1])


@cache
def interpolation_matrix(degree: int = DEGREE) -> Floats:
    """Return the matrix that maps values at the Lobatto nodes to monomial coefficients."""
    return np.asarray(
        np.linalg.inv(np.vander(lobatto_nodes(degree), increasing=True)), dtype=np.float64
    )


@cache
def bernstein_matrix(degree: int, start: float = -1.0, end: float = 1.0) -> Floats:
    """Return the matrix from monomial coefficients in tau to Bernstein ones on [start, end]."""
    size = degree + 1
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    # First substitute tau = middle - half + 2 half s with s in [0, 1] ...
    low, span = middle - half, 2.0 * half
    shift = np.zeros((size, size))
    for power in range(size):
        for k in range(power + 1):
            shift[k, power] = comb(power, k) * low ** (power - k) * span**k
    # ... then write the powers of s in the Bernstein basis.
    to_bernstein = np.zeros((size, size))
    for i in range(size):
        for k in range(i + 1):
            to_bernstein[i, k] = comb(i, k) / comb(degree, k)
    return to_bernstein @ shift


def derivative(coefficients: Floats) -> Floats:
    """Differentiate monomial coefficients along the last axis, keeping its length (a 0 on top)."""
    result = np.zeros_like(coefficients)
    powers = np.arange(1, coefficients.shape[-1])
    result[..., :-1] = coefficients[..., 1:] * powers
    return result


def evaluate(coefficients: Floats, tau: Floats) -> Floats:
    """Evaluate polynomials ``(..., degree + 1)`` at ``tau`` that broadcasts against ``...``."""
    value = np.broadcast_to(
        coefficients[..., -1], np.broadcast_shapes(coefficients.shape[:-1], tau.shape)
    ).copy()
    for power in range(coefficients.shape[-1] - 2, -1, -1):
        value = value * tau + coefficients[..., power]
    return value


def powers(tau: Floats, count: int) -> Floats:
    """Return ``1, tau, tau^2 ...``, ``(count, *tau.shape)``."""
    result = np.ones((count, *tau.shape))
    for power in range(1, count):
        result[power] = result[power - 1] * tau
    return result
