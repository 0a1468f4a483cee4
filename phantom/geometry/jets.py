"""Arithmetic of truncated Taylor series: exact derivatives without symbols or differences.

A jet is an array ``(order + 1, ...)`` of the Taylor coefficients of a function along one variable
at many places. The recurrences are those of Griewank and Walther, *Evaluating Derivatives*, 2nd
ed., tables 13.1 and 13.2. Outside a function's domain they give NaN or infinity.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def product(a: Floats, b: Floats) -> Floats:
    """Return ``a * b``."""
    result = np.empty_like(a)
    for k in range(len(a)):
        result[k] = sum(a[j] * b[k - j] for j in range(k + 1))
    return result


def quotient(a: Floats, b: Floats) -> Floats:
    """Return ``a / b``."""
    result = np.empty_like(a)
    for k in range(len(a)):
        result[k] = (a[k] - sum(result[j] * b[k - j] for j in range(k))) / b[0]
    return result


def _grown(a: Floats, value: Floats, slope: Callable[[Floats, int], Floats]) -> Floats:
    """Integrate ``f' = slope * a'`` from a value; ``slope(f, k)`` is its coefficient k."""
    result = np.empty_like(a)
    result[0] = value
    for k in range(1, len(a)):
        result[k] = sum(j * a[j] * slope(result, k - j) for j in range(1, k + 1)) / k
    return result


def exp(a: Floats, value: Floats | None = None) -> Floats:
    """Return ``exp(a)``, from its value where that is known better."""
    return _grown(a, np.exp(a[0]) if value is None else value, lambda e, k: e[k])


def log(a: Floats) -> Floats:
    """Return ``log(a)``."""
    reciprocal = quotient(constant_like(a, 1.0), a)
    return _grown(a, np.log(a[0]), lambda _, k: reciprocal[k])


def sin_cos(a: Floats) -> tuple[Floats, Floats]:
    """Return ``sin(a)`` and ``cos(a)``."""
    sin, cos = np.empty_like(a), np.empty_like(a)
    sin[0], cos[0] = np.sin(a[0]), np.cos(a[0])
    for k in range(1, len(a)):
        sin[k] = sum(j * a[j] * cos[k - j] for j in range(1, k + 1)) / k
        cos[k] = -sum(j * a[j] * sin[k - j] for j in range(1, k + 1)) / k
    return sin, cos


def tan(a: Floats) -> Floats:
    """Return ``tan(a)`` by ``f' = (1 + f²) a'``."""

    def slope(f: Floats, k: int) -> Floats:
        square: Floats = np.asarray(sum(f[j] * f[k - j] for j in range(k + 1)))
        return square + 1.0 if k == 0 else square

    return _grown(a, np.tan(a[0]), slope)


def asin(a: Floats) -> Floats:
    """Return ``asin(a)``."""
    one = constant_like(a, 1.0)
    slope = quotient(one, sqrt(product(one - a, one + a)))
    return _grown(a, np.arcsin(a[0]), lambda _, k: slope[k])


def acos(a: Floats) -> Floats:
    """Return ``acos(a)``."""
    result = -asin(a)
    result[0] = np.arccos(a[0])
    return result


def atan2(y: Floats, x: Floats) -> Floats:
    """Return ``atan2(y, x)``."""
    square = product(x, x) + product(y, y)
    along, across = quotient(x, square), quotient(y, square)
    result = _grown(y, np.arctan2(y[0], x[0]), lambda _, k: along[k])
    result[1:] -= _grown(x, x[0], lambda _, k: across[k])[1:]
    return result


def sqrt(a: Floats, value: Floats | None = None) -> Floats:
    """Return ``sqrt(a)``, from its value where that is known better."""
    result = np.empty_like(a)
    result[0] = np.sqrt(a[0]) if value is None else value
    for k in range(1, len(a)):
        inner = sum(result[j] * result[k - j] for j in range(1, k))
        result[k] = (a[k] - inner) / (2 * result[0])
    return result


def hypot(*sides: Floats) -> Floats:
    """Return the length of a vector."""
    value = sides[0][0]
    for side in sides[1:]:
        value = np.hypot(value, side[0])
    return sqrt(np.sum([product(side, side) for side in sides], axis=0), value)


def power(a: Floats, exponent: Floats) -> Floats:
    """Return ``a ** exponent`` for an exponent that does not vary; whole ones take any base."""
    # The binomial series about a[0]; a falling factorial of 0 ends it, also at a base of 0.
    rest = a.copy()
    rest[0] = 0.0
    result = constant_like(a, _raised(a[0], exponent))
    falling, powers = np.ones_like(exponent), constant_like(a, 1.0)
    for m in range(1, len(a)):
        falling = falling * (exponent - (m - 1)) / m
        powers = product(powers, rest)
        term = np.where(falling == 0, 0.0, falling * np.power(a[0], exponent - m))
        result[m:] += term * powers[m:]  # below m the powers are 0, and the term may be infinite
    return result


def _raised(base: Floats, exponent: Floats) -> Floats:
    """Return ``base ** exponent``; small whole powers by products, many times as fast."""
    whole = float(exponent.flat[0]) if exponent.size else 0.0
    if whole in (2.0, 3.0, 4.0) and bool(np.all(exponent == whole)):
        square = base * base
        return square if whole == 2 else square * (base if whole == 3 else square)
    return np.asarray(np.power(base, exponent))


def general_power(a: Floats, b: Floats) -> Floats:
    """Return ``a ** b`` for a varying exponent: ``exp(b log a)``."""
    return exp(product(b, log(a)), np.power(a[0], b[0]))


def leading(a: Floats) -> Floats:
    """Return the first coefficient that is not 0: its sign is that of ``a`` just to the right."""
    result = a[0]
    for coefficient in a[1:]:
        result = np.where(result == 0, coefficient, result)
    return np.asarray(result)


def constant_like(a: Floats, value: float | Floats) -> Floats:
    """Return the jet of a constant, of the shape of ``a``."""
    result = np.zeros_like(a)
    result[0] = value
    return result
