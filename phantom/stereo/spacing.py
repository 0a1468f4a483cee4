"""The largest distance of the eyes that is comfortable."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from phantom.stereo.comfort import COMFORTABLE_DEG
from phantom.stereo.settings import USUAL, Stereo

MAX_ANGLE_DEG: Final = 30.0
"""The greatest angle between the eyes that is thought of: the two pictures of a thin phantom would
otherwise have nothing in common."""

STEP: Final = {"shift": 0.1, "rotate": 0.01}
"""What is rounded down to: mm of the baseline, degrees of the angle."""

_HALVINGS: Final = 50


def separation(
    stereo: Stereo, worst_deg: Callable[[float], float], zero_depth_mm: float | None
) -> float:
    """Return the baseline in mm, or the angle in degrees, of a pair; 0 for a mono arm.

    Parameters
    ----------
    stereo
        What was asked.
    worst_deg
        Greatest disparity of a separation, as for :func:`largest`.
    zero_depth_mm
        Depth of what is seen in the screen, for a shift.
    """
    asked = stereo.separation
    if stereo.mono is not None:
        return 0.0
    if isinstance(asked, float):
        return asked
    usual = USUAL[stereo.method]
    if asked is None and worst_deg(usual) <= COMFORTABLE_DEG:
        return usual
    limit = MAX_ANGLE_DEG
    if stereo.method == "shift" and zero_depth_mm is not None:
        limit = 2.0 * zero_depth_mm * math.tan(math.radians(limit / 2))
    return largest(worst_deg, limit if asked == "auto" else usual, STEP[stereo.method])


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
