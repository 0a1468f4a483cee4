"""How the open field changes over a detector: inverse square of the distance and obliquity."""

from __future__ import annotations

from typing import Literal

import numpy as np

from phantom.imaging.detection.window import Window
from phantom.imaging.view import FloatArray, View, unit


def source_detector_mm(view: View) -> float | None:
    """Return the distance from the source to the detector's centre; None for a parallel beam."""
    if view.source is None:
        return None
    return float(np.linalg.norm(np.subtract(view.source, view.detector.center)))


def geometry(view: View, window: Window) -> tuple[FloatArray, FloatArray]:
    """Return the distance from the source and the cosine of the incidence at every pixel.

    Returns
    -------
    Two (rows, columns) arrays: mm, infinite for a parallel beam; and the cosine of the angle
    between the ray to the pixel's centre and the detector's normal, above 0.
    """
    detector = view.detector
    shape = (window.rows, window.columns)
    if view.source is None:
        assert view.direction is not None
        cosine = abs(float(detector.normal @ unit(view.direction)))
        return np.full(shape, np.inf), np.full(shape, cosine)
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    foot = np.asarray(view.source) - np.asarray(detector.center)
    columns = window.first_column + np.arange(window.columns) - (detector.columns - 1) / 2
    rows = window.first_row + np.arange(window.rows) - (detector.rows - 1) / 2
    x = columns * pitch_x - right @ foot
    y = rows * pitch_y - down @ foot
    height = abs(float(detector.normal @ foot))
    distance = np.sqrt(x[None, :] ** 2 + y[:, None] ** 2 + height**2)
    return distance, height / distance


def falloff(
    view: View, window: Window, kind: Literal["none", "inverse_square_cosine"]
) -> FloatArray:
    """Return (rows, columns) photons through a pixel, over those through its area held across.

    The area is held across the ray at the detector's centre: ``none`` gives 1 everywhere, and
    ``inverse_square_cosine`` gives (d₀/d)² cos θ with d the distance of the pixel from the source,
    d₀ that of the detector's centre and θ the angle of incidence; cos θ alone for a parallel beam.
    """
    if kind == "none":
        return np.ones((window.rows, window.columns))
    distance, cosine = geometry(view, window)
    middle = source_detector_mm(view)
    return cosine if middle is None else cosine * (middle / distance) ** 2
