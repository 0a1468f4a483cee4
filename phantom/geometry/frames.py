"""Frames along an axis: the directions n and b in which the section is drawn.

``rotation_minimizing`` frames are found by quadrature, not by stepping: on a short cell the frame
is written as a turn by ``angle(u)`` of the projection of one fixed vector m, and the condition that
it does not turn about the tangent t, ``e1' . e2 = 0``, becomes ``angle' = (m.t)(t'.r2)/L``: a
smooth scalar whose Chebyshev series integrates to rounding (Bishop 1975, doi:10.2307/2319846).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry import tolerances
from phantom.geometry.curves import Curve, lowest, sample_parameters
from phantom.geometry.frenet import frenet
from phantom.geometry.refusal import RefusalError
from phantom.geometry.vectors import dots, unit

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_CELL_TURN_RAD = 0.3
_SERIES = 20
_HALVINGS = 12
_ANGLE_RAD = 1e-13


class Frame(Protocol):
    """Directions n and b at parameters of a curve."""

    def normals(self, u: Floats, piece: Ints) -> Floats:
        """Return the unit vectors n, ``(n, 3)``; b is t x n."""


def tangents(curve: Curve, u: Floats, piece: Ints) -> Floats:
    """Return the unit tangents ``(n, 3)``."""
    return unit(curve.derivatives(u, piece, 1)[1])


def _across(m: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Return the unit projection of m across t, and the projection's length."""
    r1 = m - t * dots(m, t)[..., None]
    length = np.linalg.norm(r1, axis=-1)
    return r1 / length[..., None], length


def _projected(m: Floats, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the unit projection r1 of m across t, r2 = t x r1, and the projection's length."""
    r1, length = _across(m, t)
    return r1, np.cross(t, r1), length


@dataclass(frozen=True)
class RotationMinimizingFrame:
    """The frame that does not turn about the tangent, cell by cell."""

    curve: Curve
    edges: Floats  # (cells + 1,)
    references: Floats  # (cells, 3), the fixed vector m of each cell
    series: Floats  # (cells, _SERIES + 1), Chebyshev series of the angle
    spread_rad: float  # leftover angle of a closed axis, spread evenly over u

    def normals(self, u: Floats, piece: Ints) -> Floats:
        """Turn the projected reference vector by the integrated angle."""
        cell = np.clip(np.searchsorted(self.edges, u, side="right") - 1, 0, len(self.series) - 1)
        a, b = self.edges[cell], self.edges[cell + 1]
        x = (2 * u - a - b) / (b - a)
        angle = chebyshev.chebval(x, self.series[cell].T, tensor=False)
        low, high = self.edges[0], self.edges[-1]
        angle = angle + self.spread_rad * (u - low) / (high - low)
        r1, r2, _ = _projected(self.references[cell], tangents(self.curve, u, piece))
        return np.asarray(np.cos(angle)[:, None] * r1 + np.sin(angle)[:, None] * r2)


def _cells(curve: Curve) -> tuple[Floats, Ints]:
    """Cut each piece so that the tangent turns little within a cell."""
    edges, owners = [curve.breaks[:1]], []
    u, piece = sample_parameters(curve.breaks, 129)
    t = tangents(curve, u, piece).reshape(-1, 129, 3)
    steps = np.arccos(np.clip(dots(t[:, 1:], t[:, :-1]), -1, 1))
    for k, turn in enumerate(np.cumsum(steps, axis=1)):
        count = max(2, int(np.ceil(turn[-1] / _CELL_TURN_RAD)))
        edges.append(np.linspace(curve.breaks[k], curve.breaks[k + 1], count + 1)[1:])
        owners += [k] * count
    return np.concatenate(edges), np.array(owners, dtype=np.intp)


def _start(tangent: Floats) -> Floats:
    world = np.array([0.0, 1.0, 0.0]) if abs(tangent[0]) > 0.9 else np.array([1.0, 0.0, 0.0])
    return _projected(world, tangent)[0]


def rotation_minimizing(curve: Curve) -> RotationMinimizingFrame:
    """Build the rotation-minimizing frame that starts from world +x (or +y), document.md."""
    edges, owners = _cells(curve)
    for _ in range(_HALVINGS):
        rough = _rates(curve, edges, owners)[1]
        if not rough.any():
            break
        middles = 0.5 * (edges[:-1] + edges[1:])[rough]
        edges = np.sort(np.concatenate([edges, middles]))
        owners = np.repeat(owners, 1 + rough)
    rates, _ = _rates(curve, edges, owners)
    return _integrated(curve, edges, owners, rates)


def _rates(curve: Curve, edges: Floats, owners: Ints) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the Chebyshev series of angle' on each cell, and which cells it does not yet fit."""
    nodes = np.cos(np.pi * (np.arange(_SERIES) + 0.5) / _SERIES)
    u = 0.5 * (edges[:-1, None] + edges[1:, None]) + 0.5 * np.diff(edges)[:, None] * nodes
    piece = np.repeat(owners, _SERIES)
    _, d1, d2 = curve.derivatives(u.ravel(), piece, 2)
    speed = np.linalg.norm(d1, axis=1)
    t = (d1 / speed[:, None]).reshape(-1, _SERIES, 3)
    bend = ((d2 - d1 * (dots(d1, d2) / speed**2)[:, None]) / speed[:, None]).reshape(t.shape)

    references = _references(curve, edges, owners)
    _, r2, length = _projected(references[:, None, :], t)
    rate = dots(references[:, None, :], t) * dots(bend, r2) / length
    transform = np.linalg.inv(chebyshev.chebvander(nodes, _SERIES - 1))
    series = rate @ transform.T
    left = np.abs(series[:, -3:]).max(axis=1) * np.diff(edges)
    return series, left > _ANGLE_RAD


def _references(curve: Curve, edges: Floats, owners: Ints) -> Floats:
    """Any vector across the cell's first tangent serves as its reference."""
    return np.array([_start(tangent) for tangent in tangents(curve, edges[:-1], owners)])


def _integrated(
    curve: Curve, edges: Floats, owners: Ints, rates: Floats
) -> RotationMinimizingFrame:
    """Integrate the angle cell by cell, each starting where the one before ended."""
    references = _references(curve, edges, owners)
    starts = np.concatenate(
        [tangents(curve, edges[:-1], owners), tangents(curve, edges[-1:], owners[-1:])]
    )
    series = np.zeros((len(owners), _SERIES + 1))
    n = _start(starts[0])
    for k, rate in enumerate(rates):
        half = 0.5 * (edges[k + 1] - edges[k])
        integral = chebyshev.chebint(rate, lbnd=-1) * half
        r1, across, _ = _projected(references[k], starts[k])
        integral[0] += np.arctan2(n @ across, n @ r1)
        series[k] = integral
        angle = chebyshev.chebval(1.0, integral)
        r1, across, _ = _projected(references[k], starts[k + 1])
        n = np.cos(angle) * r1 + np.sin(angle) * across
    spread = 0.0
    if curve.closed:
        first = _start(starts[0])
        spread = _leftover(starts[0], first, n)
    return RotationMinimizingFrame(curve, edges, references, series, spread)


def _leftover(tangent: Floats, first: Floats, last: Floats) -> float:
    """Angle in (-180, 180] degrees, as radians, by which ``last`` must turn to meet ``first``."""
    angle = float(np.arctan2(first @ np.cross(tangent, last), first @ last))
    return np.pi if angle == -np.pi else angle


@dataclass(frozen=True)
class UpFrame:
    """The frame whose n is a fixed vector made orthogonal to the tangent."""

    curve: Curve
    up: Floats

    def normals(self, u: Floats, piece: Ints) -> Floats:
        """Project ``up`` across the tangent."""
        return self.beside(tangents(self.curve, u, piece))

    def beside(self, t: Floats) -> Floats:
        """Return n where the unit tangents are known."""
        return _across(self.up, t)[0]


@dataclass(frozen=True)
class Framed:
    """A frame over its axis, which it may have cut, and what a person should know about it."""

    curve: Curve
    frame: Frame
    warnings: tuple[str, ...] = ()


def frame(spec: doc.Frame, curve: Curve) -> Framed:
    """Build the frame a document asks for, or refuse it below ``/frame``."""
    if isinstance(spec, doc.UpFrame):
        return Framed(curve, _up(spec, curve))
    if spec == "frenet":
        found = frenet(curve)
        if found is not None:
            return Framed(*found)
    return Framed(curve, rotation_minimizing(curve))


def _up(spec: doc.UpFrame, curve: Curve) -> UpFrame:
    up = unit(np.array(spec.up, dtype=np.float64))

    def sine(u: Floats, piece: Ints) -> Floats:
        return np.asarray(np.linalg.norm(np.cross(tangents(curve, u, piece), up), axis=1))

    place, least = lowest(sine, curve.breaks, 257)
    if least < tolerances.UP_PARALLEL:
        raise RefusalError(
            "/frame/up",
            "up_parallel",
            f"up is parallel to the axis at u = {place:.6g} (sine {least:.3g}); "
            "expected a vector across the axis everywhere",
        )
    return UpFrame(curve, up)
