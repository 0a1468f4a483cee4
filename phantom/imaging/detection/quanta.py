"""Quantum noise: how many photons are stopped, and what signal they give."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from phantom.imaging.detection.draws import QUANTA, NoiseKey, normal, poisson, uniforms
from phantom.imaging.detection.scintillator import PhotonResponse
from phantom.imaging.detection.window import Window
from phantom.imaging.view import FloatArray
from phantom.tracing.pool import cut_bands, run_bands

_BAND: Final = 16384


def compound(
    moments: FloatArray,
    window: Window,
    key: NoiseKey,
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FloatArray:
    """Draw the signal of all bins at once.

    The number of stopped photons N is Poisson, exactly; given N, the signal is normal with N times
    the mean and N times the variance of one photon's signal. Mean and variance of the signal are
    those of the compound Poisson process, ``Σ g λ`` and ``Σ g² λ / A_S``; of its third moment the
    skewness of one photon's signal is left out, which is of order 1/√N. Where every photon gives
    the same signal nothing is approximated.

    Parameters
    ----------
    moments
        (3, rows, columns) expected sums over the bins: stopped photons λ, signal Σ g λ, squared
        signal Σ g² λ / A_S.
    window
        Which pixels they are.
    key
        Whose noise.

    Returns
    -------
    (rows, columns) signal.
    """
    out = np.zeros(moments.shape[1:])

    def band(first: int, last: int) -> None:
        count, signal, square = moments[:, first:last]
        rows = window.row_indices[first:last]
        number, energy = uniforms(key, QUANTA, rows, window.column_indices)
        drawn = poisson(number, count)
        some = np.maximum(count, np.finfo(np.float64).tiny)
        mean = signal / some
        # Rounding leaves a variance just off 0 where every photon gives the same signal.
        variance = square / some - mean * mean
        variance[variance < 1e-12 * mean * mean] = 0.0
        out[first:last] = mean * drawn
        if variance.any():
            out[first:last] += np.sqrt(variance * drawn) * normal(energy)

    height = max(1, _BAND // max(window.columns, 1))
    run_bands(band, cut_bands(window.rows, height), workers=workers, cancelled=cancelled)
    return out


def per_bin(
    photons: FloatArray,
    response: PhotonResponse,
    window: Window,
    key: NoiseKey,
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FloatArray:
    """Draw every bin by itself; slow, and exact but for the shape of Swank's spread.

    The spread of the photons' gains is drawn once a pixel as a normal number whose variance is that
    of the photons that were drawn.

    Parameters
    ----------
    photons
        (K, rows, columns) expected stopped photons of every bin.
    response
        What they give.
    """
    out = np.zeros(photons.shape[1:])

    def band(first: int, last: int) -> None:
        rows = window.row_indices[first:last]
        spread = np.zeros((last - first, window.columns))
        luck = spread
        for k, (expected, gain) in enumerate(zip(photons, response.gain.tolist(), strict=True)):
            one, other = uniforms(key, QUANTA, rows, window.column_indices, draw=1 + k // 2)
            drawn = poisson(other if k % 2 else one, expected[first:last])
            out[first:last] += gain * drawn
            spread += gain * gain * drawn
        if response.excess > 0:
            _, luck = uniforms(key, QUANTA, rows, window.column_indices)
            out[first:last] += np.sqrt(response.excess * spread) * normal(luck)

    height = max(1, _BAND // max(window.columns, 1))
    run_bands(band, cut_bands(window.rows, height), workers=workers, cancelled=cancelled)
    return out
