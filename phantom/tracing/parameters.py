"""The parameters (u, v) of points on swept surfaces: the paper's Γ(u, v), undone.

u is the axis's parameter. A point is brought into the section plane at u, the sweep is undone, and
v is the parameter of the contour where it lies: the angle in radians of a circle, an ellipse, a
polar contour or a morph, octants of a superellipse, edges of a polygon (its arcs count as edges),
shares of the chord length of a spline, and a formula's own variable.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.placed import placed_leaves
from phantom.geometry.contours import plane_outline
from phantom.geometry.curves import Curve, curve
from phantom.geometry.formulas import Formula
from phantom.geometry.frames import Frame, frame
from phantom.geometry.outlines import Outline
from phantom.geometry.sweeps import linear_sweep
from phantom.geometry.vectors import dots
from phantom.scene import Phantom

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_EACH = 64
_NEAREST = 3
_STEPS = 12


def parameters_of(
    phantom: Phantom, leaf: Ints, points: Floats, u: Floats, side: NDArray[np.bool_]
) -> Floats:
    """Return (N, 2) u and v.

    Parameters
    ----------
    phantom
        Whose leaves.
    leaf
        (N,) whose surface each point is on.
    points
        (N, 3) mm, in the world.
    u
        (N,) the axis's parameter, nan for leaves that have none.
    side
        (N,) true where the point is on the swept surface; elsewhere v is nan.
    """
    found = np.stack([u, np.full(len(u), np.nan)], axis=-1)
    for index, (spec, to) in enumerate(placed_leaves(phantom.document)):
        here = np.flatnonzero((leaf == index) & side)
        if len(here) and isinstance(spec, doc.GeneralizedCylinder):
            # The similarity undone: its rotation is orthogonal.
            own = (points[here] - to.shift) @ to.rotation / to.scale
            found[here, 1] = _around(spec, own, u[here])
    return found


def _around(spec: doc.GeneralizedCylinder, points: Floats, u: Floats) -> Floats:
    """Return v of points on a generalized cylinder, in its own coordinates."""
    framed = frame(spec.frame, curve(spec.axis))
    plane = _in_plane(framed.curve, framed.frame, points, u)
    if isinstance(spec.sweep, doc.MorphSweep):
        return np.asarray(np.mod(np.arctan2(plane[:, 1], plane[:, 0]), 2 * np.pi))
    assert spec.contour is not None
    if isinstance(spec.sweep, doc.FormulaSweep):
        undone = [Formula.of(text, "x", "y", "u") for text in spec.sweep.inverse]
        columns = [f.values(x=plane[:, 0], y=plane[:, 1], u=u) for f in undone]
        plane = np.asarray(np.stack(np.broadcast_arrays(*columns), axis=-1))
    else:
        maps, offsets = linear_sweep(spec.sweep, doc.parameter_range(spec.axis)).maps(u)
        plane = np.asarray(np.linalg.solve(maps, (plane - offsets)[..., None])[..., 0])
    v = nearest(plane_outline(spec.contour), plane)
    round_ = isinstance(spec.contour, (doc.CircleContour, doc.EllipseContour))
    return v * (np.pi / 2) if round_ else v


def _in_plane(axis: Curve, around: Frame, points: Floats, u: Floats) -> Floats:
    """Return the coordinates along n and b of points in the section planes at u."""
    last = len(axis.breaks) - 2
    piece = np.clip(np.searchsorted(axis.breaks, u, side="right") - 1, 0, last)
    at, first = axis.derivatives(u, piece, 1)
    t = first / np.linalg.norm(first, axis=1)[:, None]
    n = around.normals(u, piece)
    away = points - at
    return np.stack([dots(away, n), dots(away, np.cross(t, n))], axis=-1)


def nearest(outline: Outline, points: Floats) -> Floats:
    """Return v of the points of an outline that lie nearest to some points of its plane (N, 2)."""
    from scipy.spatial import cKDTree

    breaks = outline.breaks
    pieces = np.repeat(np.arange(len(breaks) - 1), _EACH)
    shares = np.tile(np.linspace(0.0, 1.0, _EACH), len(breaks) - 1)
    v = breaks[pieces] + shares * np.diff(breaks)[pieces]
    v[_EACH - 1 :: _EACH] = breaks[1:]
    tree = cKDTree(outline.derivatives(v, pieces)[0])
    _, chosen = tree.query(points, k=_NEAREST)
    best, found = np.full(len(points), np.inf), np.zeros(len(points))
    for candidate in np.asarray(chosen).T:
        piece, at = pieces[candidate], v[candidate]
        low, high = breaks[piece], breaks[piece + 1]
        for _ in range(_STEPS):
            c, c1, c2 = outline.derivatives(at, piece)
            slope = dots(c1, c1) + dots(c - points, c2)
            step = dots(c - points, c1) / np.where(slope > 0, slope, 1.0)
            at = np.clip(at - np.where(slope > 0, step, 0.0), low, high)
        off = np.linalg.norm(outline.derivatives(at, piece)[0] - points, axis=1)
        closer = off < best
        best, found = np.where(closer, off, best), np.where(closer, at, found)
    return found
