"""A closed axis must bring its section back to itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.geometry import tolerances
from phantom.geometry.refusal import RefusalError
from phantom.geometry.star import pseudo_angle, radii
from phantom.geometry.swept import ChangingShape, Shape

Floats = NDArray[np.float64]


def check_closing(shape: Shape) -> None:
    """Refuse a closed axis whose last section is not its first one, as sets of points.

    Raises
    ------
    RefusalError
        At ``/sweep``, with the largest distance between the two sections.
    """
    if not shape.curve.closed:
        return
    ends = shape.breaks[[0, -1]]
    at = shape.sections(ends, np.array([0, len(shape.curve.breaks) - 2]))
    phi = shape.points(ends[:1], 256)[0]
    # The first section's points, seen from the last section, must lie on the contour.
    points = at.middle[0] + phi @ at.spread[0].T
    seen = (points - at.middle[1]) @ at.inverse[1].T
    size = np.linalg.norm(seen, axis=1)
    if isinstance(shape, ChangingShape):
        wanted = shape.changing.radii(pseudo_angle(seen), ends[1:])[:, 0] / shape.unit
    elif shape.contour.outline is not None:
        wanted = radii(shape.contour.outline, seen)
    else:
        wanted = np.ones(len(seen))
    stretch = float(np.linalg.norm(at.spread[1], ord=2))
    gap = float(np.abs(size - wanted).max() * stretch)
    if gap > tolerances.CLOSING_MM:
        raise RefusalError(
            "/sweep",
            "open_seam",
            f"the sections at the two ends of the closed axis differ by {gap:.4g} mm; "
            f"expected at most {tolerances.CLOSING_MM:g}",
        )
