"""Shapes laid end to end in flat arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.cylinders import Cylinder
from phantom.compiled.layout import CELLS, Scene, frozen
from phantom.compiled.tables import StarTable
from phantom.compiled.tree import Tree
from phantom.geometry.quadrics import QuadricShape

Floats = NDArray[np.float64]

_MAX_BUCKETS = 4096


@dataclass(frozen=True)
class PlacedLeaf:
    """A shape where it stands, and its material's channel (-1: it never surfaces)."""

    shape: Cylinder | QuadricShape | None
    material: int


def pack(leaves: list[PlacedLeaf], boxes: Floats, tree: Tree) -> Scene:
    """Lay out leaves and operators; ``boxes`` are the leaves' tight boxes ``(L, 2, 3)``."""
    planes, forms, knots = [np.zeros((0, 4))], [np.zeros((0, 10))], [np.zeros((0, 4))]
    parts: dict[str, list[Floats]] = {
        "origins": [np.zeros((0, 3))],
        "polynomials": [np.zeros((0, 12, 7))],
        "axes": [np.zeros((0, 3, 3))],
        "boxes": [np.zeros((0, 3, 2))],
        "hessians": [np.zeros((0, CELLS, CELLS, 6, 2))],
    }
    tables: dict[int, tuple[int, StarTable]] = {}
    plane_counts, segment_counts, form_rows, table_rows = [], [], [], []
    centers, world_boxes = [], []
    for leaf, box in zip(leaves, boxes, strict=True):
        shape = leaf.shape
        assert shape is not None
        if isinstance(shape, Cylinder):
            corners = shape.boxes_corners()
            box = np.stack([corners.min(axis=0), corners.max(axis=0)])
        center = 0.5 * (box[0] + box[1])
        centers.append(center)
        # Rounded outward: the box only culls.
        world_boxes.append(box + np.array([[-1.0], [1.0]]) * (1e-9 * np.ptp(box) + 1e-9))
        offsets = shape.planes.offsets - shape.planes.normals @ center
        planes.append(np.column_stack([shape.planes.normals, offsets]))
        plane_counts.append(len(offsets))
        if isinstance(shape, QuadricShape):
            segment_counts.append(0)
            table_rows.append(-1)
            form_rows.append(-1 if shape.form is None else sum(len(f) for f in forms))
            if shape.form is not None:
                forms.append(_form(shape, center))
            continue
        form_rows.append(-1)
        cut = shape.segments
        segment_counts.append(len(cut.origins))
        knots.append(
            np.column_stack([cut.planes[:, :3], cut.planes[:, 3] - cut.planes[:, :3] @ center])
        )
        parts["origins"].append(cut.origins - center)
        parts["polynomials"].append(cut.polynomials)
        parts["axes"].append(cut.axes)
        parts["boxes"].append(cut.boxes)
        parts["hessians"].append(shape.hessians)
        if shape.table is None:
            table_rows.append(-1)
        else:
            row, _ = tables.setdefault(id(shape.table), (len(tables), shape.table))
            table_rows.append(row)
        # Generalized cylinders have a knot more than segments; a quadric's place is left empty.
    world = np.array(world_boxes)
    joined: dict[str, Any] = {name: np.concatenate(values) for name, values in parts.items()}
    joined |= _tables([table for _, table in tables.values()])
    return frozen(
        Scene(
            leaf_center=np.array(centers),
            leaf_radius=0.5 * np.linalg.norm(world[:, 1] - world[:, 0], axis=1),
            leaf_box=world,
            leaf_material=np.array([leaf.material for leaf in leaves], dtype=np.int64),
            leaf_form=np.array(form_rows, dtype=np.int64),
            leaf_table=np.array(table_rows, dtype=np.int64),
            first_plane=_starts(plane_counts),
            planes=np.concatenate(planes),
            forms=np.concatenate(forms),
            first_segment=_starts(segment_counts),
            knots=_knots(knots[1:], segment_counts),
            **joined,
            parent=np.array(tree.parent, dtype=np.int64),
            operator=np.array(tree.operator, dtype=np.int64),
            left=np.array(tree.left, dtype=np.int64),
            right=np.array(tree.right, dtype=np.int64),
        )
    )


def _starts(counts: list[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _knots(knots: list[Floats], segment_counts: list[int]) -> Floats:
    """One row more than segments for every leaf, quadrics too: leaf i starts at its segment + i."""
    rows, given = [], iter(knots)
    for count in segment_counts:
        rows.append(next(given) if count else np.zeros((1, 4)))
    return np.concatenate(rows)


def _form(shape: QuadricShape, center: Floats) -> Floats:
    """Move a form to the leaf's centre and write its ten numbers."""
    assert shape.form is not None
    a, b, c = shape.form
    s = center - shape.center
    b, c = a @ s + b, float(c + s @ a @ s + 2 * b @ s)
    return np.array([[a[0, 0], a[1, 1], a[2, 2], a[0, 1], a[0, 2], a[1, 2], b[0], b[1], b[2], c]])


def _tables(tables: list[StarTable]) -> dict[str, NDArray[np.float64] | NDArray[np.int64]]:
    cells, edges, buckets = [np.zeros((0, 6))], [np.zeros(0)], []
    cell_counts, bucket_counts = [], []
    first = 0
    for table in tables:
        count = min(_MAX_BUCKETS, 2 ** int(np.ceil(np.log2(2 * len(table.cells)))))
        marks = 8.0 * np.arange(count) / count
        buckets.append(first + np.searchsorted(table.edges, marks, side="right") - 1)
        cells.append(table.cells)
        edges.append(table.edges)
        cell_counts.append(len(table.cells))
        bucket_counts.append(count)
        first += len(table.cells)
    return {
        "first_cell": _starts(cell_counts),
        "edges": np.concatenate(edges),
        "cells": np.concatenate(cells),
        "first_bucket": _starts(bucket_counts),
        "buckets": np.concatenate([np.zeros(0), *buckets]).astype(np.int64),
    }
