"""Beer's law over a spectrum: Σ_k w_k exp(−Σ_m μ_km L_m) for every pixel.

Only pixels that have some material are summed; all others are Σ_k w_k. They are gathered into
blocks of one size, the last one filled up with nothing, so that every pixel goes through the same
operations in the same order: its value depends neither on its neighbours nor on threads.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.tracing.pool import cut_bands, run_bands

FloatArray = NDArray[np.float64]

BAND_PIXELS: Final = 2**17
"""About how many pixels a thread takes at once."""

PRODUCT_LIMIT: Final = 2**18
"""Most multiplications of one block: larger products would start threads of their own."""


def through_spectrum(
    path_lengths: FloatArray,
    attenuation_per_mm: FloatArray,
    weights: FloatArray,
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FloatArray:
    """Return what is left of a spectrum behind path lengths, weighted and summed.

    Parameters
    ----------
    path_lengths
        (rows, columns, M) mm of each material.
    attenuation_per_mm
        (K, M) linear attenuation of each material at each energy.
    weights
        (J, K) sums to make: what a photon of each energy counts for, times how many there are.
    workers, cancelled
        As in :func:`phantom.tracing.pool.run_bands`.

    Returns
    -------
    numpy.ndarray
        (J, rows, columns).

    Raises
    ------
    CancelledError
        ``cancelled()`` turned true.
    """
    rows, columns, materials = path_lengths.shape
    attenuation, weights = _merged(attenuation_per_mm, weights)
    flat = path_lengths.reshape(-1, materials)
    found = np.empty((len(weights), rows * columns))
    open_field = weights.sum(axis=1)
    exponents = np.ascontiguousarray(-attenuation.T)
    columns_of_weights = np.ascontiguousarray(weights.T)
    block = _block_pixels(*attenuation.shape)

    def work(start: int, end: int) -> None:
        (occupied,) = np.nonzero(flat[start:end].any(axis=1))
        found[:, start:end] = open_field[:, np.newaxis]
        lengths = np.zeros((block, materials))
        for first in range(0, len(occupied), block):
            chosen = start + occupied[first : first + block]
            lengths[: len(chosen)] = flat[chosen]
            lengths[len(chosen) :] = 0.0
            left = lengths @ exponents
            np.exp(left, out=left)
            found[:, chosen] = (left @ columns_of_weights)[: len(chosen)].T

    bands = cut_bands(rows * columns, max(BAND_PIXELS, block))
    run_bands(work, bands, workers=workers, cancelled=cancelled)
    return found.reshape(len(weights), rows, columns)


def _merged(attenuation: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return one bin where no material tells the energies apart."""
    if len(attenuation) > 1 and bool(np.all(attenuation == attenuation[0])):
        return attenuation[:1], weights.sum(axis=1, keepdims=True)
    return attenuation, weights


def _block_pixels(energies: int, materials: int) -> int:
    """Return how many pixels make one block: a multiple of 64."""
    return max(64, min(1024, PRODUCT_LIMIT // max(energies * materials, 1) // 64 * 64))
