"""The primary image: Beer's law over the spectrum, averaged over each pixel's samples."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from phantom.imaging.beer import through_spectrum
from phantom.imaging.view import FloatArray


def primary(
    path_lengths: FloatArray,
    attenuation_per_mm: FloatArray,
    weights: FloatArray,
    samples: tuple[int, int] = (1, 1),
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FloatArray:
    """Return what the transmitted photons sum to, with each of several weights.

    Intensities are averaged over the samples of a pixel, after the exponential.

    Parameters
    ----------
    path_lengths
        (rows · down, columns · across, M) mm.
    attenuation_per_mm
        (K, M).
    weights
        (K, J); the photons of each bin times what each of them counts in each of J sums.
    samples
        (across, down) in every pixel.
    workers, cancelled
        As in :func:`phantom.tracing.pool.run_bands`.

    Returns
    -------
    (J, rows, columns).
    """
    found = through_spectrum(
        path_lengths, attenuation_per_mm, weights.T, workers=workers, cancelled=cancelled
    )
    across, down = samples
    if samples == (1, 1):
        return found
    # One after the other, so that the order of the sum does not depend on the block's place.
    total = np.zeros((found.shape[0], found.shape[1] // down, found.shape[2] // across))
    for i in range(down):
        for j in range(across):
            total += found[:, i::down, j::across]
    return total / (across * down)
