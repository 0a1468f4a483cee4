"""What a file says of a pair's geometry, as plain JSON values."""

from __future__ import annotations

from typing import Any, Final

from phantom.stereo.comfort import Comfort
from phantom.stereo.disparity import Disparity, Floats
from phantom.stereo.settings import Stereo

SIGN: Final = "left column - right column: above 0 is crossed, nearer than the screen"


def stereo_told(
    asked: Stereo,
    *,
    baseline_mm: float | None,
    angle_deg: float | None,
    zero_depth_mm: float | None,
    whole: Disparity,
    comfort: Comfort,
    matrix: Floats | None,
) -> dict[str, Any]:
    """Return the geometry of a pair, and what it asks of the eyes.

    Parameters
    ----------
    asked
        What was asked.
    baseline_mm, angle_deg, zero_depth_mm
        Where the eyes came to be; None where there is no such thing.
    whole, comfort
        The disparity of everything, and the verdict on it.
    matrix
        The epipolar one.
    """
    plane = asked.zero_parallax
    return {
        "method": asked.method,
        "mono": asked.mono,
        "dose": asked.dose,
        "baseline_mm": baseline_mm,
        "angle_deg": angle_deg,
        "zero_parallax": plane if isinstance(plane, str) else plane.model_dump(mode="json"),
        "zero_depth_mm": zero_depth_mm,
        "screen": asked.screen.model_dump(mode="json"),
        "disparity": {"sign": SIGN, **whole.told()},
        "epipolar_matrix": None if matrix is None else matrix.tolist(),
        "comfort": comfort.told(),
    }
