"""What a kernel reads: one flat, immutable bundle of arrays a scene."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

UNION, INTERSECTION, DIFFERENCE, OVERLAP, REPLACE = range(5)
"""Operators as kernels know them."""


CELLS = 8
"""Bounds of second derivatives are kept on this many cells along each side of a segment's box."""


class Tables(NamedTuple):
    """Contours by the pseudo-angle: the fixed ones first, then those that change along a segment.

    Table i has the cells ``first_cell[i] : first_cell[i + 1]`` and one edge more.
    """

    first_cell: Ints  # (tables + 1,)
    edges: Floats  # (all cells + tables,) in T
    first_bucket: Ints  # (tables + 1,)
    buckets: Ints  # the cell in which each bucket of the pseudo-angle begins
    steps: Ints  # (tables,) edges between cells in one bucket at the most
    cells: Floats  # (fixed cells, 6) powers of the local coordinate
    tensors: Floats  # (changing cells, 6, 7) powers of the local coordinate and of tau


class Scene(NamedTuple):
    """L leaves, P parts of generalized cylinders, S segments, a binary tree of operators.

    Every leaf has its own origin (``leaf_center``), about which its planes, form and segments are
    given, so that coordinates stay small however far away the solid is.
    """

    leaf_center: Floats  # (L, 3) mm
    leaf_radius: Floats  # (L,) mm, of a sphere about the centre that holds the leaf
    leaf_box: Floats  # (L, 2, 3) mm, about the world's origin
    leaf_material: Ints  # (L,) channel, -1 where it never surfaces
    leaf_form: Ints  # (L,) row of forms, or -1
    first_plane: Ints  # (L + 1,) rows of planes
    planes: Floats  # (planes, 4) cuts n.x <= h
    forms: Floats  # (Q, 10) A00 A11 A22 A01 A02 A12 b0 b1 b2 c
    first_part: Ints  # (L + 1,) star-shaped parts of a leaf's contour; quadrics have none
    first_segment: Ints  # (P + 1,) rows of the segment arrays
    knots: Floats  # (S + P, 4) section planes; those of part p begin at first_segment[p] + p
    spans: Floats  # (S, 2) the axis's parameter u at the two ends of a segment
    origins: Floats  # (S, 3)
    polynomials: Floats  # (S, 12, 7)
    axes: Floats  # (S, 3, 3)
    boxes: Floats  # (S, 3, 2)
    hessians: Floats  # (S, CELLS, CELLS, 6, 2) by cell along e1 and e2
    kinks: Floats  # (S, CELLS, CELLS, 3) jumps of the slope: up, down, growth per mm
    hulls: Floats  # (S, 6, 2) what holds for all cells of a segment's Hessian
    cornered: Ints  # (S,) whether any cell has a jump of the slope
    segment_table: Ints  # (S,) contour table, -1 for circles
    tables: Tables
    parent: Ints  # (nodes,) -1 at the root; nodes 0 .. L - 1 are the leaves
    operator: Ints  # (nodes,) of inner nodes
    left: Ints  # (nodes,)
    right: Ints  # (nodes,)


def frozen(scene: Scene) -> Scene:
    """Return the scene with every array contiguous and read-only."""
    arrays: list[Any] = [
        Tables(*map(_fixed, part)) if isinstance(part, Tables) else _fixed(part) for part in scene
    ]
    return Scene(*arrays)


def _fixed(array: Any) -> Any:
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array
