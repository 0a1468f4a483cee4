"""Which materials are present at points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, kernel
from phantom.kernels.csg import surviving, toggle
from phantom.kernels.cylinder import contract, evaluate

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@inner
def in_segment(scene: Scene, k: int, knot: int, x: float, y: float, z: float, work: Floats) -> bool:
    """Say whether a point, about its leaf's centre, lies in segment k of a cylinder."""
    n = scene.knots
    if n[knot, 0] * x + n[knot, 1] * y + n[knot, 2] * z < n[knot, 3]:
        return False
    if n[knot + 1, 0] * x + n[knot + 1, 1] * y + n[knot + 1, 2] * z >= n[knot + 1, 3]:
        return False
    ox, oy, oz = x - scene.origins[k, 0], y - scene.origins[k, 1], z - scene.origins[k, 2]
    for axis in range(3):
        e = scene.axes
        p = e[k, axis, 0] * ox + e[k, axis, 1] * oy + e[k, axis, 2] * oz
        if p < scene.boxes[k, axis, 0] or p > scene.boxes[k, axis, 1]:
            return False
    contract(scene.polynomials, k, ox, oy, oz, 0.0, 0.0, 0.0, work)
    g, _, _ = evaluate(work, 0.0, 0.0, scene.segment_table[k], scene.tables)
    return g < 0.0


@inner
def in_leaf(scene: Scene, leaf: int, x: float, y: float, z: float, work: Floats) -> bool:
    """Say whether a point lies in a leaf."""
    if scene.leaf_box[leaf, 0, 0] > x or scene.leaf_box[leaf, 1, 0] < x:
        return False
    if scene.leaf_box[leaf, 0, 1] > y or scene.leaf_box[leaf, 1, 1] < y:
        return False
    if scene.leaf_box[leaf, 0, 2] > z or scene.leaf_box[leaf, 1, 2] < z:
        return False
    x -= scene.leaf_center[leaf, 0]
    y -= scene.leaf_center[leaf, 1]
    z -= scene.leaf_center[leaf, 2]
    for k in range(scene.first_plane[leaf], scene.first_plane[leaf + 1]):
        n = scene.planes
        if n[k, 0] * x + n[k, 1] * y + n[k, 2] * z > n[k, 3]:
            return False
    if scene.first_part[leaf] == scene.first_part[leaf + 1]:
        row = scene.leaf_form[leaf]
        if row < 0:
            return True
        q = scene.forms
        level = (
            x * (q[row, 0] * x + 2.0 * (q[row, 3] * y + q[row, 4] * z + q[row, 6]))
            + y * (q[row, 1] * y + 2.0 * (q[row, 5] * z + q[row, 7]))
            + z * (q[row, 2] * z + 2.0 * q[row, 8])
            + q[row, 9]
        )
        return bool(level <= 0.0)
    for part in range(scene.first_part[leaf], scene.first_part[leaf + 1]):
        for k in range(scene.first_segment[part], scene.first_segment[part + 1]):
            if in_segment(scene, k, k + part, x, y, z, work):
                return True
    return False


@kernel
def materials_at(scene: Scene, points: Floats, out: Ints) -> None:
    """Count in ``out[i, m]`` how often material m is present at point i."""
    leaves = len(scene.leaf_radius)
    root = len(scene.parent) - 1
    work = np.empty((6, 7))
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(leaves + 1, dtype=np.int64)
    inside = np.empty(leaves, dtype=np.int64)
    for i in range(len(points)):
        count = 0
        for leaf in range(leaves):
            if in_leaf(scene, leaf, points[i, 0], points[i, 1], points[i, 2], work):
                inside[count] = leaf
                count += 1
                toggle(leaf, present, scene.parent, scene.operator, scene.left, scene.right)
        for j in range(
            surviving(root, leaves, present, scene.operator, scene.left, scene.right, nodes, kept)
        ):
            channel = scene.leaf_material[kept[j]]
            if channel >= 0:
                out[i, channel] += 1
        for j in range(count):
            toggle(inside[j], present, scene.parent, scene.operator, scene.left, scene.right)
