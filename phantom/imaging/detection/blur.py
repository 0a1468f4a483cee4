"""The detector's blur: a modulation transfer function, applied as sums over near pixels.

The MTF asked for is written as a sum of gaussians with weights above 0 (both shapes are mixtures
of gaussians), and each gaussian is two short sums, along rows and down columns. A kernel
is the inverse transform of its MTF up to the Nyquist frequency, so that the image has the MTF asked
for up to there whatever the pitch. Direct sums over a finite number of pixels, rather than
a Fourier transform of the image: a pixel depends on its neighbours alone, bit for bit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.detection.receptor import Blur
from phantom.imaging.view import FloatArray
from phantom.tracing.pool import cut_bands, run_bands

TRUNCATION: Final = 1.5e-3
"""Greatest error that cutting a kernel off leaves in its MTF, up to nine tenths of the Nyquist
frequency; next to that frequency, where a kernel's repeated MTF has a kink, five times as much."""

LONGEST: Final = 256
"""Greatest reach of a kernel in pixels; a blur that needs more is refused."""

_FIRST_LN_T: Final = math.log(0.002)
_STEP_LN_T: Final = 1.0
_TERMS: Final = 9


@dataclass(frozen=True)
class Part:
    """One gaussian of a blur: its weight, and its kernels along a row and down a column."""

    weight: float
    across: tuple[float, ...]
    down: tuple[float, ...]


def mtf(blur: Blur, frequencies_per_mm: FloatArray) -> FloatArray:
    """Return the modulation transfer function asked for, at frequencies in line pairs per mm."""
    ratio = np.asarray(frequencies_per_mm, dtype=np.float64) / blur.half_frequency_per_mm
    if blur.shape == "gaussian":
        return np.exp2(-(ratio**2))
    return 1 / (1 + ratio**2)


@lru_cache(maxsize=32)
def parts(blur: Blur, pitch_xy_mm: tuple[float, float]) -> tuple[Part, ...]:
    """Return the gaussians of a blur on pixels of this pitch.

    Raises
    ------
    InvalidInputError
        The blur reaches farther than :data:`LONGEST` pixels.
    """
    found = mixture(blur)
    return tuple(
        Part(
            weight,
            # A gaussian of little weight may be cut off sooner.
            *(kernel(sigma_mm / p, TRUNCATION / (len(found) * weight)) for p in pitch_xy_mm),
        )
        for weight, sigma_mm in found
    )


def mixture(blur: Blur) -> list[tuple[float, float]]:
    """Return weights, which add to one, and standard deviations in mm of gaussians.

    Their MTFs are ``exp(−2π²σ²f²)``. For the lorentzian ``1/(1 + x) = ∫ exp(−t − t x) dt``, summed
    at steps of ln t, what is left put into no blur: within 0.001 of it at every frequency.
    """
    if blur.shape == "gaussian":
        return [(1.0, math.sqrt(math.log(2) / 2) / (math.pi * blur.half_frequency_per_mm))]
    t = np.exp(_FIRST_LN_T + _STEP_LN_T * np.arange(_TERMS))
    weights = _STEP_LN_T * t * np.exp(-t)
    sigmas = np.sqrt(t / 2) / (math.pi * blur.half_frequency_per_mm)
    left = 1 - float(weights.sum())
    return [(left, 0.0), *zip(weights.tolist(), sigmas.tolist(), strict=True)]


def kernel(sigma_pixels: float, tolerance: float = TRUNCATION) -> tuple[float, ...]:
    """Return the odd number of weights, adding to one, of a gaussian blur along one axis.

    ``k[n] = ∫ exp(−2π²σ²f²) cos 2πfn df`` over −1/2 … 1/2 cycles a pixel, cut off where what is
    left out changes the MTF by less than ``tolerance``.
    """
    frequencies = (np.arange(2048) + 0.5) / 4096
    wanted = np.exp(-2 * math.pi**2 * sigma_pixels**2 * frequencies**2)
    waves = np.cos(2 * math.pi * np.outer(np.arange(LONGEST + 1), frequencies))
    taps = waves @ wanted / len(frequencies)
    twice = np.where(np.arange(LONGEST + 1) > 0, 2.0, 1.0) * taps
    reached = np.cumsum(twice[:, None] * waves, axis=0) / np.cumsum(twice)[:, None]
    allowed = tolerance * np.where(frequencies < 0.45, 1.0, 5.0)
    errors = (np.abs(reached - wanted) / allowed).max(axis=1)
    good = np.flatnonzero(errors < 1)
    if not len(good):
        message = f"found a blur that reaches over {LONGEST} pixels; expected a higher half value"
        path = "/acquisition/detector/blur/half_frequency_per_mm"
        raise InvalidInputError([Problem(path, "out_of_range", message)])
    half = taps[: good[0] + 1]
    whole = np.concatenate([half[:0:-1], half])
    return tuple((whole / whole.sum()).tolist())


def halo(blur: Blur | None, pitch_xy_mm: tuple[float, float]) -> tuple[int, int]:
    """Return how many rows and columns beyond a window the blur reaches."""
    if blur is None:
        return 0, 0
    found = parts(blur, pitch_xy_mm)
    return max(len(p.down) // 2 for p in found), max(len(p.across) // 2 for p in found)


def blurred(
    image: FloatArray,
    blur: Blur,
    pitch_xy_mm: tuple[float, float],
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FloatArray:
    """Return the blurred image, mirrored at its edges.

    Pixels nearer than :func:`halo` to an edge that is not the detector's are not what the whole
    image would give; the caller computes them and throws them away.
    """
    from scipy.ndimage import correlate1d

    found = parts(blur, pitch_xy_mm)
    layers: list[FloatArray] = [image] * len(found)

    def one(first: int, last: int) -> None:
        for at in range(first, last):
            for axis, taps in enumerate((found[at].down, found[at].across)):
                if len(taps) > 1:
                    layers[at] = correlate1d(layers[at], taps, axis=axis, mode="reflect")

    run_bands(one, cut_bands(len(found), 1), workers=workers, cancelled=cancelled)
    out = np.zeros(image.shape)
    for part, layer in zip(found, layers, strict=True):
        out += part.weight * layer
    return out
