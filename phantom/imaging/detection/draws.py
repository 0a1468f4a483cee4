"""What is drawn at a pixel: uniform numbers, and from them normal and Poisson ones.

Each is the inverse of a distribution at a uniform number. So two images with the same key share
their luck, and where they expect the same they are the same (common random numbers).
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from phantom.document.asked import Asked
from phantom.document.base import Integer, told
from phantom.imaging.detection.philox import Words, fractions, philox4x32
from phantom.imaging.view import FloatArray

QUANTA: Final = 0
"""The stage that draws photons and what they give."""

ELECTRONICS: Final = 1
"""The stage that draws electronic noise."""

_FEW: Final = 12.0
"""Means below this are inverted by adding up probabilities."""

_UNSURE: Final = (1.0, 0.01)
"""a, b: the expansion is checked nearer than (a + b|w|⁵)/mean^1.5 to a whole number.

Its error was measured to be less than half of that for every mean from 12 and |w| up to 5."""

_FAR: Final = (5.0, 1e4)
"""Quantiles of the normal distribution beyond the first are checked, up to the mean of the second.

Farther up the expansion is better there than scipy's distribution function."""


_Long = Annotated[Integer, Field(ge=0, lt=2**64)]
_Short = Annotated[Integer, Field(ge=0, lt=2**32)]


class NoiseKey(Asked):
    """What an image's noise depends on; two keys that differ have independent noise."""

    place: ClassVar[str] = "/noise"

    seed: Annotated[_Long, told("Seed", "none", "The user's choice.")] = 0
    case: Annotated[_Long, told("Case", "none", "Which phantom of a series.")] = 0
    view: Annotated[_Short, told("View", "none", "Which view of the case.")] = 0
    eye: Annotated[_Short, told("Eye", "none", "Which eye of a pair.")] = 0

    @property
    def words(self) -> tuple[int, int]:
        """The generator's key: two words that mix all four numbers."""
        low, high = self.case & 0xFFFFFFFF, self.case >> 32
        counter = [np.array(w, dtype=np.uint64) for w in (low, high, self.view, self.eye)]
        mixed = philox4x32(
            (counter[0], counter[1], counter[2], counter[3]),
            (self.seed & 0xFFFFFFFF, self.seed >> 32),
        )
        return int(mixed[0]), int(mixed[1])


def uniforms(
    key: NoiseKey,
    stage: int,
    rows: NDArray[np.integer],
    columns: NDArray[np.integer],
    draw: int = 0,
) -> tuple[FloatArray, FloatArray]:
    """Return two independent (R, C) arrays of uniform numbers inside (0, 1).

    Parameters
    ----------
    key, stage, draw
        Whose noise, which step of the chain, and which of several draws of that step.
    rows, columns
        (R,) and (C,) indices of the pixels on the whole detector, from 0.
    """
    shape = (len(rows), len(columns))
    across = np.broadcast_to(np.asarray(columns, dtype=np.uint64), shape)
    down = np.broadcast_to(np.asarray(rows, dtype=np.uint64)[:, None], shape)
    step: Words = np.full(shape, stage, dtype=np.uint64)
    which: Words = np.full(shape, draw, dtype=np.uint64)
    a, b, c, d = philox4x32((across, down, step, which), key.words)
    return fractions(a, b), fractions(c, d)


def normal(uniform: FloatArray) -> FloatArray:
    """Return standard normal numbers, the inverse of their distribution at ``uniform``."""
    from scipy.special import ndtri

    found: FloatArray = ndtri(uniform)
    return found


def poisson(uniform: FloatArray, mean: FloatArray) -> FloatArray:
    """Return Poisson numbers: the least n with P(N ≤ n) ≥ ``uniform``; they rise with the mean.

    Exact to the rounding of the distribution itself. For larger means the expansion of M. B. Giles,
    *Algorithm 955*, ACM Trans. Math. Softw. 42 (2016) 10, doi:10.1145/2699466, equation 10, gives a
    number whose integer part is n; where that lies near a whole number n is checked against the
    distribution. A mean of 0, or below, gives 0.

    Parameters
    ----------
    uniform
        Numbers inside (0, 1), of any shape.
    mean
        Of the same shape, finite.
    """
    out = np.zeros(mean.shape)
    few = (mean > 0) & (mean < _FEW)
    if few.any():
        out[few] = _by_adding(uniform[few], mean[few])
    many = mean >= _FEW
    if many.all():
        return _by_expansion(uniform.ravel(), mean.ravel()).reshape(mean.shape)
    if many.any():
        out[many] = _by_expansion(uniform[many], mean[many])
    return out


def _by_adding(uniform: FloatArray, mean: FloatArray) -> FloatArray:
    """Add up P(N = 0), P(N = 1), … until they reach ``uniform``."""
    out = np.zeros(len(mean))
    left = np.arange(len(mean))
    probability = np.exp(-mean)
    total = probability.copy()
    n = 0
    # P(N > 80) is below 2^-52 for every mean served here, so that the sum has reached u by then.
    while n < 80:
        open_ = uniform[left] > total
        if not open_.any():
            break
        n += 1
        left, total = left[open_], total[open_]
        probability = probability[open_] * mean[left] / n
        total = total + probability
        out[left] = n
    return out


def _by_expansion(uniform: FloatArray, mean: FloatArray) -> FloatArray:
    w = normal(uniform)
    root = np.sqrt(mean)
    square = w * w
    x = mean + root * w + (1 / 3 + square / 6) - w * (1 / 36 + square / 72) / root
    x += (-8 / 405 + square * (7 / 810 + square / 270)) / mean
    n = np.floor(x)
    nearness = np.abs(x - np.rint(x)) * (mean * root)
    unsure = nearness < _UNSURE[0] + _UNSURE[1] * square * square * np.abs(w)
    unsure |= (np.abs(w) > _FAR[0]) & (mean < _FAR[1])
    at = np.flatnonzero(unsure)
    n[at] = _checked(uniform[at], mean[at], np.rint(x[at]))
    return n


def _checked(uniform: FloatArray, mean: FloatArray, guess: FloatArray) -> FloatArray:
    """Step from a guess to the least n with P(N ≤ n) ≥ ``uniform``."""
    from scipy.special import pdtr

    n = np.maximum(guess, 0.0)
    moving = np.arange(len(n))
    while len(moving):
        short = pdtr(n[moving], mean[moving]) < uniform[moving]
        n[moving[short]] += 1
        moving = moving[short]
    moving = np.flatnonzero(n > 0)
    while len(moving):
        long = pdtr(n[moving] - 1, mean[moving]) >= uniform[moving]
        moving = moving[long]
        n[moving] -= 1
        moving = moving[n[moving] > 0]
    return n
