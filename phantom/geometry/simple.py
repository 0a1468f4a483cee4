"""Whether a closed outline is simple: no stretch of it crosses or touches another.

The outline is cut into arcs. An arc lies within ``max |c''| dv^2 / 8`` of its chord, so two arcs
are as far apart as their chords less that much on both sides. Near one another along the way arcs
are close in any case, but a curve meets itself only after it has turned by 180 degrees in all:
where a stretch that holds both turns by less, they do not. Pairs of which neither is known are
halved until they are, so nothing hides between samples or on one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.geometry.outlines import Outline
from phantom.geometry.refusal import RefusalError
from phantom.geometry.vectors import dots, plane_cross

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Bools = NDArray[np.bool_]

_ARCS = 192
_DEPTH = 28
_MOST_PAIRS = 400_000
_INSIDE = np.linspace(0.0, 1.0, 5)
_HALF_TURN = np.pi - 1e-9
_SLACK = 1.5  # on bounds that are taken from samples within an arc


@dataclass(frozen=True)
class _Arcs:
    """Short stretches of an outline."""

    piece: Ints  # (n,)
    low: Floats  # (n,) v where each begins
    high: Floats
    place: Ints  # (n,) where each begins, and below where it ends, in units of the last halves
    size: int
    around: int  # the whole way round
    start: Floats  # (n, 2)
    end: Floats
    bulge: Floats  # (n,) how far it may leave its chord
    turn_rad: Floats  # (n,) how far it turns in all
    tangents: Floats  # (n, 2, 2) where it begins and ends

    def halved(self, outline: Outline, chosen: Ints) -> _Arcs:
        """Return the halves of the chosen arcs, two for each in turn."""
        low, high = self.low[chosen], self.high[chosen]
        middle = 0.5 * (low + high)
        half = self.size // 2
        return _arcs(
            outline,
            np.repeat(self.piece[chosen], 2),
            np.stack([low, middle], axis=1).ravel(),
            np.stack([middle, high], axis=1).ravel(),
            (self.place[chosen][:, None] + np.array([0, half])).ravel(),
            half,
            self.around,
        )


def check_simple(outline: Outline) -> None:
    """Refuse an outline that comes to within :data:`tolerances.CONTOUR_GAP_MM` of itself.

    Raises
    ------
    RefusalError
        At ``/contour``, with the place.
    """
    breaks = outline.breaks
    count = len(breaks) - 1
    each = max(2, int(np.ceil(_ARCS / count)))
    edges = breaks[:-1, None] + np.linspace(0, 1, each + 1) * np.diff(breaks)[:, None]
    edges[:, -1] = breaks[1:]
    size = 2**_DEPTH
    arcs = _arcs(
        outline,
        np.repeat(np.arange(count), each),
        edges[:, :-1].ravel(),
        edges[:, 1:].ravel(),
        size * np.arange(count * each),
        size,
        size * count * each,
    )
    one, two = _near(arcs)
    turned = _turned(arcs)
    for _ in range(_DEPTH):
        apart, gap = _judged(arcs, one, two, turned)
        met = np.flatnonzero(gap <= tolerances.CONTOUR_GAP_MM)
        if len(met) or len(one) > _MOST_PAIRS:
            worst = int(met[0]) if len(met) else int(np.argmin(gap))
            raise _refusal(arcs, int(one[worst]), int(two[worst]))
        one, two = one[~apart], two[~apart]
        if not len(one):
            return
        chosen, index = np.unique(np.concatenate([one, two]), return_inverse=True)
        one, two = _halves(index[: len(one)], index[len(one) :])
        arcs = arcs.halved(outline, chosen)


def _arcs(
    outline: Outline, piece: Ints, low: Floats, high: Floats, place: Ints, size: int, around: int
) -> _Arcs:
    v = low[:, None] + (high - low)[:, None] * _INSIDE
    v[:, -1] = high
    found = outline.derivatives(v.ravel(), np.repeat(piece, len(_INSIDE)))
    points, first, second = found.reshape(3, len(low), len(_INSIDE), 2)
    bulge = np.linalg.norm(second, axis=-1).max(axis=1) * (high - low) ** 2 / 8
    # Between two samples it turns as their tangents do, or as its curvature has it.
    angle = _angle(first[:, :-1], first[:, 1:])
    speed = np.linalg.norm(first, axis=-1)
    least = np.maximum(speed, 1e-6 * speed.max() + 1e-300)
    rate = np.abs(plane_cross(first, second)) / least**2
    step = ((high - low) / (len(_INSIDE) - 1))[:, None]
    turn = np.maximum(angle, step * np.maximum(rate[:, :-1], rate[:, 1:])).sum(axis=1)
    return _Arcs(
        piece,
        low,
        high,
        place,
        size,
        around,
        points[:, 0],
        points[:, -1],
        _SLACK * bulge,
        _SLACK * turn,
        first[:, [0, -1]],
    )


def _angle(one: Floats, two: Floats) -> Floats:
    """Return the angles between vectors, 0 to pi."""
    return np.asarray(np.arctan2(np.abs(plane_cross(one, two)), dots(one, two)))


def _turned(arcs: _Arcs) -> Floats:
    """Return how far the outline turns before and after each arc's joints, twice round.

    Entry 2k is where arc k begins, behind the corner there, and 2k + 1 where it ends.
    """
    corners = _angle(np.roll(arcs.tangents[:, 1], 1, axis=0), arcs.tangents[:, 0])
    both = np.tile(np.stack([corners, arcs.turn_rad], axis=1).ravel(), 2)
    return np.cumsum(both)


def _near(arcs: _Arcs) -> tuple[Ints, Ints]:
    """Return the pairs of arcs whose boxes overlap, each arc with itself too."""
    pad = (arcs.bulge + tolerances.CONTOUR_GAP_MM)[:, None]
    low = np.minimum(arcs.start, arcs.end) - pad
    high = np.maximum(arcs.start, arcs.end) + pad
    order = np.argsort(low[:, 0])
    last = np.searchsorted(low[order, 0], high[order, 0], side="right")
    count = last - np.arange(len(order))
    first = np.repeat(np.arange(len(order)), count)
    second = first + np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    one, two = order[first], order[second]
    meet = (low[one, 1] <= high[two, 1]) & (low[two, 1] <= high[one, 1])
    return one[meet], two[meet]


def _judged(arcs: _Arcs, one: Ints, two: Ints, turned: Floats) -> tuple[Bools, Floats]:
    """Return which pairs are known not to meet, and what the others' gap is at most, mm.

    ``turned`` is of the first arcs, of which these are parts.
    """
    distance = _between(arcs.start[one], arcs.end[one], arcs.start[two], arcs.end[two])
    bulge = arcs.bulge[one] + arcs.bulge[two]
    whole = 2**_DEPTH
    first, second = np.sort(np.stack([arcs.place[one], arcs.place[two]]) // whole, axis=0)
    count = arcs.around // whole
    forth = turned[2 * second + 1] - turned[2 * first]
    back = turned[2 * (first + count) + 1] - turned[2 * second]
    straight = np.minimum(forth, back) < _HALF_TURN
    # Arcs next to one another, and an arc with itself, by their own turn.
    same = one == two
    follows = (arcs.place[one] + arcs.size) % arcs.around == arcs.place[two]
    leads = (arcs.place[two] + arcs.size) % arcs.around == arcs.place[one]
    before, after = np.where(follows, one, two), np.where(follows, two, one)
    corner = _angle(arcs.tangents[before, 1], arcs.tangents[after, 0])
    own = np.where(same, 0.0, corner + arcs.turn_rad[two]) + arcs.turn_rad[one]
    joined = same | follows | leads
    apart = distance - bulge > 0.5 * tolerances.CONTOUR_GAP_MM
    apart = np.where(joined, own < _HALF_TURN, apart | straight)
    return apart, np.where(joined | apart, np.inf, distance + bulge)


def _between(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats:
    """Return the distances of segments ab from segments cd; 0 where they cross."""

    def away(p: Floats, start: Floats, end: Floats) -> Floats:
        chord = end - start
        square = np.maximum(dots(chord, chord), 1e-300)
        share = np.clip(dots(p - start, chord) / square, 0.0, 1.0)
        return np.asarray(np.linalg.norm(p - start - share[:, None] * chord, axis=1))

    nearest = np.min([away(a, c, d), away(b, c, d), away(c, a, b), away(d, a, b)], axis=0)
    crossed = plane_cross(b - a, c - a) * plane_cross(b - a, d - a) < 0
    crossed &= plane_cross(d - c, a - c) * plane_cross(d - c, b - c) < 0
    return np.asarray(np.where(crossed, 0.0, nearest))


def _halves(one: Ints, two: Ints) -> tuple[Ints, Ints]:
    """Return the pairs of halves of pairs; an arc's own halves meet once."""
    pairs = [(2 * one + p, 2 * two + q) for p in (0, 1) for q in (0, 1)]
    twice = one == two
    every = np.ones(len(one), dtype=bool)
    keep = [every, every, ~twice, every]
    return (
        np.concatenate([p[k] for (p, _), k in zip(pairs, keep, strict=True)]),
        np.concatenate([q[k] for (_, q), k in zip(pairs, keep, strict=True)]),
    )


def _refusal(arcs: _Arcs, one: int, two: int) -> RefusalError:
    x, y = arcs.start[one]
    shares = sorted(arcs.place[[one, two]] / arcs.around)
    return RefusalError(
        "/contour",
        "crossing_contour",
        f"the contour crosses itself near ({x:.4g}, {y:.4g}) mm, or comes within "
        f"{tolerances.CONTOUR_GAP_MM:g} mm of itself, at {shares[0]:.3f} and {shares[1]:.3f} of "
        "the way round; expected a simple closed curve",
    )
