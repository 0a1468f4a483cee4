"""The paper's frame, with its special cases (section III.B).

n points to the centre of curvature. Where the curvature is zero:

* a straight stretch at an end takes the frame of its one neighbour; one between two curved
  stretches turns from one frame to the other by the shorter angle, evenly in u;
* at an isolated inflection n jumps to the other side: the axis is cut there, each side keeps its
  own limit, and a warning says so;
* an axis that is straight throughout has no Frenet frame: it gets the rotation-minimizing one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.geometry.curves import Curve, sample_parameters
from phantom.geometry.vectors import dots, unit

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_PER_PIECE = 257
_ORDERS = 8
_VANISHED = 1e-9
_JUMP_RAD = 1e-6
_SPIKE_DEG = 90.0
_SPIKE_SHARE = 0.03


@dataclass(frozen=True)
class SplitCurve:
    """A curve cut at further places; a piece is a stretch of one of the inner pieces."""

    inner: Curve
    breaks: Floats
    owners: Ints

    @property
    def closed(self) -> bool:
        """As the inner curve."""
        return self.inner.closed

    def derivatives(self, u: Floats, piece: Ints, order: int) -> Floats:
        """Evaluate the inner curve's own piece."""
        return self.inner.derivatives(u, self.owners[piece], order)


@dataclass(frozen=True)
class FrenetFrame:
    """n by piece: from the curvature, or turning evenly over a straight stretch."""

    curve: Curve
    length: float
    straight: NDArray[np.bool_]  # (pieces,)
    origin: Floats  # (pieces, 3) n where the straight stretch begins
    range: Floats  # (pieces, 2) u where it begins and ends
    turn_rad: Floats  # (pieces,) how far n turns over it

    def normals(self, u: Floats, piece: Ints) -> Floats:
        """Return the unit vectors n ``(n, 3)``."""
        result = np.empty((len(u), 3))
        flat = self.straight[piece]
        if np.any(~flat):
            result[~flat] = curved_normals(self.curve, u[~flat], piece[~flat], self.length)
        if np.any(flat):
            at, k = u[flat], piece[flat]
            t = unit(self.curve.derivatives(at, k, 1)[1])
            n = unit(self.origin[k] - t * dots(self.origin[k], t)[:, None])
            share = (at - self.range[k, 0]) / (self.range[k, 1] - self.range[k, 0])
            angle = (share * self.turn_rad[k])[:, None]
            result[flat] = np.cos(angle) * n + np.sin(angle) * np.cross(t, n)
        return result


def curved_normals(curve: Curve, u: Floats, piece: Ints, length: float) -> Floats:
    """Return n where the axis is curved, and its one-sided limit where the curvature vanishes.

    Near a zero at u0 the first derivative of order k > 2 that does not vanish leads:
    ``a''(u) ~ a^(k)(u0) (u - u0)^(k-2)``, so the side of u0 gives the sign.
    """
    _, first, second = curve.derivatives(u, piece, 2)
    speed = np.linalg.norm(first, axis=1)
    t = first / speed[:, None]
    bend = second - t * dots(second, t)[:, None]
    gone = np.linalg.norm(bend, axis=1) * length < _VANISHED * speed**2
    if gone.any():
        middle = 0.5 * (curve.breaks[piece[gone]] + curve.breaks[piece[gone] + 1])
        right = u[gone] <= middle
        higher = curve.derivatives(u[gone], piece[gone], _ORDERS)
        found = np.zeros((int(gone.sum()), 3))
        done = np.zeros(len(found), dtype=bool)
        for order in range(3, _ORDERS + 1):
            v = higher[order] - t[gone] * dots(higher[order], t[gone])[:, None]
            size = np.linalg.norm(v, axis=1) * length ** (order - 1)
            leads = ~done & (size > 1e-6 * speed[gone] ** order)
            sign = np.where(right, 1.0, (-1.0) ** order)
            found[leads] = (sign[:, None] * v)[leads]
            done |= leads
        bend[gone] = np.where(done[:, None], found, bend[gone])
    return unit(bend)


def frenet(curve: Curve) -> tuple[Curve, FrenetFrame, tuple[str, ...]] | None:
    """Build the frame; None where the axis is straight throughout.

    Returns the axis cut at its inflections, the frame over it, and what a person should know.
    """
    u, piece = sample_parameters(curve.breaks, _PER_PIECE)
    _, first, second = curve.derivatives(u, piece, 2)
    speed = np.linalg.norm(first, axis=1).reshape(-1, _PER_PIECE)
    length = float(np.sum(speed.mean(axis=1) * np.diff(curve.breaks)))
    turned = (np.cross(first, second) / np.linalg.norm(first, axis=1)[:, None] ** 3).reshape(
        -1, _PER_PIECE, 3
    )
    size = np.linalg.norm(turned, axis=-1) * length
    straight = size.max(axis=1) < tolerances.STRAIGHT
    if straight.all():
        return None
    places: list[float] = []
    for k in np.flatnonzero(~straight):
        grid = u.reshape(-1, _PER_PIECE)[k]
        opposed = dots(turned[k, 1:], turned[k, :-1]) < 0
        vanishing = size[k, 1:-1] < 1e-3 * tolerances.STRAIGHT
        for i in np.flatnonzero(opposed):
            place = _inflection(curve, int(k), grid[i], grid[i + 1])
            if place is not None:
                places.append(place)
        places += [float(grid[i + 1]) for i in np.flatnonzero(vanishing)]
    breaks = np.unique(np.concatenate([curve.breaks, places]))
    span = breaks[-1] - breaks[0]
    keep = np.append(np.diff(breaks) > 1e-12 * span, True)
    keep[0] = True
    breaks = breaks[keep]
    breaks[-1] = curve.breaks[-1]
    owners = np.searchsorted(curve.breaks, 0.5 * (breaks[:-1] + breaks[1:]), side="right") - 1
    cut = SplitCurve(curve, breaks, owners)
    frame = _over_straights(cut, straight[owners], length)
    return cut, frame, _warnings(cut, frame)


def _inflection(curve: Curve, piece: int, low: float, high: float) -> float | None:
    """Find where the curvature vanishes between two opposed binormals, or None if it does not."""

    def binormal(u: float) -> Floats:
        _, first, second = curve.derivatives(np.array([u]), np.array([piece]), 2)[:, 0]
        return np.asarray(np.cross(first, second) / np.linalg.norm(first) ** 3)

    before = binormal(low)
    start = float(np.linalg.norm(before))
    for _ in range(80):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if binormal(middle) @ before > 0:
            low = middle
        else:
            high = middle
    return high if np.linalg.norm(binormal(high)) < 1e-6 * start else None


def _over_straights(curve: SplitCurve, straight: NDArray[np.bool_], length: float) -> FrenetFrame:
    """Give every straight stretch its neighbours' frames to turn between."""
    count = len(straight)
    origin, span, turn = np.zeros((count, 3)), np.zeros((count, 2)), np.zeros(count)
    span[:, 1] = 1.0

    def limit(k: int, end: int) -> Floats:
        at = curve.breaks[[k + end]]
        return np.asarray(curved_normals(curve, at, np.array([k]), length)[0])

    first_curved = int(np.argmin(straight))
    total = curve.breaks[-1] - curve.breaks[0]
    k = first_curved
    while k < first_curved + count:
        if not straight[k % count]:
            k += 1
            continue
        stop = k
        while stop < first_curved + count and straight[stop % count]:
            stop += 1
        run = range(k, stop)
        # On an open axis a run never goes on past the seam.
        for part in [run] if curve.closed else _without_seam(run, count):
            before, after = (part[0] - 1), part[-1] + 1
            has_before = curve.closed or part[0] % count != 0
            has_after = curve.closed or part[-1] % count != count - 1
            n0 = limit(before % count, 1) if has_before else limit(after % count, 0)
            n1 = limit(after % count, 0) if has_after else n0
            tangent = unit(
                curve.derivatives(curve.breaks[[part[0] % count]], np.array([part[0] % count]), 1)[
                    1
                ]
            )[0]
            angle = float(np.arctan2(n1 @ np.cross(tangent, n0), n1 @ n0))
            begin = curve.breaks[part[0] % count]
            width = sum(float(np.diff(curve.breaks)[j % count]) for j in part)
            for j in part:
                wrapped = total if j % count < part[0] % count else 0.0
                origin[j % count] = n0
                span[j % count] = (begin - wrapped, begin + width - wrapped)
                turn[j % count] = angle
        k = stop
    return FrenetFrame(curve, length, straight, origin, span, turn)


def _without_seam(run: range, count: int) -> list[range]:
    inside = [j for j in run if j < count]
    beyond = [j - count for j in run if j >= count]
    return [range(part[0], part[-1] + 1) for part in (inside, beyond) if part]


def _warnings(curve: SplitCurve, frame: FrenetFrame) -> tuple[str, ...]:
    """Say in words where the frame jumps, and where it turns faster than anyone would want."""
    found = []
    pieces = np.arange(len(curve.owners))
    starts = frame.normals(curve.breaks[:-1], pieces)
    ends = frame.normals(curve.breaks[1:], pieces)
    pairs = [(k, k + 1) for k in pieces[:-1]] + ([(len(pieces) - 1, 0)] if curve.closed else [])
    for k, following in pairs:
        angle = float(np.arccos(np.clip(ends[k] @ starts[following], -1, 1)))
        if angle > _JUMP_RAD:
            found.append(
                f"the frenet frame jumps by {np.degrees(angle):.4g} degrees at "
                f"u = {curve.breaks[k + 1]:.6g}"
            )
    u, piece = sample_parameters(curve.breaks, _PER_PIECE)
    n = frame.normals(u, piece)
    step = np.arccos(np.clip(dots(n[1:], n[:-1]), -1, 1))
    # Jumps were told above; within pieces, how far n turns over a short stretch of the axis.
    turned = np.concatenate([[0.0], np.cumsum(np.where(piece[1:] == piece[:-1], step, 0.0))])
    ahead = np.searchsorted(u, u + _SPIKE_SHARE * (u[-1] - u[0]), side="right") - 1
    turn = np.degrees(turned[ahead] - turned)
    worst = int(np.argmax(turn))
    if turn[worst] > _SPIKE_DEG:
        found.append(
            f"the frenet frame turns by {turn[worst]:.3g} degrees between u = {u[worst]:.6g} and "
            f"{u[ahead[worst]]:.6g}, where the axis is nearly straight"
        )
    return tuple(found)
