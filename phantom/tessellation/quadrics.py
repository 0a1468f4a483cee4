"""Any quadric ``y.A.y + 2 b.y + c <= 0`` as nets that agree with it within a given reach.

In the eigenvectors of A, with at least two positive eigenvalues, sections across the third
direction are ellipses whose square radii are a quadratic function of the height: rings
(:class:`RingNet`). With one positive eigenvalue and nothing against a translation the section is
the same everywhere: an extrusion (:class:`StripNet`). One positive, one negative and a linear term
along the third make a saddle (:class:`SaddleNet`). All others are what one of these leaves of a
box. Ends lie beyond the reach, where the planes of the leaf have cut everything away.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from phantom.tessellation.nets import End, Net

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Span = tuple[float, float]

THIN_MM = 1e-6
"""A body, or a gap, thinner than this in its middle is left out: it is rounding."""

_FLAT = 1e-11
"""An eigenvalue below this share of the largest bends nothing within the reach of a leaf."""


@dataclass(frozen=True)
class Profile:
    """``rho(h) = r2 h² + r1 h + r0`` over a span of heights, where it is positive.

    ``h`` is reached through a parameter in [0, 1] that is slow at an end where rho goes to 0, so
    that its square root, the radius, is smooth there.
    """

    r: tuple[float, float, float]  # r0, r1, r2
    span: Span
    closed: tuple[bool, bool]  # whether rho is 0 at each end
    sharp: bool = False  # whether it is a square there, as at the apex of a cone

    def heights(self, s: Floats) -> Floats:
        """Return h at parameters."""
        low, high = self.span
        match (False, False) if self.sharp else self.closed:
            case (True, True):
                share = 0.5 * (1 - np.cos(np.pi * s))
            case (True, False):
                share = 1 - np.cos(0.5 * np.pi * s)
            case (False, True):
                share = np.sin(0.5 * np.pi * s)
            case _:
                share = s
        return np.asarray(low + share * (high - low))

    def radii(self, h: Floats) -> Floats:
        """Return the square root of rho."""
        r0, r1, r2 = self.r
        return np.sqrt(np.maximum((r2 * h + r1) * h + r0, 0.0))

    @property
    def ends(self) -> tuple[End, End]:
        """A point where the radius is 0, else flat."""
        first, last = self.closed
        return ("point" if first else "flat", "point" if last else "flat")


def profiles(r: tuple[float, float, float], span: Span, width: float) -> list[Profile]:
    """Return the stretches of a span in which rho is positive.

    Where ``width`` times its root stays below :data:`THIN_MM` there is none.
    """
    r0, r1, r2 = r
    size = max(abs(r0), abs(r1) * span[1], abs(r2) * span[1] ** 2, 1e-300)
    discriminant = r1 * r1 - 4 * r2 * r0
    double = abs(discriminant) <= 1e-12 * max(r1 * r1, abs(4 * r2 * r0), 1e-300)
    roots: list[float] = []
    if abs(r2) * span[1] ** 2 > 1e-14 * size:
        if double:
            roots = [-0.5 * r1 / r2]
        elif discriminant > 0:
            q = -0.5 * (r1 + np.copysign(np.sqrt(discriminant), r1))
            roots = [q / r2, r0 / q]
    elif abs(r1) * span[1] > 1e-14 * size:
        roots = [-r0 / r1]
    inner = sorted(x for x in roots if span[0] < x < span[1])
    marks = [span[0], *inner, span[1]]
    found = []
    for low, high in pairwise(marks):
        middle = 0.5 * (low + high)
        rho = (r2 * middle + r1) * middle + r0
        if high > low and rho > max(1e-14 * size, (THIN_MM / width) ** 2):
            found.append(Profile(r, (low, high), (low in inner, high in inner), double))
    return found


@dataclass(frozen=True)
class RingNet:
    """Elliptic sections along a straight axis: ellipsoids, cylinders, cones, hyperboloids ...

    u runs along the axis in [0, 1], v round it in quarter turns.
    """

    center: Floats  # (3,)
    axes: Floats  # (3, 3) rows: across, across, along
    middle: Floats  # (2,) of the sections, across
    semi_axes: Floats  # (2,) of the section where rho is 1
    profile: Profile
    u_breaks: Floats
    v_breaks: Floats

    @property
    def ends(self) -> tuple[End, End]:
        """Those of the profile."""
        return self.profile.ends

    def points(self, u: Floats, u_piece: Ints, v: Floats, v_piece: Ints) -> Floats:
        """Return points of the ellipses."""
        h = self.profile.heights(u)
        angle = 0.5 * np.pi * v
        round_ = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * self.semi_axes
        across = self.middle + self.profile.radii(h)[:, None, None] * round_
        along = np.broadcast_to(h[:, None, None], (len(u), len(v), 1))
        return np.asarray(self.center + np.concatenate([across, along], axis=-1) @ self.axes)


@dataclass(frozen=True)
class StripNet:
    """``|x - m| <= w radius(h)`` at every depth: slabs, parabolic and hyperbolic cylinders.

    u runs along the depth in [0, 1]; v goes up one side in [0, 1], over to the other in [1, 2],
    down it, and back.
    """

    center: Floats
    axes: Floats  # rows: x, h, depth
    middle: float
    width: float
    profile: Profile
    depth: Span
    ends: tuple[End, End] = ("flat", "flat")

    @property
    def u_breaks(self) -> Floats:
        """One piece."""
        return np.array([0.0, 1.0])

    @property
    def v_breaks(self) -> Floats:
        """The sides; where the two meet in a point nothing lies between them."""
        first, last = self.profile.closed
        return np.array([0.0, 1.0, *([] if last else [2.0]), 3.0, *([] if first else [4.0])])

    def points(self, u: Floats, u_piece: Ints, v: Floats, v_piece: Ints) -> Floats:
        """Return points of the outline at each depth."""
        if self.profile.closed[1]:
            # The two sides meet there: the second begins at once, at a half of its pace.
            v = np.where((v > 1) & (v <= 3), 2 + 0.5 * (v - 1), v)
        up, down = np.clip(v, 0, 1), np.clip(3 - v, 0, 1)
        s = np.where(v <= 1, up, np.where(v <= 2, 1.0, np.where(v <= 3, down, 0.0)))
        h = self.profile.heights(s)
        side = np.where(v <= 1, 1.0, np.where(v <= 2, 3 - 2 * v, np.where(v <= 3, -1.0, 2 * v - 7)))
        x = self.middle + side * self.width * self.profile.radii(h)
        flat = np.broadcast_to(np.stack([x, h], axis=-1), (len(u), len(v), 2))
        depth = self.depth[0] + u * (self.depth[1] - self.depth[0])
        along = np.broadcast_to(depth[:, None, None], (len(u), len(v), 1))
        return np.asarray(self.center + np.concatenate([flat, along], axis=-1) @ self.axes)


@dataclass(frozen=True)
class SaddleNet:
    """``z <= f(x, y)``, f quadratic, over a rectangle and down to a floor.

    u runs along x in [0, 1]; v along the floor, up a side, back over the saddle, and down.
    """

    center: Floats
    axes: Floats  # rows: x, y, z
    bends: tuple[float, float]  # f = f0 + bends . (x², y²)
    f0: float
    x: Span
    y: Span
    floor: float
    ends: tuple[End, End] = ("flat", "flat")

    @property
    def u_breaks(self) -> Floats:
        """One piece."""
        return np.array([0.0, 1.0])

    @property
    def v_breaks(self) -> Floats:
        """The four sides."""
        return np.arange(5.0)

    def points(self, u: Floats, u_piece: Ints, v: Floats, v_piece: Ints) -> Floats:
        """Return points of the sections across x."""
        x = (self.x[0] + u * (self.x[1] - self.x[0]))[:, None]
        low, high = self.y
        over = np.where(v <= 1, v, np.where(v <= 2, 1.0, np.where(v <= 3, 3 - v, 0.0)))
        y = low + over * (high - low)
        lift = np.where(v <= 1, 0.0, np.where(v <= 2, v - 1, np.where(v <= 3, 1.0, 4 - v)))
        top = self.f0 + self.bends[0] * x**2 + self.bends[1] * y**2
        z = self.floor + lift * (top - self.floor)
        x, y = np.broadcast_to(x, z.shape), np.broadcast_to(y, z.shape)
        return np.asarray(self.center + np.stack([x, y, z], axis=-1) @ self.axes)


Form = tuple[Floats, Floats, float]


def quadric_nets(form: Form, center: Floats, reach_mm: float) -> tuple[list[Net], bool]:
    """Return the nets of a quadric within a ball about a centre, and whether it lies outside them.

    Parameters
    ----------
    form
        ``(A, b, c)`` about the centre.
    center
        ``(3,)`` mm.
    reach_mm
        Within this distance of the centre the nets bound the quadric.

    Returns
    -------
    The nets, each a body of its own, in mm. Where the flag is set, the solid is what is left when
    they are taken away. Without a net there is no surface within reach.
    """
    a, b, c = form
    values, vectors = np.linalg.eigh(a)
    size = max(float(np.abs(values).max()), float(np.linalg.norm(b)) / reach_mm)
    bending = np.where(np.abs(values) > _FLAT * size, np.sign(values), 0)
    if np.count_nonzero(bending < 0) > np.count_nonzero(bending > 0):
        return quadric_nets((-a, -b, -c), center, reach_mm)[0], True
    slopes = vectors.T @ b
    span = (-reach_mm, reach_mm)
    if np.count_nonzero(bending > 0) >= 2:
        # Along is the direction that bends least or the other way: of an ellipsoid the longest.
        along, across = 0, [1, 2]
        middle = -slopes[across] / values[across]
        level = float(c - (slopes[across] ** 2 / values[across]).sum())
        r = (-level, -2 * float(slopes[along]), -float(values[along]))
        axes = vectors[:, [*across, along]].T
        semi = values[across] ** -0.5
        return [
            RingNet(center, axes, middle, semi, found, np.array([0.0, 1.0]), np.arange(5.0))
            for found in profiles(r, span, float(semi.min()))
        ], False
    if not np.any(bending > 0):
        return _half_space(center, b, c, reach_mm), False
    if bending[0] < 0 and abs(slopes[1]) > _FLAT * size * reach_mm:
        return [_saddle(center, vectors, values, slopes, c, reach_mm)], False
    # The two directions that are left: the one with all of the slope, and one without.
    if bending[0] < 0:
        h_axis, free, bend, slope = vectors[:, 0], vectors[:, 1], values[0], slopes[0]
    else:
        left = vectors[:, :2] @ slopes[:2]
        slope, bend = float(np.linalg.norm(left)), 0.0
        h_axis = left / slope if slope > 0 else vectors[:, 0]
        free = np.cross(vectors[:, 2], h_axis)
    x_axis = vectors[:, 2]
    middle = -float(slopes[2] / values[2])
    level = float(c - slopes[2] ** 2 / values[2])
    r = (-level, -2 * float(slope), -float(bend))
    axes = np.stack([x_axis, h_axis, free])
    width = float(values[2] ** -0.5)
    return [
        StripNet(center, axes, middle, width, found, span) for found in profiles(r, span, width)
    ], False


def _saddle(
    center: Floats, vectors: Floats, values: Floats, slopes: Floats, c: float, reach_mm: float
) -> SaddleNet:
    """Return the net of ``z <= f``, z along the direction that does not bend."""
    x0, y0 = -slopes[2] / values[2], -slopes[0] / values[0]
    level = c - slopes[2] ** 2 / values[2] - slopes[0] ** 2 / values[0]
    steep = 2 * abs(float(slopes[1]))
    bends = (-float(values[2]) / steep, -float(values[0]) / steep)
    x, y = (-reach_mm - x0, reach_mm - x0), (-reach_mm - y0, reach_mm - y0)
    f0 = -float(level) / steep
    lowest = f0 + bends[0] * max(x[0] ** 2, x[1] ** 2)
    axes = np.stack([vectors[:, 2], vectors[:, 0], np.sign(slopes[1]) * vectors[:, 1]])
    origin = center + x0 * vectors[:, 2] + y0 * vectors[:, 0]
    return SaddleNet(origin, axes, bends, f0, x, y, min(lowest, -reach_mm) - reach_mm)


def _half_space(center: Floats, b: Floats, c: float, reach_mm: float) -> list[Net]:
    """Return a box that ends at the plane ``2 b.y + c = 0``."""
    steep = float(np.linalg.norm(b))
    h_axis = b / steep
    x_axis = np.cross(h_axis, np.eye(3)[int(np.argmin(np.abs(h_axis)))])
    x_axis /= np.linalg.norm(x_axis)
    top, far = -c / (2 * steep), 2 * reach_mm
    if top <= -far:
        return []
    axes = np.stack([x_axis, h_axis, np.cross(x_axis, h_axis)])
    profile = Profile((1.0, 0.0, 0.0), (-far, top), (False, False))
    return [StripNet(center, axes, 0.0, far, profile, (-far, far))]
