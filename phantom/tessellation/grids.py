"""A net cut into cells so fine that two triangles each lie within a tolerance of the surface.

How far a cell is off is measured: the surface is sampled within it, and the distance of each
sample from the plane of the triangle over it is taken. Where that is too much, the cell's interval
of u or of v, whichever bends more, is divided, all along the net: so the cells stay a grid, and
neighbours share their edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError, Problem
from phantom.tessellation.nets import Net

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Flags = NDArray[np.bool_]

_LOOKS = (np.array([0.0, 0.24, 0.47, 0.77]), np.array([0.0, 0.13, 0.36, 0.62, 0.88]))
"""Where cells are sampled: first coarsely, then elsewhere. Not evenly, so that no wave hides."""

_SHARE = 0.9
"""Cells are measured to this share of the tolerance: a sample may miss the very highest point."""

_STRAIGHT = np.linspace(0.0, 1.0, 33)
_BEGIN = 4
_MOST_PARTS = 8
_BAND = 1 << 19
MOST_CELLS = 4_000_000


@dataclass(frozen=True)
class Lines:
    """Intervals of one parameter, in order; each within one piece of the net."""

    at: Floats  # (n + 1,)
    piece: Ints  # (n,)

    def sampled(self, fractions: Floats) -> tuple[Floats, Ints]:
        """Spread samples over every interval, and the last end."""
        inner = self.at[:-1, None] + fractions * np.diff(self.at)[:, None]
        return (
            np.append(inner.ravel(), self.at[-1]),
            np.append(np.repeat(self.piece, len(fractions)), self.piece[-1]),
        )

    def divided(self, parts: Ints) -> Lines:
        """Divide every interval into as many equal parts as is said."""
        owner = np.repeat(np.arange(len(parts)), parts)
        first = np.cumsum(parts) - parts
        share = (np.arange(len(owner)) - first[owner]) / parts[owner]
        at = self.at[owner] + share * np.diff(self.at)[owner]
        return Lines(np.append(at, self.at[-1]), self.piece[owner])


@dataclass(frozen=True)
class Grid:
    """A net at the corners of its cells.

    Attributes
    ----------
    u, v
        ``(n + 1,)`` and ``(m + 1,)``; the last v is the first, once round.
    points
        ``(n + 1, m, 3)`` mm.
    rising
        ``(n, m)`` whether a cell is cut from its first corner to its last, or across.
    """

    u: Floats
    v: Floats
    points: Floats
    rising: Flags


def grid(net: Net, tolerance_mm: float) -> Grid:
    """Cut a net so finely that the triangles lie within ``tolerance_mm`` of it.

    Raises
    ------
    InvalidInputError
        At ``/tolerance_mm``, where that takes more than :data:`MOST_CELLS` cells.
    """
    u = _begun(net, tolerance_mm, along=True)
    v = _begun(net, tolerance_mm, along=False)
    target = _SHARE * tolerance_mm
    look = 0
    while True:
        # Before what would be in vain is sampled: a cell that is k times off needs k of them.
        expected = float(len(u.piece) * len(v.piece))
        if expected <= MOST_CELLS:
            more_u, more_v, rising, expected = _judged(net, u, v, _LOOKS[look], target)
        if expected > MOST_CELLS:
            message = (
                f"found {tolerance_mm:g} mm, for which one solid needs some {expected:.2g} cells; "
                f"expected a larger tolerance, for {MOST_CELLS} at most"
            )
            raise InvalidInputError([Problem("/tolerance_mm", "too_fine", message)])
        if more_u.max() == more_v.max() == 1:
            look += 1
            if look == len(_LOOKS):
                break
            continue
        u, v = u.divided(more_u), v.divided(more_v)
    points = net.points(
        u.at, np.append(u.piece, u.piece[-1]), v.at[:-1], np.asarray(v.piece, dtype=np.intp)
    )
    return Grid(u.at, v.at, points, rising)


def _begun(net: Net, tolerance_mm: float, *, along: bool) -> Lines:
    """Return the pieces of one parameter, divided where the net is not straight along them."""
    breaks, other = (net.u_breaks, net.v_breaks) if along else (net.v_breaks, net.u_breaks)
    across = Lines(other, np.arange(len(other) - 1)).sampled(np.array([0.0, 0.5]))
    lines = Lines(breaks, np.arange(len(breaks) - 1))
    parts = np.ones(len(lines.piece), dtype=np.intp)
    for k in range(len(parts)):
        at = lines.at[k] + _STRAIGHT * (lines.at[k + 1] - lines.at[k])
        piece = np.full(len(at), k, dtype=np.intp)
        found = net.points(at, piece, *across) if along else net.points(*across, at, piece)
        found = found if along else np.swapaxes(found, 0, 1)
        chord = found[0] + _STRAIGHT[:, None, None] * (found[-1] - found[0])
        off = float(np.linalg.norm(found - chord, axis=-1).max())
        parts[k] = np.clip(np.ceil(np.sqrt(off / (0.5 * tolerance_mm))), 1, _BEGIN)
    least = 3 if not along or net.ends[0] == "seam" else 1
    while parts.sum() < least:
        parts += 1
    return lines.divided(parts)


def _judged(
    net: Net, u: Lines, v: Lines, fractions: Floats, target: float
) -> tuple[Ints, Ints, Flags, float]:
    """Return into how many parts each interval is to be divided, and each cell's diagonal.

    And how many cells there will be, at least, in the end.
    """
    expected = 0.0
    more_u = np.ones(len(u.piece), dtype=np.intp)
    more_v = np.ones(len(v.piece), dtype=np.intp)
    rising = np.ones((len(u.piece), len(v.piece)), dtype=np.bool_)
    v_at, v_piece = v.sampled(fractions)
    rows = max(1, _BAND // (len(fractions) * len(v_at)))
    for first in range(0, len(u.piece), rows):
        last = min(first + rows, len(u.piece))
        part = Lines(u.at[first : last + 1], u.piece[first:last])
        found = net.points(*part.sampled(fractions), v_at, v_piece)
        off, off_u, off_v, up = _measured(found, fractions)
        rising[first:last] = up
        bad = off > target
        expected += float(np.maximum(off / target, 1.0).sum())
        if not bad.any():
            continue
        # A twist shows along neither side: the longer one is divided.
        step = len(fractions)
        corners = found[::step, ::step]
        long = np.linalg.norm(np.diff(corners, axis=0), axis=-1)
        wide = np.linalg.norm(np.diff(corners, axis=1), axis=-1)
        along = np.maximum(long[:, :-1], long[:, 1:]) >= np.maximum(wide[:-1], wide[1:])
        bent = np.maximum(off_u, off_v) > 0.25 * off
        along = np.where(bent, off_u >= off_v, along)
        worst = np.where(bent, np.maximum(off_u, off_v), off)
        needed = np.ceil(np.sqrt(np.minimum(worst / (0.6 * target), _MOST_PARTS**2)))
        needed = np.where(bad, np.clip(needed, 2, _MOST_PARTS), 1).astype(np.intp)
        more_u[first:last] = np.where(along, needed, 1).max(axis=1)
        more_v = np.maximum(more_v, np.where(along, 1, needed).max(axis=0))
    return more_u, more_v, rising, expected


def _measured(found: Floats, fractions: Floats) -> tuple[Floats, Floats, Floats, Flags]:
    """Measure cells from samples ``(n f + 1, m f + 1, 3)``.

    Returns how far each cell ``(n, m)`` is off in mm, how much of it shows along u and along v, and
    which diagonal is the better one.
    """
    step = len(fractions)
    ends = np.append(fractions, 1.0)
    n, m = (found.shape[0] - 1) // step, (found.shape[1] - 1) // step
    rows = step * np.arange(n)[:, None] + np.arange(step + 1)
    columns = step * np.arange(m)[:, None] + np.arange(step + 1)
    samples = found[rows[:, None, :, None], columns[None, :, None, :]]  # (n, m, s, t, 3)
    a, b = samples[:, :, 0, 0], samples[:, :, -1, 0]
    c, d = samples[:, :, 0, -1], samples[:, :, -1, -1]
    upper = ends[:, None] >= ends
    # From a to d: the triangles a b d, where s >= t, and a d c.
    first, second = _normals(a, b, d), _normals(a, d, c)
    one = _heights(samples, a, first, second, upper)
    # From b to c: the triangles a b c, where s + t <= 1, and b d c.
    first, second = _normals(a, b, c), _normals(b, d, c)
    lower = ends[:, None] + ends <= 1
    two = _heights(samples, b, first, second, lower)
    up = one.max(axis=(2, 3)) <= two.max(axis=(2, 3))
    heights = np.where(up[:, :, None, None], one, two)
    normal = np.cross(d - a, c - b)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = normal / np.where(length > 0, length, 1.0)
    along = _bends(samples, normal, ends, 2)
    across = _bends(samples, normal, ends, 3)
    return heights.max(axis=(2, 3)), along, across, up


def _normals(a: Floats, b: Floats, c: Floats) -> Floats:
    """Unit normals of triangles; zeros where one has no area to speak of."""
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=-1)
    sides = np.maximum(
        np.linalg.norm(b - a, axis=-1) * np.linalg.norm(c - a, axis=-1),
        np.linalg.norm(c - b, axis=-1) ** 2,
    )
    sound = length > 1e-9 * sides
    return np.asarray(
        np.where(sound[..., None], normal / np.where(sound, length, 1.0)[..., None], 0)
    )


def _heights(
    samples: Floats, origin: Floats, first: Floats, second: Floats, of_first: Flags
) -> Floats:
    """Distances of samples from the planes of their triangles; from their point where both fail."""
    none_first: Flags = np.asarray(~first.any(axis=-1))
    none_second: Flags = np.asarray(~second.any(axis=-1))
    first = np.where(none_first[..., None], second, first)
    second = np.where(none_second[..., None], first, second)
    off = samples - origin[:, :, None, None]
    one = np.abs(np.einsum("nmstk,nmk->nmst", off, first))
    two = np.abs(np.einsum("nmstk,nmk->nmst", off, second))
    found = np.where(of_first, one, two)
    both = (none_first & none_second)[:, :, None, None]
    if both.any():
        found = np.where(both, np.linalg.norm(off, axis=-1), found)
    return np.asarray(found)


def _bends(samples: Floats, normal: Floats, ends: Floats, axis: int) -> Floats:
    """How far the surface rises over its chords along one direction, seen across the cell."""
    heights = np.einsum("nmstk,nmk->nmst", samples, normal)
    first = np.take(heights, [0], axis=axis)
    last = np.take(heights, [-1], axis=axis)
    share = ends[:, None] if axis == 2 else ends
    return np.asarray(np.abs(heights - first - share * (last - first)).max(axis=(2, 3)))
