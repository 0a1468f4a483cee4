"""One generalized cylinder, built in its own frame and then moved where it stands."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.hessians import hessian_bounds
from phantom.compiled.sections import CircleSection, Section, StarSection
from phantom.compiled.segments import Segments, segments
from phantom.compiled.tables import StarTable, star_table
from phantom.errors import Problem
from phantom.geometry import tolerances
from phantom.geometry.closing import check_closing
from phantom.geometry.halfspaces import Halfspaces
from phantom.geometry.quadrics import MAX_CUTS
from phantom.geometry.refusal import RefusalError
from phantom.geometry.swept import SweptShape, swept_shape
from phantom.geometry.transforms import Similarity

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Cylinder:
    """A traced generalized cylinder in mm; ``outline`` is a sample of its surface."""

    segments: Segments
    hessians: Floats  # (K, CELLS, CELLS, 6, 2) per mm^2
    table: StarTable | None
    outline: Floats  # (P, 3) points of the surface
    planes: Halfspaces

    def moved(self, to: Similarity) -> Cylinder:
        """Return the cylinder moved by a similarity; phi and tau keep their values."""
        s, r = to.scale, to.rotation
        old = self.segments
        polynomials = old.polynomials.copy()
        for row in (0, 4, 8):
            polynomials[:, row : row + 3] = np.einsum(
                "ij,kjp->kip", r / s, old.polynomials[:, row : row + 3]
            )
        normals = old.planes[:, :3] @ r.T
        moved = replace(
            old,
            planes=np.column_stack([normals, s * old.planes[:, 3] + normals @ to.shift]),
            origins=to.points(old.origins),
            polynomials=polynomials,
            axes=old.axes @ r.T,
            boxes=old.boxes * s,
            error_mm=old.error_mm * s,
        )
        return Cylinder(
            moved,
            self.hessians / s**2,
            self.table,
            to.points(self.outline),
            self.planes.moved(to),
        )

    def boxes_corners(self) -> Floats:
        """Return the corners of all segment boxes, ``(8 K, 3)``: their hull holds the solid."""
        signs = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        chosen = self.segments.boxes[:, np.arange(3), signs]  # (K, 8, 3)
        corners = np.einsum("kca,kai->kci", chosen, self.segments.axes)
        return np.asarray((corners + self.segments.origins[:, None]).reshape(-1, 3))


def cylinder(leaf: doc.GeneralizedCylinder, scale: float) -> tuple[Cylinder | None, list[Problem]]:
    """Build a leaf that will be scaled by ``scale``, or return what is wrong with it.

    The scale only sets the tolerance: the surface is right to :data:`tolerances.SURFACE_MM` where
    it ends up.
    """
    shape, problems = swept_shape(leaf)
    if shape is None:
        return None, problems
    tolerance = tolerances.SURFACE_MM / scale
    try:
        cuts = Halfspaces.cuts(leaf.cuts)
        if len(cuts.offsets) > MAX_CUTS:
            raise RefusalError(
                "/cuts", "too_many", f"{len(cuts.offsets)} cuts; expected at most {MAX_CUTS}"
            )
        check_closing(shape)
        parts = segments(shape, tolerance)
        outline, stretch = _outline(shape, parts.knots)
        if shape.contour.outline is None:
            table: StarTable | None = None
            section: Section = CircleSection()
        else:
            share = (1 - tolerances.FIT_SHARE) * tolerance / stretch
            table = star_table(shape.contour.outline, share)
            section = StarSection(table)
        return Cylinder(parts, hessian_bounds(parts, section), table, outline, cuts), []
    except RefusalError as refusal:
        return None, [refusal.problem]


def _outline(shape: SweptShape, knots: Floats) -> tuple[Floats, float]:
    """Sample the surface, and find the largest stretch from unit coordinates to mm."""
    fractions = np.linspace(0, 1, 9)
    u = (knots[:-1, None] + fractions * np.diff(knots)[:, None]).ravel()
    piece = np.clip(
        np.searchsorted(shape.curve.breaks, u, side="right") - 1, 0, len(shape.curve.breaks) - 2
    )
    at = shape.sections(u, piece)
    phi = shape.contour.unit_points(64)
    points = at.middle[:, None] + np.einsum("nij,vj->nvi", at.spread, phi)
    stretch = float(np.linalg.norm(at.spread, ord=2, axis=(1, 2)).max())
    return points.reshape(-1, 3), stretch
