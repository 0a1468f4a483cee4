"""A generalized cylinder as functions of u: axis, frame, sweep and contour brought together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.errors import Problem
from phantom.geometry.contours import Contour, contour
from phantom.geometry.curves import Curve, curve
from phantom.geometry.frames import Frame, RotationMinimizingFrame, frame, rotation_minimizing
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
        merged = np.unique(np.concatenate([self.curve.breaks, self.sweep.breaks]))
        # Knots of axis and sweep that differ by rounding are one knot.
        keep = np.append(np.diff(merged) > 1e-12, True)
        keep[0] = True
        merged = merged[keep]
        merged[-1] = self.curve.breaks[-1]
        return np.asarray(merged)

    def pieces(self, breaks: Floats) -> Ints:
        """Return the axis piece over each interval of ``breaks``."""
        middles = 0.5 * (breaks[:-1] + breaks[1:])
        found = np.searchsorted(self.curve.breaks, middles, side="right") - 1
        return np.clip(found, 0, len(self.curve.breaks) - 2)

    def sections(self, u: Floats, piece: Ints) -> Sections:
        """Evaluate the section planes at ``u`` on the named axis pieces."""
        axis, first, second = self.curve.derivatives(u, piece, 2)
        t = first / np.linalg.norm(first, axis=1)[:, None]
        n = self.frame.normals(u, piece)
        plane = np.stack([n, np.cross(t, n)], axis=-1)
        maps, offsets = self.sweep.maps(u)
        in_plane = offsets + maps @ self.contour.center
        maps = maps @ self.contour.matrix
        inverse = np.linalg.inv(maps) @ np.swapaxes(plane, 1, 2)
        middle = axis + np.einsum("nij,nj->ni", plane, in_plane)
        return Sections(axis, first, second, middle, plane @ maps, inverse)


def swept_shape(leaf: doc.GeneralizedCylinder) -> tuple[SweptShape | None, list[Problem]]:
    """Build the shape, or return every problem of its parts, with paths below the leaf."""
    problems: list[Problem] = []
    parts: list[object] = []
    for build in (
        lambda: curve(leaf.axis),
        lambda: contour(leaf.contour),
        lambda: linear_sweep(leaf.sweep),
    ):
        try:
            parts.append(build())
        except RefusalError as refusal:
            problems.append(refusal.problem)
            parts.append(None)
    axis, section, sweep = parts
    if axis is None:
        return None, problems
    try:
        around = frame(leaf.frame, axis)  # type: ignore[arg-type]
        if isinstance(section, Contour) and section.outline is None and not section.center.any():
            around = _plain_frame(section, sweep, axis, around)
    except RefusalError as refusal:
        problems.append(refusal.problem)
    if problems:
        return None, problems
    return SweptShape(axis, around, sweep, section), []  # type: ignore[arg-type]


def _plain_frame(section: Contour, sweep: object, axis: object, around: Frame) -> Frame:
    """A circle that stays a circle about the axis may be drawn in the smoothest frame."""
    if (
        section.matrix[0, 0] == section.matrix[1, 1]
        and isinstance(sweep, LinearSweep)
        and sweep.is_round
        and not isinstance(around, RotationMinimizingFrame)
    ):
        return rotation_minimizing(axis)  # type: ignore[arg-type]
    return around
