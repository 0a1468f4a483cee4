"""Arrays of vectors along their last axis."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def dots(a: Floats, b: Floats) -> Floats:
    """Return the products ``a . b``."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def unit(vectors: Floats) -> Floats:
    """Scale to length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def plane_cross(a: Floats, b: Floats) -> Floats:
    """Return ``a x b`` of vectors in a plane: positive where b lies anticlockwise of a."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def box_corners(bounds: Floats) -> Floats:
    """Return the (8, 3) corners of a (2, 3) box of least and greatest coordinates."""
    choice = np.array([[(i >> axis) & 1 for axis in range(3)] for i in range(8)])
    corners: Floats = np.asarray(bounds, dtype=np.float64)[choice, np.arange(3)]
    return corners


def sine_cosine(angle_deg: float) -> tuple[float, float]:
    """Return sine and cosine, exact at whole quarter turns."""
    quarters, rest = divmod(angle_deg, 90.0)
    if rest == 0.0:
        return ((0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0))[int(quarters) % 4]
    angle = math.radians(angle_deg)
    return math.sin(angle), math.cos(angle)
