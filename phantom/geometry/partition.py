"""Any simple closed outline as a union of outlines that are star-shaped.

A contour that no single point sees whole (a C, a kidney, a spiral) is cut by straight chords into
parts that are. Parts reach over their chords by :data:`OVERLAP`, far below the tolerance of the
surface, so that no ray slips between two of them; a ray's intervals are united afterwards.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from phantom.geometry.outlines import Outline

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Star = TypeVar("Star")

OVERLAP = 2e-9
"""Parts reach over the line that cuts them by this share of the outline's size."""

_SAMPLES = 24
_MOST_PARTS = 256


@dataclass(frozen=True)
class Arc:
    """A stretch of a piece of an outline, or a straight edge (``piece`` = -1)."""

    piece: int
    start: float
    end: float
    points: Floats  # (2, 2): where it begins and ends


Loop = tuple[Arc, ...]


@dataclass(frozen=True)
class LoopOutline:
    """A loop of arcs as an outline; arc k covers ``k <= v <= k + 1``."""

    outline: Outline
    loop: Loop

    @property
    def breaks(self) -> Floats:
        """The ends of the arcs."""
        return np.arange(len(self.loop) + 1.0)

    @cached_property
    def _columns(self) -> tuple[NDArray[np.bool_], Floats, Ints, Floats, Floats]:
        """Of each arc: whether it is straight, its ends, its piece, where it starts, its length."""
        loop = self.loop
        return (
            np.array([arc.piece < 0 for arc in loop]),
            np.array([arc.points for arc in loop]),
            np.array([max(arc.piece, 0) for arc in loop], dtype=np.intp),
            np.array([arc.start for arc in loop]),
            np.array([arc.end - arc.start for arc in loop]),
        )

    def derivatives(self, v: Floats, piece: Ints) -> Floats:
        """Evaluate each arc on its own stretch."""
        straights, all_ends, owners, starts, rates = self._columns
        straight, ends, owner = straights[piece], all_ends[piece], owners[piece]
        start, rate = starts[piece], rates[piece]
        local = v - piece
        parameter = np.where(straight, self.outline.breaks[owner], start + local * rate)
        found = self.outline.derivatives(parameter, owner)
        found[1] *= rate[:, None]
        found[2] *= (rate**2)[:, None]
        if straight.any():
            edge = ends[straight, 1] - ends[straight, 0]
            found[0, straight] = ends[straight, 0] + local[straight, None] * edge
            found[1, straight], found[2, straight] = edge, 0.0
        return found


def whole(outline: Outline) -> Loop:
    """Return an outline as a loop of its own pieces."""
    breaks = outline.breaks
    pieces = np.arange(len(breaks) - 1)
    starts = outline.derivatives(breaks[:-1], pieces)[0]
    ends = outline.derivatives(breaks[1:], pieces)[0]
    return tuple(
        Arc(int(k), float(breaks[k]), float(breaks[k + 1]), np.stack([starts[k], ends[k]]))
        for k in pieces
    )


def star_parts(outline: Outline, as_star: Callable[[Outline], Star | None]) -> list[Star] | None:
    """Cut an outline into parts of which ``as_star`` makes something; None where that fails."""
    waiting, done = [whole(outline)], []
    while waiting:
        loop = waiting.pop()
        part = as_star(LoopOutline(outline, loop))
        if part is not None:
            done.append(part)
            continue
        if len(waiting) + len(done) >= _MOST_PARTS:
            return None
        halves = _halved(outline, loop)
        if halves is None:
            return None
        waiting += halves
    return done


def _halved(outline: Outline, loop: Loop) -> list[Loop] | None:
    """Cut a loop in two along the shortest chord that leaves a fair part on both sides."""
    part = LoopOutline(outline, loop)
    owner = np.repeat(np.arange(len(loop)), _SAMPLES)
    v = np.asarray(owner + np.tile(np.arange(_SAMPLES) / _SAMPLES, len(loop)), dtype=np.float64)
    points = part.derivatives(v, owner)[0]
    area = abs(_area(points))
    spread = np.cov(points.T)
    long = np.linalg.eigh(spread)[1][:, 1]
    best: tuple[float, Floats, float, tuple[int, int]] | None = None
    # Lines across the long direction first, turned a little for those that touch corners.
    for turn in (0.0, 0.4, -0.4, 0.8, -0.8, 1.2, -1.2, np.pi / 2):
        normal = np.array(
            [
                np.cos(turn) * long[0] - np.sin(turn) * long[1],
                np.sin(turn) * long[0] + np.cos(turn) * long[1],
            ]
        )
        heights = points @ normal
        for level in np.quantile(heights, [0.5, 0.35, 0.65, 0.2, 0.8]) + 1e-7 * np.ptp(heights):
            for ends, length, share in _chords(points, heights - level, normal):
                smaller = min(share, area - share) / area
                cost = length / np.sqrt(max(smaller, 1e-9))
                if smaller >= 0.02 and (best is None or cost < best[0]):
                    best = (cost, normal, float(level), ends)
    if best is None:
        return None
    _, normal, level, ends = best
    brackets = [(int(owner[k]), float(v[k]), bool(points[k] @ normal < level)) for k in ends]
    return _cut(part, brackets, normal, level, OVERLAP * float(np.ptp(points, axis=0).max()))


def _chords(
    points: Floats, heights: Floats, normal: Floats
) -> list[tuple[tuple[int, int], float, float]]:
    """Chords of a sampled loop along a line: sample before each end, length, area on one side."""
    after = np.roll(heights, -1)
    crossing = np.flatnonzero(heights * after < 0)
    if len(crossing) < 2 or len(crossing) % 2 or np.any(heights == 0):
        return []
    share = heights[crossing] / (heights[crossing] - after[crossing])
    following = np.roll(points, -1, axis=0)
    met = points[crossing] + share[:, None] * (following[crossing] - points[crossing])
    along = np.array([-normal[1], normal[0]])
    order = np.argsort(met @ along)
    # Between the first and the second crossing the line is inside, between the third and fourth...
    result = []
    for one, two in zip(order[::2], order[1::2], strict=True):
        first, last = sorted((one, two))
        between = points[crossing[first] + 1 : crossing[last] + 1]
        side = np.vstack([met[first][None], between, met[last][None]])
        ends = (int(crossing[one]), int(crossing[two]))
        result.append((ends, float(np.linalg.norm(met[two] - met[one])), abs(_area(side))))
    return result


def _area(points: Floats) -> float:
    x, y = points.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _cut(
    part: LoopOutline,
    brackets: list[tuple[int, float, bool]],
    normal: Floats,
    level: float,
    beyond: float,
) -> list[Loop]:
    """Cut a loop in two along one chord; each part reaches a little beyond the line."""
    halves = []
    for first, last in ((0, 1), (1, 0)):
        # Where the outline rises through the line, the part that follows lies above it.
        at = level - beyond if brackets[first][2] else level + beyond
        ends = []
        for k in (first, last):
            index, v, _ = brackets[k]
            ends.append((index, *_meet(part, index, v, normal, at)))
        halves.append(_side(part.loop, ends[0], ends[1]))
    return halves


def _meet(
    part: LoopOutline, index: int, v: float, normal: Floats, level: float
) -> tuple[float, Floats]:
    """Find where an arc meets a line within a sample's stretch; its own parameter, and the point.

    The stretch is divided ever finer at the first change of side.
    """
    low, high = v, v + 1.0 / _SAMPLES
    for _ in range(14):
        near = np.linspace(low, high, 17)
        heights = part.derivatives(near, np.full(17, index, dtype=np.intp))[0] @ normal - level
        changed = np.flatnonzero(heights * heights[0] <= 0)
        k = max(int(changed[0]), 1) if len(changed) else 16
        low, high = float(near[k - 1]), float(near[k])
    point = part.derivatives(np.array([low]), np.array([index], dtype=np.intp))[0][0]
    arc = part.loop[index]
    local = low - index
    return (local if arc.piece < 0 else arc.start + local * (arc.end - arc.start)), point


def _side(loop: Loop, one: tuple[int, float, Floats], two: tuple[int, float, Floats]) -> Loop:
    """Return the loop that runs from ``one`` along the outline to ``two`` and back by the chord."""
    arcs: list[Arc] = []
    first, last = one[0], two[0]
    if first == last and _before(loop[first], one[1], two[1]):
        arcs.append(_stretch(loop[first], one, two))
    else:
        arcs.append(_stretch(loop[first], one, None))
        index = (first + 1) % len(loop)
        while index != last:
            arcs.append(loop[index])
            index = (index + 1) % len(loop)
        arcs.append(_stretch(loop[last], None, two))
    return (*arcs, Arc(-1, 0.0, 1.0, np.stack([two[2], one[2]])))


def _before(arc: Arc, one: float, two: float) -> bool:
    return (two > one) == (arc.end > arc.start) if arc.piece >= 0 else two > one


def _stretch(
    arc: Arc, one: tuple[int, float, Floats] | None, two: tuple[int, float, Floats] | None
) -> Arc:
    start = arc.start if one is None else one[1]
    end = arc.end if two is None else two[1]
    begin = arc.points[0] if one is None else one[2]
    finish = arc.points[1] if two is None else two[2]
    if arc.piece < 0:
        return Arc(-1, 0.0, 1.0, np.stack([begin, finish]))
    return Arc(arc.piece, start, end, np.stack([begin, finish]))
