"""The largest distance of the eyes that is comfortable."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from phantom.stereo.comfort import COMFORTABLE_DEG

MAX_ANGLE_DEG: Final = 30.0
"""The greatest angle between the eyes that is thought of: the two pictures of a thin phantom would
otherwise have nothing in common."""

STEP: Final = {"shift": 0.1, "rotate": 0.01}
"""What is rounded down to: mm of the baseline, degrees of the angle."""

_HALVINGS: Final = 50


def largest(worst_deg: Callable[[float], float], limit: float, step: float) -> float:
    """Return the largest separation within comfort, a whole number of steps where that is not 0.

    Parameters
    ----------
    worst_deg
        Greatest disparity, crossed or uncrossed, of a separation; rises with it. Infinite where
        there is none.
    limit
        The largest separation that is thought of.
    step
        What a person would set.
    """
    if worst_deg(limit) <= COMFORTABLE_DEG:
        return limit
    low, high = 0.0, limit
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if worst_deg(middle) <= COMFORTABLE_DEG:
            low = middle
        else:
            high = middle
    whole = round(low // step * step, 6)
    return whole if whole > 0.0 else low
