"""What is seen first along a ray: the first place where the final solid begins or ends.

The same intervals and operators as for path lengths. A tolerance comes in only here: what lasts no
longer than it (a sliver between two faces that coincide) is not seen.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import kernel, lane_loop
from phantom.kernels.csg import sort_events, surviving, toggle
from phantom.kernels.cylinder import ROW, STACK
from phantom.kernels.lanes import LANES, TILE_COLUMNS, TILE_ROWS
from phantom.kernels.leaves import leaf_intervals
from phantom.kernels.roots import ERROR_MM
from phantom.kernels.scratch import Scratch
from phantom.kernels.tiles import aim_tile, leaf_slots

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]

SURFACE, SEEN, SIDE, INSIDE = range(4)
"""Columns of what is known of a hit: the leaf whose surface it is, the leaf that is seen there,
+1 where the surface's outward normal is the final solid's (-1 where it is the opposite), and 1
where the ray starts in the solid."""


@kernel
def first_shown(scene: Scene, shown: Flags, present: Flags, nodes: Ints, kept: Ints) -> int:
    """Return the first leaf that is left where the present ones overlap and is shown, or -1."""
    count = surviving(
        len(scene.parent) - 1,
        len(scene.leaf_radius),
        present,
        scene.operator,
        scene.left,
        scene.right,
        nodes,
        kept,
    )
    for k in range(count):
        if shown[kept[k]] != 0:
            return int(kept[k])
    return -1


@kernel
def first_of_ray(
    scene: Scene,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
    shown: Flags,
    tolerance: float,
    where: Floats,
    order: Ints,
    present: Flags,
    nodes: Ints,
    kept: Ints,
    hit: Ints,
) -> float:
    """Sweep the events of one ray until something shown begins or ends; return where, or inf.

    ``hit`` gets the four numbers of a hit (:data:`SURFACE` and so on).
    """
    for i in range(count):
        where[2 * i], where[2 * i + 1] = entries[i], exits[i]
        order[2 * i], order[2 * i + 1] = 2 * i, 2 * i + 1
    sort_events(where, order, 2 * count)
    found = math.inf
    # What was seen where the ray last stayed the same for longer than the tolerance.
    before, latest, flip = -1, -1, -1
    swept = 0
    for i in range(2 * count):
        here = where[order[i]]
        leaf = owners[order[i] // 2]
        toggle(leaf, present, scene.parent, scene.operator, scene.left, scene.right)
        swept = i + 1
        seen = first_shown(scene, shown, present, nodes, kept)
        if (seen >= 0) != (latest >= 0):
            flip = i
        latest = seen
        if i + 1 < 2 * count and where[order[i + 1]] - here <= tolerance:
            continue
        if (seen >= 0) != (before >= 0) and here > tolerance:
            leaf = owners[order[flip] // 2]
            begins = order[flip] % 2 == 0
            hit[0] = leaf
            hit[1] = max(seen, before)
            hit[2] = 1 if begins == (seen >= 0) else -1
            hit[3] = 1 if before >= 0 else 0
            found = where[order[flip]]
            break
        before = seen
    for i in range(swept):
        leaf = owners[order[i] // 2]
        if present[leaf] != 0:
            toggle(leaf, present, scene.parent, scene.operator, scene.left, scene.right)
    return found


@kernel
def first_hits(
    scene: Scene,
    origins: Floats,
    directions: Floats,
    shown: Flags,
    shortest: float,
    tolerance: float,
    room: int,
    distances: Floats,
    hits: Ints,
    counter: Ints,
) -> int:
    """Fill ``distances`` (N,) and ``hits`` (N, 4); return the first ray without room, or -1."""
    entries, exits = np.empty(room), np.empty(room)
    owners = np.empty(room, dtype=np.int64)
    where, order = np.empty(2 * room), np.empty(2 * room, dtype=np.int64)
    work, beam = np.empty((6, 7)), np.empty(10)
    stack, found = np.empty((STACK, ROW)), np.empty((room, 2))
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(len(scene.leaf_radius) + 1, dtype=np.int64)
    for i in range(len(origins)):
        count = leaf_intervals(
            scene,
            origins[i, 0],
            origins[i, 1],
            origins[i, 2],
            directions[i, 0],
            directions[i, 1],
            directions[i, 2],
            math.inf,
            shortest,
            entries,
            exits,
            owners,
            work,
            beam,
            stack,
            found,
            counter,
        )
        if count < 0:
            return i
        distances[i] = first_of_ray(
            scene,
            count,
            entries,
            exits,
            owners,
            shown,
            tolerance,
            where,
            order,
            present,
            nodes,
            kept,
            hits[i],
        )
    return -1


@lane_loop
def meets(ends: Floats, slot: int, count: int, met: Flags) -> None:
    """Note the pixels of a tile whose rays meet a slot."""
    entries, exits = ends[2 * slot, :count], ends[2 * slot + 1, :count]
    for p in range(count):
        met[p] |= np.uint8(1) if exits[p] > entries[p] else np.uint8(0)


@kernel
def tile_hits(
    scene: Scene,
    view: Floats,
    leaf_fields: Ints,
    fields: Ints,
    first_row: int,
    last_row: int,
    shortest_mm: float,
    tolerance_mm: float,
    shown: Flags,
    held: Scratch,
    distances: Floats,
    hits: Ints,
    failed: Ints,
) -> int:
    """Fill rows of a raster: ``distances`` (rows, columns) mm and ``hits`` (rows, columns, 4).

    Rays that meet nothing are left as they are.
    The first row of both arrays is ``first_row`` of the view (:func:`phantom.kernels.tiles.tiles`).
    Tiles that need more room than there is are written to ``failed`` and counted.
    """
    width = distances.shape[1]
    most = len(held.owners)
    entries, exits = np.empty(most), np.empty(most)
    owners = np.empty(most, dtype=np.int64)
    where, order = np.empty(2 * most), np.empty(2 * most, dtype=np.int64)
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(len(scene.leaf_radius) + 1, dtype=np.int64)
    rays, ends, met = held.rays, held.ends, np.empty(LANES, dtype=np.uint8)
    missing = 0
    for row in range(first_row, last_row, TILE_ROWS):
        rows = min(TILE_ROWS, last_row - row)
        for column in range(0, width, TILE_COLUMNS):
            columns = min(TILE_COLUMNS, width - column)
            longest = aim_tile(view, row, column, rows, columns, rays)
            slots = leaf_slots(
                scene,
                row,
                column,
                rows,
                columns,
                leaf_fields,
                fields,
                shortest_mm / longest,
                ERROR_MM / longest,
                held,
            )
            if slots < 0:
                failed[missing, 0], failed[missing, 1] = row, column
                missing += 1
                continue
            for p in range(rows * columns):
                met[p] = 0
            for slot in range(slots):
                meets(ends, slot, rows * columns, met)
            for i in range(rows):
                for j in range(columns):
                    p = i * columns + j
                    if met[p] == 0:
                        continue
                    count = 0
                    for slot in range(slots):
                        if ends[2 * slot + 1, p] > ends[2 * slot, p]:
                            entries[count], exits[count] = ends[2 * slot, p], ends[2 * slot + 1, p]
                            owners[count] = held.owners[slot]
                            count += 1
                    r, c = row - first_row + i, column + j
                    dx = rays[3, 0] + i * rays[4, 0] + j * rays[5, 0]
                    dy = rays[3, 1] + i * rays[4, 1] + j * rays[5, 1]
                    dz = rays[3, 2] + i * rays[4, 2] + j * rays[5, 2]
                    length = math.sqrt(dx * dx + dy * dy + dz * dz)
                    distances[r, c] = length * first_of_ray(
                        scene,
                        count,
                        entries,
                        exits,
                        owners,
                        shown,
                        tolerance_mm / length,
                        where,
                        order,
                        present,
                        nodes,
                        kept,
                        hits[r, c],
                    )
    return missing
