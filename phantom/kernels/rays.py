"""Bands of rays: path lengths a material, and the pieces of the final solid."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, kernel, whole
from phantom.kernels.csg import sort_events, surviving, toggle
from phantom.kernels.cylinder import ROW, STACK
from phantom.kernels.leaves import leaf_intervals

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]


@inner
def lengths_of_ray(
    scene: Scene,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
    where: Floats,
    order: Ints,
    present: Flags,
    nodes: Ints,
    kept: Ints,
    lengths: Floats,
) -> None:
    """Sweep the events of one ray and add each step to the materials present in it."""
    leaves = len(scene.leaf_radius)
    root = len(scene.parent) - 1
    for i in range(count):
        where[2 * i], where[2 * i + 1] = entries[i], exits[i]
        order[2 * i], order[2 * i + 1] = 2 * i, 2 * i + 1
    sort_events(where, order, 2 * count)
    before = 0.0
    for i in range(2 * count):
        here = where[order[i]]
        if i > 0 and here > before:
            for j in range(
                surviving(
                    root, leaves, present, scene.operator, scene.left, scene.right, nodes, kept
                )
            ):
                channel = scene.leaf_material[kept[j]]
                if channel >= 0:
                    lengths[channel] += here - before
        before = here
        toggle(
            owners[order[i] // 2], present, scene.parent, scene.operator, scene.left, scene.right
        )


@inner
def pieces_of_ray(
    scene: Scene,
    ray: int,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
    where: Floats,
    order: Ints,
    present: Flags,
    nodes: Ints,
    kept: Ints,
    rows: Ints,
    out_ray: Ints,
    out_entry: Floats,
    out_exit: Floats,
    out_leaf: Ints,
    filled: int,
) -> int:
    """Sweep the events of one ray and write a row for each leaf that survives, joined up.

    Returns the number of rows filled, negative where there was no room.
    """
    leaves = len(scene.leaf_radius)
    root = len(scene.parent) - 1
    first = filled
    for i in range(count):
        where[2 * i], where[2 * i + 1] = entries[i], exits[i]
        order[2 * i], order[2 * i + 1] = 2 * i, 2 * i + 1
    sort_events(where, order, 2 * count)
    before = 0.0
    for i in range(2 * count):
        here = where[order[i]]
        if i > 0 and here > before:
            for j in range(
                surviving(
                    root, leaves, present, scene.operator, scene.left, scene.right, nodes, kept
                )
            ):
                leaf = kept[j]
                row = rows[leaf]
                if (
                    row >= first
                    and row < filled
                    and out_leaf[row] == leaf
                    and out_exit[row] == before
                ):
                    out_exit[row] = here
                    continue
                if filled >= len(out_ray):
                    return -1
                out_ray[filled], out_leaf[filled] = ray, leaf
                out_entry[filled], out_exit[filled] = before, here
                rows[leaf] = filled
                filled += 1
        before = here
        toggle(
            owners[order[i] // 2], present, scene.parent, scene.operator, scene.left, scene.right
        )
    return filled


@kernel
def path_lengths(
    scene: Scene,
    origins: Floats,
    directions: Floats,
    ends: Floats,
    shortest: float,
    room: int,
    out: Floats,
    counter: Ints,
) -> int:
    """Fill ``out[i]`` with the path lengths of ray i; return the first ray without room, or -1."""
    entries, exits = np.empty(room), np.empty(room)
    owners = np.empty(room, dtype=np.int64)
    where, order = np.empty(2 * room), np.empty(2 * room, dtype=np.int64)
    work, lane = np.empty((6, 7)), np.empty(10)
    stack, found = np.empty((STACK, ROW)), np.empty((room, 2))
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(len(scene.leaf_radius) + 1, dtype=np.int64)
    for i in range(len(origins)):
        dx, dy, dz = directions[i, 0], directions[i, 1], directions[i, 2]
        count = leaf_intervals(
            scene,
            origins[i, 0],
            origins[i, 1],
            origins[i, 2],
            dx,
            dy,
            dz,
            ends[i],
            shortest,
            entries,
            exits,
            owners,
            work,
            lane,
            stack,
            found,
            counter,
        )
        if count < 0:
            return i
        lengths_of_ray(
            scene, count, entries, exits, owners, where, order, present, nodes, kept, out[i]
        )
    return -1


@kernel
def raster(
    scene: Scene,
    view: Floats,
    start_row: int,
    start_column: int,
    shortest: float,
    room: int,
    out: Floats,
    counter: Ints,
) -> int:
    """Fill ``out[row, column]`` ray by ray; return the first row without room, or -1.

    ``view`` is that of :func:`phantom.kernels.tiles.tiles`, which does the same much faster.
    """
    entries, exits = np.empty(room), np.empty(room)
    owners = np.empty(room, dtype=np.int64)
    where, order = np.empty(2 * room), np.empty(2 * room, dtype=np.int64)
    work, lane = np.empty((6, 7)), np.empty(10)
    stack, found = np.empty((STACK, ROW)), np.empty((room, 2))
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(len(scene.leaf_radius) + 1, dtype=np.int64)
    rows, columns = out.shape[0], out.shape[1]
    for i in range(rows):
        for j in range(columns):
            r, c = start_row + i, start_column + j
            px = view[0, 0] + r * view[1, 0] + c * view[2, 0]
            py = view[0, 1] + r * view[1, 1] + c * view[2, 1]
            pz = view[0, 2] + r * view[1, 2] + c * view[2, 2]
            dx = view[3, 0] + r * view[4, 0] + c * view[5, 0]
            dy = view[3, 1] + r * view[4, 1] + c * view[5, 1]
            dz = view[3, 2] + r * view[4, 2] + c * view[5, 2]
            end = math.sqrt(dx * dx + dy * dy + dz * dz)
            count = leaf_intervals(
                scene,
                px,
                py,
                pz,
                dx / end,
                dy / end,
                dz / end,
                end,
                shortest,
                entries,
                exits,
                owners,
                work,
                lane,
                stack,
                found,
                counter,
            )
            if count < 0:
                return i
            lengths_of_ray(
                scene,
                count,
                entries,
                exits,
                owners,
                where,
                order,
                present,
                nodes,
                kept,
                out[i, j],
            )
    return -1


@kernel
def intervals(
    scene: Scene,
    origins: Floats,
    directions: Floats,
    ends: Floats,
    shortest: float,
    room: int,
    out_ray: Ints,
    out_entry: Floats,
    out_exit: Floats,
    out_leaf: Ints,
    counter: Ints,
) -> tuple[int, int]:
    """Write the pieces of the final solid; return how many rays are done and rows filled."""
    entries, exits = np.empty(room), np.empty(room)
    owners = np.empty(room, dtype=np.int64)
    where, order = np.empty(2 * room), np.empty(2 * room, dtype=np.int64)
    work, lane = np.empty((6, 7)), np.empty(10)
    stack, found = np.empty((STACK, ROW)), np.empty((room, 2))
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(len(scene.leaf_radius) + 1, dtype=np.int64)
    rows = np.full(len(scene.leaf_radius), -1, dtype=np.int64)
    filled = whole(0)
    for i in range(len(origins)):
        count = leaf_intervals(
            scene,
            origins[i, 0],
            origins[i, 1],
            origins[i, 2],
            directions[i, 0],
            directions[i, 1],
            directions[i, 2],
            ends[i],
            shortest,
            entries,
            exits,
            owners,
            work,
            lane,
            stack,
            found,
            counter,
        )
        if count < 0:
            return i, filled
        # ``present`` would be left half swept, so rows are counted before they are written.
        if filled + 2 * count * count > len(out_ray):
            return i, filled
        filled = pieces_of_ray(
            scene,
            i,
            count,
            entries,
            exits,
            owners,
            where,
            order,
            present,
            nodes,
            kept,
            rows,
            out_ray,
            out_entry,
            out_exit,
            out_leaf,
            filled,
        )
    return len(origins), filled
