"""Similarities of space: a scale, a rotation (or mirror) and a shift."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Similarity:
    """``world = scale * rotation @ x + shift``; the rotation may be a mirror."""

    scale: float
    rotation: Floats  # (3, 3) orthogonal
    shift: Floats  # (3,) mm

    @staticmethod
    def identity() -> Similarity:
        """The map that changes nothing."""
        return Similarity(1.0, np.eye(3), np.zeros(3))

    def points(self, x: Floats) -> Floats:
        """Map points ``(..., 3)``."""
        # Not by ``@``: on a busy machine its threads wait for one another over so small a product.
        return np.asarray(self.scale * np.einsum("...j,ij->...i", x, self.rotation) + self.shift)

    def after(self, inner: Similarity) -> Similarity:
        """Return the map that applies ``inner`` first, then this one."""
        return Similarity(
            self.scale * inner.scale, self.rotation @ inner.rotation, self.points(inner.shift)
        )


def rotation_matrix(axis: Floats, angle_rad: float) -> Floats:
    """Return the right-handed rotation about an axis through the origin (Rodrigues)."""
    k = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
    return np.asarray(
        np.eye(3) + np.sin(angle_rad) * cross + (1 - np.cos(angle_rad)) * cross @ cross
    )


def similarity(solid: doc.Transformed) -> Similarity:
    """Read a ``transformed`` solid's own map: scale, then rotate, then translate, or the matrix."""
    if solid.matrix is not None:
        matrix = np.array(solid.matrix, dtype=np.float64)
        scale = float(abs(np.linalg.det(matrix[:, :3])) ** (1 / 3))
        # The nearest orthogonal matrix: the document allowed 1e-9 of rounding.
        left, _, right = np.linalg.svd(matrix[:, :3] / scale)
        return Similarity(scale, left @ right, matrix[:, 3])
    result = Similarity.identity()
    if solid.scale is not None:
        result = Similarity(float(solid.scale), np.eye(3), np.zeros(3))
    if solid.rotate is not None:
        turn = rotation_matrix(
            np.array(solid.rotate.axis, dtype=np.float64), np.radians(solid.rotate.angle_deg)
        )
        about = np.array(solid.rotate.about, dtype=np.float64)
        result = Similarity(1.0, turn, about - turn @ about).after(result)
    if solid.translate is not None:
        result = Similarity(1.0, np.eye(3), np.array(solid.translate, dtype=np.float64)).after(
            result
        )
    return result
