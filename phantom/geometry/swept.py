"""A generalized cylinder as functions of u: axis, frame, sweep and contour brought together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.errors import Problem
from phantom.geometry.changing import Sections as ChangingSections
from phantom.geometry.contours import Contour, contours
from phantom.geometry.curves import Curve, curve
from phantom.geometry.frames import Frame, RotationMinimizingFrame, frame, rotation_minimizing
from phantom.geometry.polynomials import interpolation_matrix, lobatto_nodes
from phantom.geometry.refusal import RefusalError
from phantom.geometry.sweeps import LinearSweep, linear_sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


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
class SweptShape:
    """Axis, frame, sweep and contour of one generalized cylinder."""

    curve: Curve
    frame: Frame
    sweep: LinearSweep
    contour: Contour

    @property
    def breaks(self) -> Floats:
        """All parameters where a derivative of axis or sweep may jump."""
        return merged_breaks(self.curve.breaks, self.sweep.breaks)

    @property
    def is_circle(self) -> bool:
        """Whether the contour is the unit circle in unit coordinates."""
        return self.contour.outline is None

    def hull(self, u: Floats, count: int) -> Floats:
        """Return points of the contour in unit coordinates at each u, ``(n or 1, count', 2)``."""
        return self.contour.unit_points(count)[None]

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

    @property
    def breaks(self) -> Floats:
        """All parameters where a derivative of axis or section may jump."""
        return merged_breaks(self.curve.breaks, self.changing.breaks)

    @property
    def is_circle(self) -> bool:
        """Never: the section is a table."""
        return False

    def hull(self, u: Floats, count: int) -> Floats:
        """Return points of each section in unit coordinates, ``(n, count, 2)``."""
        T = 8.0 * np.arange(count) / count
        chart = np.minimum(T // 2, 3).astype(np.intp)
        t = T - 2.0 * chart - 1.0
        ray = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])[chart]
        across = np.stack([-ray[:, 1], ray[:, 0]], axis=-1)
        direction = (ray + t[:, None] * across) / np.hypot(1.0, t)[:, None]
        radius = self.changing.radii(T, u) / self.unit
        return np.asarray(radius.T[..., None] * direction)

    def pieces(self, breaks: Floats) -> Ints:
        """Return the axis piece over each interval of ``breaks``."""
        return axis_pieces(self.curve, breaks)

    def sections(self, u: Floats, piece: Ints) -> Sections:
        """Evaluate the section planes at ``u`` on the named axis pieces."""
        maps = np.broadcast_to(self.unit * np.eye(2), (len(u), 2, 2))
        return _sections(self.curve, self.frame, u, piece, maps, self.changing.centers(u))

    def fit_error(self, start: Floats, end: Floats) -> Floats:
        """How far radii are off, in mm, where they are interpolated over each range of u."""
        T = 8.0 * np.arange(48) / 48 + 0.01
        nodes, checks = lobatto_nodes(), np.array([-0.95, -0.6, -0.2, 0.3, 0.7, 0.97])
        middle, half = 0.5 * (start + end)[:, None], 0.5 * (end - start)[:, None]
        known = self.changing.radii(
            T, np.clip(middle + half * nodes, start[:, None], end[:, None]).ravel()
        )
        truth = self.changing.radii(T, (middle + half * checks).ravel())
        powers = np.vander(checks, len(nodes), increasing=True) @ interpolation_matrix()
        found = known.reshape(len(T), len(start), -1) @ powers.T
        return np.asarray(np.abs(found - truth.reshape(found.shape)).max(axis=(0, 2)))


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
    n = frame.normals(u, piece)
    plane = np.stack([n, np.cross(t, n)], axis=-1)
    inverse = np.linalg.inv(maps) @ np.swapaxes(plane, 1, 2)
    middle = axis + np.einsum("nij,nj->ni", plane, in_plane)
    return Sections(axis, first, second, middle, plane @ maps, inverse)


def swept_shapes(leaf: doc.GeneralizedCylinder) -> tuple[list[Shape], list[Problem]]:
    """Build the shape, part by part of its contour, or return every problem of its fields.

    Paths are below the leaf. Most contours have one part.
    """
    problems: list[Problem] = []
    parts: list[Any] = []
    for build in (
        lambda: curve(leaf.axis),
        lambda: contours(leaf.contour),
        lambda: linear_sweep(leaf.sweep),
    ):
        try:
            parts.append(build())
        except RefusalError as refusal:
            problems.append(refusal.problem)
            parts.append(None)
    axis, sections, sweep = parts
    around = None
    if axis is not None:
        try:
            around = frame(leaf.frame, axis)
        except RefusalError as refusal:
            problems.append(refusal.problem)
    if problems or around is None:
        return [], problems
    if sections[0].outline is None:
        around = _plain_frame(sections[0], sweep, axis, around)
    return [SweptShape(axis, around, sweep, section) for section in sections], []


def _plain_frame(section: Contour, sweep: LinearSweep, axis: Curve, around: Frame) -> Frame:
    """A circle that stays a circle about the axis may be drawn in the smoothest frame."""
    if (
        section.matrix[0, 0] == section.matrix[1, 1]
        and sweep.is_round
        and not isinstance(around, RotationMinimizingFrame)
    ):
        return rotation_minimizing(axis)
    return around
