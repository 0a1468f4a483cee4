"""Shapes laid end to end in flat arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.changing import ChangingTable
from phantom.compiled.cylinders import Cylinder, Part
from phantom.compiled.layout import CELLS, Scene, Tables, frozen
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
    planes, forms = [np.zeros((0, 4))], [np.zeros((0, 10))]
    plane_counts, part_counts, form_rows, centers, world_boxes = [], [], [], [], []
    parts: list[tuple[Part, Floats]] = []
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
            part_counts.append(0)
            form_rows.append(-1 if shape.form is None else len(forms) - 1)  # one row each
            if shape.form is not None:
                forms.append(_form(shape, center))
        else:
            form_rows.append(-1)
            part_counts.append(len(shape.parts))
            parts += [(part, center) for part in shape.parts]
    world = np.array(world_boxes)
    return frozen(
        Scene(
            leaf_center=np.array(centers),
            leaf_radius=0.5 * np.linalg.norm(world[:, 1] - world[:, 0], axis=1),
            leaf_box=world,
            leaf_material=np.array([leaf.material for leaf in leaves], dtype=np.int64),
            leaf_form=np.array(form_rows, dtype=np.int64),
            first_plane=_starts(plane_counts),
            planes=np.concatenate(planes),
            forms=np.concatenate(forms),
            first_part=_starts(part_counts),
            **_segments(parts),
            parent=np.array(tree.parent, dtype=np.int64),
            operator=np.array(tree.operator, dtype=np.int64),
            left=np.array(tree.left, dtype=np.int64),
            right=np.array(tree.right, dtype=np.int64),
        )
    )


def _segments(parts: list[tuple[Part, Floats]]) -> dict[str, Any]:
    """Lay out the segments of all parts, each about its leaf's centre, and their tables."""
    columns: dict[str, list[Floats]] = {
        "knots": [np.zeros((0, 4))],
        "spans": [np.zeros((0, 2))],
        "origins": [np.zeros((0, 3))],
        "polynomials": [np.zeros((0, 12, 7))],
        "axes": [np.zeros((0, 3, 3))],
        "boxes": [np.zeros((0, 3, 2))],
        "hessians": [np.zeros((0, CELLS, CELLS, 6, 2))],
        "kinks": [np.zeros((0, CELLS, CELLS, 3))],
    }
    fixed: dict[int, tuple[int, StarTable]] = {}
    changing: list[ChangingTable] = []
    owners: list[tuple[bool, int]] = []
    for part, center in parts:
        cut = part.segments
        offsets = cut.planes[:, 3] - cut.planes[:, :3] @ center
        columns["knots"].append(np.column_stack([cut.planes[:, :3], offsets]))
        columns["spans"].append(np.column_stack([cut.knots[:-1], cut.knots[1:]]))
        columns["origins"].append(cut.origins - center)
        columns["polynomials"].append(cut.polynomials)
        columns["axes"].append(cut.axes)
        columns["boxes"].append(cut.boxes)
        columns["hessians"].append(part.bounds.hessians)
        columns["kinks"].append(part.bounds.kinks)
        for table in part.tables:
            if isinstance(table, StarTable):
                owners.append((True, fixed.setdefault(id(table), (len(fixed), table))[0]))
            elif table is None:
                owners.append((True, -1))
            else:
                owners.append((False, len(changing)))
                changing.append(table)
    rows = [index if known else len(fixed) + index for known, index in owners]
    result: dict[str, Any] = {name: np.concatenate(column) for name, column in columns.items()}
    bounds = result["hessians"]
    result["hulls"] = np.stack(
        [bounds[..., 0].min(axis=(1, 2)), bounds[..., 1].max(axis=(1, 2))], axis=-1
    )
    result["cornered"] = result["kinks"].any(axis=(1, 2, 3)).astype(np.int64)
    result["first_segment"] = _starts([len(part.segments.origins) for part, _ in parts])
    result["segment_table"] = np.array(rows, dtype=np.int64)
    result["tables"] = _tables([table for _, table in fixed.values()], changing)
    return result


def _starts(counts: list[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _form(shape: QuadricShape, center: Floats) -> Floats:
    """Move a form to the leaf's centre and write its ten numbers."""
    assert shape.form is not None
    a, b, c = shape.form
    s = center - shape.center
    b, c = a @ s + b, float(c + s @ a @ s + 2 * b @ s)
    return np.array([[a[0, 0], a[1, 1], a[2, 2], a[0, 1], a[0, 2], a[1, 2], b[0], b[1], b[2], c]])


def _tables(fixed: list[StarTable], changing: list[ChangingTable]) -> Tables:
    edges: list[Floats] = [np.zeros(0)]
    buckets: list[Floats] = [np.zeros(0)]
    cell_counts, bucket_counts, steps = [], [], []
    first = 0
    tables: list[StarTable | ChangingTable] = [*fixed, *changing]
    for table in tables:
        count, most = _buckets(table.edges)
        marks = 8.0 * np.arange(count) / count
        cells = np.searchsorted(table.edges, marks, side="right") - 1
        buckets.append((first + cells).astype(np.float64))
        edges.append(table.edges)
        cell_counts.append(len(table.cells))
        bucket_counts.append(count)
        steps.append(most)
        first += len(table.cells)
    return Tables(
        first_cell=_starts(cell_counts),
        edges=np.concatenate(edges),
        first_bucket=_starts(bucket_counts),
        buckets=np.concatenate(buckets).astype(np.int64),
        steps=np.array(steps, dtype=np.int64),
        cells=np.concatenate([np.zeros((0, 6)), *(table.cells for table in fixed)]),
        tensors=np.concatenate([np.zeros((0, 6, 7)), *(table.cells for table in changing)]),
    )


def _buckets(edges: Floats) -> tuple[int, int]:
    """Return into how many buckets to cut the pseudo-angle, and how many edges one has at most.

    As few as leave one edge to a bucket; edges that crowd at a corner are stepped over.
    """
    fewest = 2 ** int(np.ceil(np.log2(2 * (len(edges) - 1))))
    for count in (fewest, 2 * fewest, 4 * fewest):
        inside = np.bincount((edges[1:-1] * (count / 8.0)).astype(np.int64), minlength=1)
        if inside.max() <= 1 or 2 * count > _MAX_BUCKETS:
            break
    return count, int(inside.max())
