"""Which materials are present at points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phantom.scene import Phantom
from phantom.tracing.pool import cut_bands, run_bands
from phantom.tracing.rays import check_points

_BAND = 8192


def materials_at(
    phantom: Phantom,
    points: ArrayLike,
    *,
    cancelled: Callable[[], bool] | None = None,
) -> NDArray[np.int64]:
    """Return how often each material is present at points.

    Parameters
    ----------
    phantom
        What is looked into.
    points
        ``(P, 3)`` mm.
    cancelled
        Asked between bands of points; yes ends the work with :class:`CancelledError`.

    Returns
    -------
    ``(P, M)`` counts in the order of ``phantom.material_names``: 0 where a material is absent,
    above 1 only where ``overlap`` adds it to itself. A point on a surface may count as either side.

    Raises
    ------
    InvalidInputError
        Where the points are no array (P, 3) of finite numbers.
    """
    from phantom.kernels import points as kernels

    where = check_points(points)
    out = np.zeros((len(where), len(phantom.material_names)), dtype=np.int64)

    def band(first: int, last: int) -> None:
        kernels.materials_at(phantom.compiled.scene, where[first:last], out[first:last])

    run_bands(band, cut_bands(len(where), _BAND), cancelled=cancelled)
    return out
