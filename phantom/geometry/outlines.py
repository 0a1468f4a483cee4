"""Closed plane curves as smooth pieces with their first two derivatives.

An outline runs anticlockwise about the origin of its own *unit* coordinates; ``place`` maps unit
coordinates to the contour plane, ``p = matrix @ unit + center``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.splines import Cubics

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


class Outline(Protocol):
    """A closed curve over ``[breaks[0], breaks[-1]]``, smooth between breaks."""

    @property
    def breaks(self) -> Floats:
        """Parameters v where a derivative may jump, both ends included."""

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Return ``(3, n, 2)``: position, first and second derivative by v."""


@dataclass(frozen=True)
class SplineOutline:
    """A periodic piecewise cubic in the plane."""

    spline: Cubics

    @property
    def breaks(self) -> Floats:
        """The spline's knots."""
        return np.asarray(self.spline.x, dtype=np.float64)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Evaluate the named cubics."""
        c = self.spline.c[:, piece]
        s = (v - self.breaks[piece])[:, None]
        return np.stack(
            [
                ((c[0] * s + c[1]) * s + c[2]) * s + c[3],
                (3 * c[0] * s + 2 * c[1]) * s + c[2],
                6 * c[0] * s + 2 * c[1],
            ]
        )


@dataclass(frozen=True)
class PolarOutline:
    """r(theta) as a periodic piecewise cubic; v is theta in radians."""

    radius: Cubics

    @property
    def breaks(self) -> Floats:
        """The knots of r."""
        return np.asarray(self.radius.x, dtype=np.float64)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Turn r and its derivatives into those of the point."""
        c = self.radius.c[:, piece]
        s = v - self.breaks[piece]
        r = ((c[0] * s + c[1]) * s + c[2]) * s + c[3]
        r1 = (3 * c[0] * s + 2 * c[1]) * s + c[2]
        r2 = 6 * c[0] * s + 2 * c[1]
        out = np.stack([np.cos(v), np.sin(v)], axis=-1)
        across = np.stack([-np.sin(v), np.cos(v)], axis=-1)
        return np.stack(
            [
                r[:, None] * out,
                r1[:, None] * out + r[:, None] * across,
                (r2 - r)[:, None] * out + 2 * r1[:, None] * across,
            ]
        )


@dataclass(frozen=True)
class SuperellipseOutline:
    """``|x|^n + |y|^n = 1`` in eight pieces; v counts octants, within one it is minor/major."""

    exponent: float

    @property
    def breaks(self) -> Floats:
        """The ends of the octants."""
        return np.arange(9.0)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Solve the equation along the ray of slope t; odd octants run from t = 1 to 0."""
        n = self.exponent
        odd = piece % 2 == 1
        t = np.clip(np.where(odd, piece + 1 - v, v - piece), 0.0, 1.0)
        sign = np.where(odd, -1.0, 1.0)
        base = 1 + t**n
        x = base ** (-1 / n)
        x1 = -(t ** (n - 1)) * base ** (-1 / n - 1)
        x2 = (n + 1) * t ** (2 * n - 2) * base ** (-1 / n - 2)
        x2 -= (n - 1) * t ** (n - 2) * base ** (-1 / n - 1)
        y, y1, y2 = t * x, x + t * x1, 2 * x1 + t * x2
        major = np.stack([x, sign * x1, x2])
        minor = np.stack([y, sign * y1, y2])
        # Octant 2q starts at the q-th half-axis; octant 2q + 1 ends at the next one.
        quarter = np.where(odd, (piece + 1) // 2, piece // 2) % 4
        minor = np.where(odd, -minor, minor)
        turns = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
        c, s = turns[quarter].T
        return np.stack([c * major - s * minor, s * major + c * minor], axis=-1)


@dataclass(frozen=True)
class CircleOutline:
    """The unit circle; v counts quarter turns."""

    @property
    def breaks(self) -> Floats:
        """The ends of the quadrants."""
        return np.arange(5.0)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Turn the unit vector."""
        rate = np.pi / 2
        cos, sin = np.cos(rate * v), np.sin(rate * v)
        point = np.stack([cos, sin], axis=-1)
        return np.stack([point, rate * np.stack([-sin, cos], axis=-1), -(rate**2) * point])


@dataclass(frozen=True)
class ScaledOutline:
    """An outline under a linear map."""

    inner: Outline
    matrix: Floats  # (2, 2)

    @property
    def breaks(self) -> Floats:
        """Those of the inner outline."""
        return self.inner.breaks

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Map the point and its derivatives."""
        return np.asarray(self.inner.derivatives(v, piece) @ self.matrix.T)


@dataclass(frozen=True)
class RoundedOutline:
    """Straight edges joined by tangent arcs; edge k is piece 2k, the arc after it 2k + 1."""

    starts: Floats  # (corners, 2) where each edge begins
    ends: Floats  # (corners, 2) where it ends and the arc begins
    centers: Floats  # (corners, 2) of the arcs
    turns_rad: Floats  # (corners,) signed turn of the arcs, positive anticlockwise

    @property
    def breaks(self) -> Floats:
        """One unit of v per edge and per arc."""
        return np.arange(2.0 * len(self.starts) + 1)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Evaluate edges linearly and arcs by turning their first radius."""
        k, s = piece // 2, (v - piece)[:, None]
        edge = self.ends[k] - self.starts[k]
        straight = np.stack([self.starts[k] + s * edge, edge, np.zeros_like(edge)])
        radius = self.ends[k] - self.centers[k]
        across = np.stack([-radius[:, 1], radius[:, 0]], axis=-1)
        turn = self.turns_rad[k][:, None]
        cos, sin = np.cos(turn * s), np.sin(turn * s)
        out = cos * radius + sin * across
        along = cos * across - sin * radius
        curved = np.stack([self.centers[k] + out, turn * along, -(turn**2) * out])
        return np.where((piece % 2 == 1)[:, None], curved, straight)


@dataclass(frozen=True)
class EdgesOutline:
    """A polygon with sharp corners; edge k runs over k <= v <= k + 1."""

    points: Floats  # (corners, 2)

    @property
    def breaks(self) -> Floats:
        """The corners."""
        return np.arange(len(self.points) + 1.0)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Evaluate the edges linearly."""
        start = self.points[piece]
        edge = np.roll(self.points, -1, axis=0)[piece] - start
        return np.stack([start + (v - piece)[:, None] * edge, edge, np.zeros_like(edge)])


@dataclass(frozen=True)
class FinerOutline:
    """An outline cut at further places; a piece is a stretch of one of the inner pieces."""

    inner: Outline
    breaks: Floats
    owners: Ints

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Evaluate the inner outline's own piece."""
        return self.inner.derivatives(v, self.owners[piece])


def finer(outline: Outline, most_rad: float = 1.0) -> Outline:
    """Cut pieces that turn far about the origin, so that none is seen under half a turn."""
    breaks = outline.breaks
    count, each = len(breaks) - 1, 65
    v = breaks[:-1, None] + np.linspace(0, 1, each) * np.diff(breaks)[:, None]
    points = outline.derivatives(v.ravel(), np.repeat(np.arange(count), each))[0]
    angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]).reshape(count, each), axis=1)
    found, owners = [], []
    for k in range(count):
        parts = int(np.ceil(abs(angle[k, -1] - angle[k, 0]) / most_rad)) or 1
        turned = np.abs(angle[k] - angle[k, 0])
        marks = np.searchsorted(turned, turned[-1] * np.arange(parts) / parts)
        starts = np.unique(v[k, np.minimum(marks, each - 2)])
        found.append(starts)
        owners += [k] * len(starts)
    if len(owners) == count:
        return outline
    return FinerOutline(
        outline, np.append(np.concatenate(found), breaks[-1]), np.array(owners, dtype=np.intp)
    )


@dataclass(frozen=True)
class PlacedOutline:
    """An outline given in the contour plane, moved to unit coordinates about a centre."""

    inner: Outline
    center: Floats
    scale: float
    reverse: bool

    @property
    def breaks(self) -> Floats:
        """The inner breaks, run backwards where the orientation was."""
        breaks = self.inner.breaks
        return np.asarray(-breaks[::-1] if self.reverse else breaks)

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Shift and scale the inner curve."""
        if self.reverse:
            values = self.inner.derivatives(-v, len(self.inner.breaks) - 2 - piece)
            values[1] *= -1
        else:
            values = self.inner.derivatives(v, piece)
        values[0] -= self.center
        return np.asarray(values / self.scale)
