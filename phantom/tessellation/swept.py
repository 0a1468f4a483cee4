"""The net of a generalized cylinder: Γ(u, v) of the paper's equation 1, as the document has it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.contours import plane_outline
from phantom.geometry.formula_sweeps import FormulaSections
from phantom.geometry.outlines import Outline
from phantom.geometry.star import chart_rays
from phantom.geometry.swept import ChangingShape, SweptShape, swept_shapes
from phantom.tessellation.nets import End, Net, pieces_of

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_MARKS = 1e-7
"""Pseudo-angles that differ by less are one: the radius moves by less than this share of it."""

_JUMP = 1e-9
"""A section that moves by more than this share of its size at one u is two sections."""


@dataclass(frozen=True)
class SweptNet:
    """A fixed contour under a linear sweep, between two parameters of the axis."""

    shape: SweptShape
    outline: Outline  # in mm, in the contour plane
    u_breaks: Floats
    axis_pieces: Ints  # of each interval between u_breaks
    ends: tuple[End, End]

    @property
    def v_breaks(self) -> Floats:
        """Those of the contour."""
        return self.outline.breaks

    def points(self, u: Floats, u_piece: Ints, v: Floats, v_piece: Ints) -> Floats:
        """Place the contour in the section plane of every u."""
        contour = self.shape.contour
        plane = self.outline.derivatives(v, v_piece)[0] - contour.center
        unit = plane @ np.linalg.inv(contour.matrix).T
        at = self.shape.sections(u, self.axis_pieces[u_piece])
        return np.asarray(at.middle[:, None] + unit @ np.swapaxes(at.spread, 1, 2))


@dataclass(frozen=True)
class ChangingNet:
    """Sections whose shape changes: v is the contour's own, or the pseudo-angle of a morph."""

    shape: ChangingShape
    v_breaks: Floats
    u_breaks: Floats
    axis_pieces: Ints
    ends: tuple[End, End]

    def points(self, u: Floats, u_piece: Ints, v: Floats, v_piece: Ints) -> Floats:
        """Place the section of every u in its plane."""
        at = self.shape.sections(u, self.axis_pieces[u_piece])
        changing = self.shape.changing
        if isinstance(changing, FormulaSections):
            plane = changing.outline.derivatives(v, v_piece)[0]
            moved = changing.mapped(plane[None, :, 0], plane[None, :, 1], u[:, None])
            unit = (moved - changing.centers(u)[:, None]) / self.shape.unit
        else:
            # A pseudo-angle at a chart's end is taken on the side of its own interval.
            low, high = self.v_breaks[v_piece], self.v_breaks[v_piece + 1]
            T = np.clip(v, low, np.nextafter(high, low))
            rays = chart_rays(T)
            rays /= np.linalg.norm(rays, axis=1)[:, None]
            unit = (changing.radii(T, u) / self.shape.unit).T[..., None] * rays
        return np.asarray(at.middle[:, None] + unit @ np.swapaxes(at.spread, 1, 2))


def swept_nets(leaf: doc.GeneralizedCylinder) -> list[Net]:
    """Return the nets of a valid generalized cylinder, in its own coordinates.

    One, unless its frame jumps: then the section before the jump and the one after it bound two
    bodies that touch.
    """
    shapes, _ = swept_shapes(leaf)
    shape = shapes[0]
    breaks = shape.breaks
    pieces = shape.pieces(breaks)
    if isinstance(shape, SweptShape):
        assert leaf.contour is not None
        outline = plane_outline(leaf.contour)
        v_breaks = outline.breaks
    else:
        changing = shape.changing
        known = changing.outline.breaks if isinstance(changing, FormulaSections) else None
        v_breaks = _apart(changing.marks) if known is None else known

    def net(first: int, last: int, ends: tuple[End, End]) -> Net:
        part, owners = breaks[first : last + 1], pieces[first:last]
        if isinstance(shape, SweptShape):
            return SweptNet(shape, outline, part, owners, ends)
        return ChangingNet(shape, v_breaks, part, owners, ends)

    whole = net(0, len(pieces), ("flat", "flat"))
    jumps = _jumps(whole)
    if shape.curve.closed and not len(jumps):
        return [net(0, len(pieces), ("seam", "seam"))]
    marks = [0, *jumps, len(pieces)]
    return [net(a, b, ("flat", "flat")) for a, b in pairwise(marks)]


def _apart(marks: Floats) -> Floats:
    """Return marks without those that lie all but on the one before; the last one stays."""
    kept = [marks[0]]
    for mark in marks[1:-1]:
        if mark - kept[-1] > _MARKS and marks[-1] - mark > _MARKS:
            kept.append(mark)
    return np.array([*kept, marks[-1]])


def _jumps(net: Net) -> list[int]:
    """Return the inner breaks at which the section is another one from either side."""
    inner = np.arange(1, len(net.u_breaks) - 1)
    if not len(inner):
        return []
    v = net.v_breaks[0] + np.linspace(0, 1, 33) * (net.v_breaks[-1] - net.v_breaks[0])
    v_piece = pieces_of(net.v_breaks, v)
    before = net.points(net.u_breaks[inner], inner - 1, v, v_piece)
    after = net.points(net.u_breaks[inner], inner, v, v_piece)
    size = np.ptp(before, axis=1).max(axis=-1)
    off = np.linalg.norm(after - before, axis=-1).max(axis=-1)
    return [int(k) for k in inner[off > _JUMP * size + 1e-9]]
