"""From values to shares of the grey scale: stretch, window, percentiles, equalisation.

Each returns numbers from 0 to 1 that rise with the values, or None where an image is constant and
so has nothing to tell apart.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def stretched(values: NDArray[np.floating]) -> FloatArray | None:
    """Bring the least value to 0 and the greatest to 1, linearly (the paper, section II.I)."""
    least, greatest = float(values.min()), float(values.max())
    if not greatest > least:
        return None
    # Brought to [0, 1] first, so that the greatest reaches full scale exactly.
    share: FloatArray = np.subtract(values, least, dtype=np.float64)
    share /= greatest - least
    return share


def between_percentiles(
    values: NDArray[np.floating], percentiles: tuple[float, float]
) -> FloatArray | None:
    """Stretch between two percentiles; what is beyond stops at the end.

    Percentiles are interpolated linearly between the sorted values (R. J. Hyndman and Y. Fan, Am.
    Stat. 50 (1996) 361, definition 7). Where both are one value, what is above it is 1.
    """
    if not float(values.max()) > float(values.min()):
        return None
    low, high = (float(q) for q in np.percentile(values, percentiles))
    if not high > low:
        return np.asarray(values > low, dtype=np.float64)
    share: FloatArray = np.subtract(values, low, dtype=np.float64)
    share /= high - low
    np.clip(share, 0.0, 1.0, out=share)
    return share


def windowed(line_integral: FloatArray, center: float, width: float) -> FloatArray | None:
    """Bring ``center - width/2`` to 0 and ``center + width/2`` to 1 (DICOM's LINEAR_EXACT).

    PS3.3, section C.11.2.1.3.2.
    """
    if not float(line_integral.max()) > float(line_integral.min()):
        return None
    share: FloatArray = (line_integral - center) / width + 0.5
    np.clip(share, 0.0, 1.0, out=share)
    return share


def equalised(values: NDArray[np.floating]) -> FloatArray | None:
    """Give each value the share of the pixels that are not above it, the least value 0.

    Global histogram equalisation (R. C. Gonzalez and R. E. Woods, *Digital Image Processing*, 4th
    ed., section 3.3) without bins: every distinct value counts by itself. The pixels of the least
    value do not count, so that a large open field takes one level and no contrast.
    """
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    if len(counts) == 1:
        return None
    not_above = np.cumsum(counts)
    share = (not_above - counts[0]) / float(values.size - counts[0])
    found: FloatArray = share[place.reshape(values.shape)]
    return found
