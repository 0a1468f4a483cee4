"""A generalized cylinder as functions of u: axis, frame, sweep and contour brought together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.errors import Problem
from phantom.geometry.changing import Sections as ChangingSections
from phantom.geometry.changing import morph
from phantom.geometry.contours import Contour, contours, outline_hull, plane_outline
from phantom.geometry.curves import Curve, curve
from phantom.geometry.formula_sweeps import formula_sections
from phantom.geometry.frames import (
    Frame,
    RotationMinimizingFrame,
    UpFrame,
    frame,
    rotation_minimizing,
)
from phantom.geometry.polynomials import interpolation_matrix, lobatto_nodes
from phantom.geometry.refusal import RefusalError
from phantom.geometry.star import chart_rays
from phantom.geometry.sweeps import AnyLinear, linear_sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Built = TypeVar("Built")


@dataclass(frozen=True)
class Sections:
    """The section planes at n parameters.

    A point of unit contour coordinates ``phi`` lies at ``a + spread @ phi`` where ``a`` already
    holds the offset of the section (the contour's centre and the sweep's offset).
    """

    axis: Floats  # (n, 3) points of the axis
    first: Floats  # (n, 3) a'
    second: Floats  # (n, 3) a''
    middle: Floats  # (n, 3) where phi = 0 lies
    spread: Floats  # (n, 3, 2) mm per unit of phi
    inverse: Floats  # (n, 2, 3) back from the plane to phi: inverse @ (x - middle)


@dataclass(frozen=True)
class Hull:
    """Points of a contour in unit coordinates, and how far it may reach beyond their hull.

    ``points`` is ``(n or 1, P, 2)``, or None for the unit circle.
    """

    points: Floats | None
    margin: float


@dataclass(frozen=True)
class SweptShape:
    """Axis, frame, sweep and contour of one generalized cylinder."""

    curve: Curve
    frame: Frame
    sweep: AnyLinear
    contour: Contour
    warnings: tuple[str, ...] = ()

    @property
    def breaks(self) -> Floats:
        """All parameters where a derivative of axis or sweep may jump."""
        return merged_breaks(self.curve.breaks, self.sweep.breaks)

    def points(self, u: Floats, count: int) -> Floats:
        """Return points of the contour in unit coordinates at each u, ``(n or 1, count', 2)``."""
        return self.contour.unit_points(count)[None]

    def hull(self, u: Floats, count: int) -> Hull:
        """Return what holds the contour at each u."""
        if self.contour.outline is None:
            return Hull(None, 0.0)
        return Hull(*outline_hull(self.contour.outline, count))

    def pieces(self, breaks: Floats) -> Ints:
        """Return the axis piece over each interval of ``breaks``."""
        return axis_pieces(self.curve, breaks)

    def sections(self, u: Floats, piece: Ints) -> Sections:
        """Evaluate the section planes at ``u`` on the named axis pieces."""
        maps, offsets = self.sweep.maps(u)
        in_plane = offsets + maps @ self.contour.center
        return _sections(self.curve, self.frame, u, piece, maps @ self.contour.matrix, in_plane)

    def fit_error(self, start: Floats, end: Floats) -> Floats:
        """Nothing: the contour is the same at every u."""
        return np.zeros(len(start))


@dataclass(frozen=True)
class ChangingShape:
    """Axis and frame with a section whose very shape changes (:mod:`phantom.geometry.changing`)."""

    curve: Curve
    frame: Frame
    changing: ChangingSections
    unit: float  # mm, the largest radius of all sections
    warnings: tuple[str, ...] = ()

    @property
    def breaks(self) -> Floats:
        """All parameters where a derivative of axis or section may jump."""
        return merged_breaks(self.curve.breaks, self.changing.breaks)

    def hull(self, u: Floats, count: int) -> Hull:
        """Return what holds the section at each u."""
        points = self.points(u, count)
        # Second differences tell how far it bulges from one sample to the next: an eighth of them
        # where it is smooth, up to half of the larger one where a corner lies in between.
        even = points[:, :count]
        bends = np.roll(even, 1, axis=1) - 2 * even + np.roll(even, -1, axis=1)
        return Hull(points, 0.65 * float(np.linalg.norm(bends, axis=-1).max()))

    def points(self, u: Floats, count: int) -> Floats:
        """Return points of each section in unit coordinates, ``(n, count', 2)``.

        The first ``count`` are spread evenly, in order; the corners follow.
        """
        T = np.concatenate([8.0 * np.arange(count) / count, self.changing.corners(u[:1])[0]])
        rays = chart_rays(T)
        directions = rays / np.linalg.norm(rays, axis=1)[:, None]
        return np.asarray((self.changing.radii(T, u) / self.unit).T[..., None] * directions)

    def pieces(self, breaks: Floats) -> Ints:
        """Return the axis piece over each interval of ``breaks``."""
        return axis_pieces(self.curve, breaks)

    def sections(self, u: Floats, piece: Ints) -> Sections:
        """Evaluate the section planes at ``u`` on the named axis pieces."""
        maps = np.broadcast_to(self.unit * np.eye(2), (len(u), 2, 2))
        return _sections(self.curve, self.frame, u, piece, maps, self.changing.centers(u))

    def fit_error(self, start: Floats, end: Floats) -> Floats:
        """How far radii are off, in mm, where they are interpolated over each range of u."""
        T = self.changing.watched(start, end)
        nodes, checks = lobatto_nodes(), np.array([-0.95, -0.6, -0.2, 0.3, 0.7, 0.97])
        middle, half = 0.5 * (start + end)[:, None], 0.5 * (end - start)[:, None]
        known = self.changing.radii(T, np.clip(middle + half * nodes, start[:, None], end[:, None]))
        truth = self.changing.radii(T, middle + half * checks)
        # Tables hold 1 / r^2 (the gauge): an error of it moves the radius by r^3 / 2 of it.
        powers = np.vander(checks, len(nodes), increasing=True) @ interpolation_matrix()
        found = known**-2.0 @ powers.T
        return np.asarray((0.5 * truth**3 * np.abs(found - truth**-2.0)).max(axis=(1, 2)))


Shape = SweptShape | ChangingShape


def merged_breaks(axis: Floats, other: Floats) -> Floats:
    """Join two sets of breaks over the same range; those that differ by rounding are one."""
    span = axis[-1] - axis[0]
    merged = np.unique(np.concatenate([axis, other]))
    keep = np.append(True, np.diff(merged) > 1e-12 * span)
    merged = merged[keep]
    merged[0], merged[-1] = axis[0], axis[-1]
    return np.asarray(merged)


def axis_pieces(curve: Curve, breaks: Floats) -> Ints:
    """Return the axis piece over each interval of ``breaks``."""
    middles = 0.5 * (breaks[:-1] + breaks[1:])
    found = np.searchsorted(curve.breaks, middles, side="right") - 1
    return np.clip(found, 0, len(curve.breaks) - 2)


def _sections(
    curve: Curve, frame: Frame, u: Floats, piece: Ints, maps: Floats, in_plane: Floats
) -> Sections:
    axis, first, second = curve.derivatives(u, piece, 2)
    t = first / np.linalg.norm(first, axis=1)[:, None]
    n = frame.beside(t) if isinstance(frame, UpFrame) else frame.normals(u, piece)
    plane = np.stack([n, np.cross(t, n)], axis=-1)
    inverse = np.linalg.inv(maps) @ np.swapaxes(plane, 1, 2)
    middle = axis + np.einsum("nij,nj->ni", plane, in_plane)
    return Sections(axis, first, second, middle, plane @ maps, inverse)


def swept_shapes(leaf: doc.GeneralizedCylinder) -> tuple[list[Shape], list[Problem]]:
    """Build the shape, part by part of its contour, or return every problem of its fields.

    Paths are below the leaf. Most contours have one part.
    """
    problems: list[Problem] = []

    def tried(build: Callable[[], Built]) -> Built | None:
        try:
            return build()
        except RefusalError as refusal:
            problems.append(refusal.problem)
            return None

    axis = tried(lambda: curve(leaf.axis))
    section = tried(lambda: _section(leaf))
    framed = None
    if axis is not None:
        found: Curve = axis
        framed = tried(lambda: frame(leaf.frame, found))
    if problems or framed is None or section is None:
        return [], problems
    axis, around, warnings = framed.curve, framed.frame, framed.warnings
    if isinstance(section, tuple):
        sweep, parts = section
        if _is_plain(parts[0], sweep) and not isinstance(around, RotationMinimizingFrame):
            # A circle that stays a circle about the axis may be drawn in the smoothest frame.
            around, warnings = rotation_minimizing(axis), ()
        return [SweptShape(axis, around, sweep, part, warnings) for part in parts], []
    u = np.linspace(axis.breaks[0], axis.breaks[-1], 257)
    unit = 1.02 * float(section.radii(8.0 * np.arange(64) / 64, u).max())
    return [ChangingShape(axis, around, section, unit, warnings)], []


def _section(
    leaf: doc.GeneralizedCylinder,
) -> tuple[AnyLinear, tuple[Contour, ...]] | ChangingSections:
    """Read sweep and contour: a fixed contour under a linear map, or sections that change."""
    span = doc.parameter_range(leaf.axis)
    if isinstance(leaf.sweep, doc.MorphSweep):
        return morph(leaf.sweep)
    assert leaf.contour is not None
    if isinstance(leaf.sweep, doc.FormulaSweep):
        return formula_sections(leaf.sweep, plane_outline(leaf.contour), span)
    sweep = linear_sweep(leaf.sweep, span)
    return sweep, contours(leaf.contour)


def _is_plain(section: Contour, sweep: AnyLinear) -> bool:
    """Say whether turning the section about the axis changes nothing."""
    circle = section.outline is None and section.matrix[0, 0] == section.matrix[1, 1]
    return bool(circle and sweep.is_round)
