"""Half-spaces ``n . x <= h``: cuts and the flat ends of quadrics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.geometry.transforms import Similarity

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Halfspaces:
    """An intersection of half-spaces."""

    normals: Floats  # (P, 3) unit, pointing out of what is kept
    offsets: Floats  # (P,) mm

    @staticmethod
    def of(points: Floats, normals: Floats) -> Halfspaces:
        """Build from a point on each plane and the direction that is cut away."""
        normals = normals / np.linalg.norm(normals, axis=1)[:, None]
        return Halfspaces(normals, np.einsum("ij,ij->i", normals, points))

    @staticmethod
    def everything() -> Halfspaces:
        """No cut at all."""
        return Halfspaces(np.zeros((0, 3)), np.zeros(0))

    @staticmethod
    def cuts(cuts: tuple[doc.Cut, ...]) -> Halfspaces:
        """Read the cuts of a leaf."""
        if not cuts:
            return Halfspaces.everything()
        return Halfspaces.of(
            np.array([cut.point for cut in cuts], dtype=np.float64),
            np.array([cut.normal for cut in cuts], dtype=np.float64),
        )

    def joined(self, other: Halfspaces) -> Halfspaces:
        """Return the intersection of both."""
        return Halfspaces(
            np.vstack([self.normals, other.normals]), np.concatenate([self.offsets, other.offsets])
        )

    def moved(self, to: Similarity) -> Halfspaces:
        """Return the half-spaces moved by a similarity."""
        normals = self.normals @ to.rotation.T
        return Halfspaces(normals, to.scale * self.offsets + normals @ to.shift)
