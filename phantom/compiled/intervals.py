"""Interval arithmetic on arrays: enough of it to bound polynomials and their quotients.

Bounds are the exact ones of real arithmetic up to the rounding of each operation; whoever uses the
final bound widens it once by far more than that rounding (see :mod:`phantom.compiled.hessians`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Interval:
    """All numbers from ``low`` to ``high``, elementwise."""

    low: Floats
    high: Floats

    def __add__(self, other: Interval | float) -> Interval:
        other = as_interval(other)
        return Interval(self.low + other.low, self.high + other.high)

    __radd__ = __add__

    def __neg__(self) -> Interval:
        return Interval(-self.high, -self.low)

    def __sub__(self, other: Interval | float) -> Interval:
        other = as_interval(other)
        return Interval(self.low - other.high, self.high - other.low)

    def __rsub__(self, other: float) -> Interval:
        return as_interval(other) - self

    def __mul__(self, other: Interval | float | Floats) -> Interval:
        if not isinstance(other, Interval):
            a, b = self.low * other, self.high * other
            return Interval(np.minimum(a, b), np.maximum(a, b))
        if self.low is self.high:
            return other * self.low
        if other.low is other.high:
            return self * other.low
        a, b = np.asarray(self.low * other.low), self.low * other.high
        low, high = np.asarray(np.minimum(a, b)), np.maximum(a, b, out=a)
        for product in (self.high * other.low, self.high * other.high):
            np.minimum(low, product, out=low)
            np.maximum(high, product, out=high)
        return Interval(low, high)

    __rmul__ = __mul__

    def squared(self) -> Interval:
        """Return the interval of squares, never below 0."""
        a, b = self.low**2, self.high**2
        straddles = (self.low <= 0) & (self.high >= 0)
        return Interval(np.where(straddles, 0.0, np.minimum(a, b)), np.maximum(a, b))

    def reciprocal(self) -> Interval:
        """Return 1/x for intervals that keep to one side of 0."""
        return Interval(1 / self.high, 1 / self.low)

    def clipped(self, low: Floats | float, high: Floats | float) -> Interval:
        """Return the part within [low, high]; empty parts collapse to the nearer limit."""
        return Interval(np.clip(self.low, low, high), np.clip(self.high, low, high))

    def hull(self, other: Interval) -> Interval:
        """Return the smallest interval that holds both."""
        return Interval(np.minimum(self.low, other.low), np.maximum(self.high, other.high))


def as_interval(value: Interval | float | Floats) -> Interval:
    """Read a number as an interval of no width."""
    if isinstance(value, Interval):
        return value
    array = np.asarray(value, dtype=np.float64)
    return Interval(array, array)


def dot(a: list[Interval], b: list[Interval]) -> Interval:
    """Return the sum of products of two vectors of intervals."""
    total = a[0] * b[0]
    for x, y in zip(a[1:], b[1:], strict=True):
        total = total + x * y
    return total
