"""What a presentation came to for one image: the last of the stages, with its values."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.imaging.presentation import USUAL_PERCENTILES, Presentation


def presentation_stage(
    image: NDArray[np.floating],
    presentation: Presentation | None = None,
    *,
    rises_with_attenuation: bool = False,
    open_field: float = 1.0,
) -> dict[str, Any]:
    """Return the stage as plain JSON values; arguments are those of :func:`present`.

    ``shown`` is the range of values that spans the grey scale, in the quantity's own unit: least
    and greatest of the image, its percentiles, or the ends of the window. Equalisation has none, an
    end that is not finite is null, and a constant image is told as such.
    """
    asked = presentation if presentation is not None else Presentation()
    told: dict[str, Any] = {"stage": "presentation", **asked.model_dump(mode="json")}
    told = {name: value for name, value in told.items() if value is not None}
    ends = _ends(image, asked, rises_with_attenuation, open_field)
    if ends is not None:
        told["shown"] = [end if math.isfinite(end) else None for end in ends]
    if not float(image.max()) > float(image.min()):
        told["constant"] = True
    if asked.gsdf is not None:
        told["jnd_range"] = list(asked.gsdf.jnd_range)
        told["levels"] = "P-values" if asked.gsdf.response is None else "drive levels"
    return told


def _ends(
    image: NDArray[np.floating], asked: Presentation, rises: bool, open_field: float
) -> tuple[float, float] | None:
    """Return the lower and the upper value, of the image's own quantity."""
    if asked.mode == "stretch":
        return float(image.min()), float(image.max())
    if asked.mode == "percentile":
        low, high = np.percentile(image, asked.percentiles or USUAL_PERCENTILES)
        return float(low), float(high)
    if asked.mode == "window":
        center, width = asked.window
        low, high = center - width / 2, center + width / 2
        if rises:
            return low, high
        with np.errstate(over="ignore"):  # the end of a window beyond all numbers: infinite
            dim, bright = open_field * np.exp([-high, -low])
        return float(dim), float(bright)
    return None
