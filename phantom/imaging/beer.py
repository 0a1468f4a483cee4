"""Beer's law: exp(−Σ_m μ_m L_m), over a spectrum Σ_k w_k exp(−Σ_m μ_km L_m), for every pixel.

Over a spectrum only pixels that have some material are summed; all others are Σ_k w_k. They are
gathered into blocks of one size, the last one filled up with nothing, so that every pixel goes
through the same operations in the same order: its value depends neither on its neighbours nor on
threads, nor on whether a picture is reckoned whole or in bands of rows.
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


def line_integral(lengths: FloatArray, attenuation_per_mm: FloatArray) -> FloatArray:
    """Return Σ_m μ_m L_m of (M, rows, columns) path lengths, as (rows, columns)."""
    return _by_rows(lengths, lambda band, found: _sum(band, attenuation_per_mm, found))


def transmission(
    lengths: FloatArray, attenuation_per_mm: FloatArray, weights: FloatArray
) -> FloatArray:
    """Return the share that is left behind (M, rows, columns) path lengths, as (rows, columns).

    Parameters
    ----------
    lengths
        Path lengths in mm.
    attenuation_per_mm
        (M,) for one energy, (K, M) for a spectrum.
    weights
        (K,) of a spectrum's energies.
    """
    return _by_rows(
        lengths, lambda band, found: band_transmission(band, attenuation_per_mm, weights, found)
    )


def band_transmission(
    lengths: FloatArray, attenuation_per_mm: FloatArray, weights: FloatArray, found: FloatArray
) -> None:
    """Do what :func:`transmission` does, on this thread alone: for a band of rows, into ``found``.

    ``found`` is (rows, columns).
    """
    if attenuation_per_mm.ndim == 1:
        _sum(lengths, -attenuation_per_mm, found)
        np.exp(found, out=found)
        return
    left = np.empty(lengths.shape[1:])
    flat = np.moveaxis(lengths, 0, -1).reshape(-1, len(lengths))
    _Law(attenuation_per_mm, weights[np.newaxis, :]).apply(flat, left.reshape(1, -1))
    # The weights add up to 1 but for rounding; what nothing is in the way of is 1 exactly.
    left /= weights[np.newaxis, :].sum(axis=1)
    np.minimum(left, 1.0, out=found)


def _sum(lengths: FloatArray, attenuation_per_mm: FloatArray, found: FloatArray) -> None:
    """Write Σ_m μ_m L_m of (M, rows, columns) into ``found`` (rows, columns)."""
    from phantom.kernels.beer import add_material

    total = found.reshape(-1)
    for m, attenuation in enumerate(attenuation_per_mm):
        add_material(lengths[m].reshape(-1), float(attenuation), m == 0, total)


def _by_rows(lengths: FloatArray, one: Callable[[FloatArray, FloatArray], None]) -> FloatArray:
    """Apply ``one`` to bands of rows, on all threads."""
    _, rows, columns = lengths.shape
    found = np.empty((rows, columns))

    def work(start: int, end: int) -> None:
        one(lengths[:, start:end], found[start:end])

    run_bands(work, cut_bands(rows, max(1, BAND_PIXELS // max(columns, 1))))
    return found


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
    flat = path_lengths.reshape(-1, materials)
    law = _Law(attenuation_per_mm, weights)
    found = np.empty((len(weights), rows * columns))

    def work(start: int, end: int) -> None:
        law.apply(flat[start:end], found[:, start:end])

    bands = cut_bands(rows * columns, max(BAND_PIXELS, law.block))
    run_bands(work, bands, workers=workers, cancelled=cancelled)
    return found.reshape(len(weights), rows, columns)


class _Law:
    """The sums over a spectrum, block by block."""

    def __init__(self, attenuation_per_mm: FloatArray, weights: FloatArray) -> None:
        attenuation, weights = _merged(attenuation_per_mm, weights)
        self._open_field = weights.sum(axis=1)
        self._exponents = np.ascontiguousarray(-attenuation.T)
        self._weights = np.ascontiguousarray(weights.T)
        self.block = _block_pixels(*attenuation.shape)

    def apply(self, flat: FloatArray, found: FloatArray) -> None:
        """Write (J, pixels) from (pixels, M)."""
        (occupied,) = np.nonzero(flat.any(axis=1))
        found[:] = self._open_field[:, np.newaxis]
        lengths = np.zeros((self.block, flat.shape[1]))
        for first in range(0, len(occupied), self.block):
            chosen = occupied[first : first + self.block]
            lengths[: len(chosen)] = flat[chosen]
            lengths[len(chosen) :] = 0.0
            left = lengths @ self._exponents
            np.exp(left, out=left)
            found[:, chosen] = (left @ self._weights)[: len(chosen)].T


def _merged(attenuation: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return one bin where no material tells the energies apart."""
    if len(attenuation) > 1 and bool(np.all(attenuation == attenuation[0])):
        return attenuation[:1], weights.sum(axis=1, keepdims=True)
    return attenuation, weights


def _block_pixels(energies: int, materials: int) -> int:
    """Return how many pixels make one block: a multiple of 64."""
    return max(64, min(1024, PRODUCT_LIMIT // max(energies * materials, 1) // 64 * 64))
