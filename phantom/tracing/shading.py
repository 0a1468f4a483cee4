"""A raster of rays in visible light: first hits and Phong's model, band by band."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.scene import Phantom
from phantom.tracing.hits import HitRaster, face_slack_mm, picking_mm
from phantom.tracing.pool import cut_bands, run_bands

Floats = NDArray[np.float64]
Flags = NDArray[np.uint8]

_BAND_SAMPLES = 2**16
_ROOM = 256


def shaded(
    phantom: Phantom,
    view: Floats,
    rows: int,
    columns: int,
    samples: int,
    shown: Flags,
    looks: Floats,
    ambient: Floats,
    lights: tuple[Floats, Floats],
    *,
    shadows: bool = False,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Floats, Floats]:
    """Return the light (rows, columns, 3) of a picture before black, and what is covered of it.

    Parameters
    ----------
    phantom, view, shown
        As of :class:`phantom.tracing.hits.HitRaster`, whose rays are the samples.
    rows, columns, samples
        Pixels, and samples along each side of one.
    looks
        (L, 7) red, green, blue, K_a, K_d, K_s and n of every leaf.
    ambient
        (3,) red, green and blue.
    lights
        Places (n, 4) and colours (n, 3), as :mod:`phantom.kernels.phong` has them.
    shadows
        Whether solids keep the lights from one another.
    workers, cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts rows of pixels.
    """
    from phantom.kernels.phong import shade

    raster = HitRaster(phantom, view, rows * samples, columns * samples, shown)
    rgb, coverage = np.zeros((rows, columns, 3)), np.zeros((rows, columns))

    def band(start: int, end: int) -> None:
        distances, hits = raster.rows(start * samples, end * samples)
        room = _ROOM
        while not shade(
            phantom.compiled.scene,
            view,
            start * samples,
            distances,
            hits,
            looks,
            ambient,
            *lights,
            shadows,
            shown,
            tolerances.CHORD_MM,
            picking_mm(phantom),
            face_slack_mm(phantom),
            room,
            samples,
            rgb[start:end],
            coverage[start:end],
        ):
            room *= 4
            rgb[start:end], coverage[start:end] = 0.0, 0.0

    size = max(1, _BAND_SAMPLES // (columns * samples * samples))
    bands = cut_bands(rows, size)
    run_bands(band, bands, workers=workers, cancelled=cancelled, progress=progress)
    return rgb, np.minimum(coverage, 1.0)
