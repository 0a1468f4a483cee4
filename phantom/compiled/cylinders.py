"""One generalized cylinder, built in its own frame and then moved where it stands."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.changing import ChangingSection, changing_tables
from phantom.compiled.hessians import Bounds, hessian_bounds
from phantom.compiled.meeting import Table, Traced
from phantom.compiled.overlap import check_global_overlap
from phantom.compiled.sections import CircleSection, StarSection
from phantom.compiled.segments import Segments, segments
from phantom.compiled.tables import star_table
from phantom.errors import Problem
from phantom.geometry import tolerances
from phantom.geometry.closing import check_closing
from phantom.geometry.halfspaces import Halfspaces
from phantom.geometry.quadrics import MAX_CUTS
from phantom.geometry.refusal import RefusalError
from phantom.geometry.swept import ChangingShape, Shape, swept_shapes
from phantom.geometry.transforms import Similarity

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """One star-shaped part of a generalized cylinder, traced by itself."""

    segments: Segments
    bounds: Bounds
    tables: tuple[Table, ...]  # (K,) one a segment; None for circles

    def moved(self, to: Similarity) -> Part:
        """Return the part moved by a similarity; phi and tau keep their values."""
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
        return Part(moved, self.bounds.scaled(s), self.tables)


@dataclass(frozen=True)
class Rings:
    """A sample of a part's surface: ``middle + spread @ phi`` for the phi of each section."""

    middle: Floats  # (n, 3) mm
    spread: Floats  # (n, 3, 2) mm
    phi: Floats  # (n or 1, P, 2) unit coordinates

    def moved(self, to: Similarity) -> Rings:
        """Return the sample moved by a similarity."""
        turned = to.scale * np.einsum("ij,njk->nik", to.rotation, self.spread)
        return Rings(to.points(self.middle), turned, self.phi)

    def box(self) -> Floats:
        """Return the box (2, 3) of all points."""
        reach = self.spread @ np.swapaxes(self.phi, 1, 2)
        return np.stack(
            [
                (self.middle + reach.min(axis=2)).min(axis=0),
                (self.middle + reach.max(axis=2)).max(axis=0),
            ]
        )


@dataclass(frozen=True)
class Cylinder:
    """A generalized cylinder in mm, and samples of the surface of each part."""

    parts: tuple[Part, ...]
    rings: tuple[Rings, ...]
    planes: Halfspaces
    warnings: tuple[str, ...]

    def moved(self, to: Similarity) -> Cylinder:
        """Return the cylinder moved by a similarity."""
        return Cylinder(
            tuple(part.moved(to) for part in self.parts),
            tuple(rings.moved(to) for rings in self.rings),
            self.planes.moved(to),
            self.warnings,
        )

    def sampled_box(self) -> Floats:
        """Return the box (2, 3) of the samples of the surface."""
        boxes = np.array([rings.box() for rings in self.rings])
        return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    def boxes_corners(self) -> Floats:
        """Return the corners of all segment boxes: their hull holds the solid."""
        signs = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        found = []
        for part in self.parts:
            chosen = part.segments.boxes[:, np.arange(3), signs]  # (K, 8, 3)
            corners = np.einsum("kca,kai->kci", chosen, part.segments.axes)
            found.append((corners + part.segments.origins[:, None]).reshape(-1, 3))
        return np.concatenate(found)


def cylinder(leaf: doc.GeneralizedCylinder, scale: float) -> tuple[Cylinder | None, list[Problem]]:
    """Build a leaf that will be scaled by ``scale``, or return what is wrong with it.

    The scale only sets the tolerance: the surface is right to :data:`tolerances.SURFACE_MM` where
    it ends up.
    """
    shapes, problems = swept_shapes(leaf)
    if problems:
        return None, problems
    tolerance = tolerances.SURFACE_MM / scale
    try:
        cuts = Halfspaces.cuts(leaf.cuts)
        if len(cuts.offsets) > MAX_CUTS:
            raise RefusalError(
                "/cuts", "too_many", f"{len(cuts.offsets)} cuts; expected at most {MAX_CUTS}"
            )
        parts, samples, traced = [], [], []
        for shape in shapes:
            check_closing(shape)
            part, rings = _part(shape, tolerance)
            parts.append(part)
            samples.append(rings)
            traced.append(Traced(shape, part.segments, part.tables))
        check_global_overlap(traced)
        return Cylinder(tuple(parts), tuple(samples), cuts, shapes[0].warnings), []
    except RefusalError as refusal:
        return None, [refusal.problem]


def _part(shape: Shape, tolerance: float) -> tuple[Part, Rings]:
    """Cut a shape into segments, tabulate its contour and bound what the tracing needs."""
    cut = segments(shape, tolerance)
    rings = _rings(shape, cut.knots)
    stretch = float(np.linalg.norm(rings.spread, ord=2, axis=(1, 2)).max())
    share = (1 - tolerances.FIT_SHARE) * tolerance / stretch
    if isinstance(shape, ChangingShape):
        tables = changing_tables(shape, cut.knots, share)
        bounds = hessian_bounds(cut, [ChangingSection(table) for table in tables])
        return Part(cut, bounds, tuple(tables)), rings
    count = len(cut.origins)
    if shape.contour.outline is None:
        return Part(cut, hessian_bounds(cut, CircleSection()), (None,) * count), rings
    table = star_table(shape.contour.outline, share)
    return Part(cut, hessian_bounds(cut, StarSection(table)), (table,) * count), rings


def _rings(shape: Shape, knots: Floats) -> Rings:
    """Sample the surface at nine places of each segment, both ends included."""
    fractions = np.linspace(0, 1, 9)
    u = (knots[:-1, None] + fractions * np.diff(knots)[:, None]).ravel()
    piece = np.clip(
        np.searchsorted(shape.curve.breaks, u, side="right") - 1, 0, len(shape.curve.breaks) - 2
    )
    at = shape.sections(u, piece)
    return Rings(at.middle, at.spread, shape.points(u, 256))
