"""A raster tile by tile: every leaf's lanes, their slots, and the algebra over spans."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, kernel, whole
from phantom.kernels.isolation import isolate
from phantom.kernels.lanes import TILE_COLUMNS, TILE_ROWS, collect
from phantom.kernels.roots import ERROR_MM
from phantom.kernels.scratch import Scratch
from phantom.kernels.slots import clear, cut, ellipsoids, other_quadrics, pair_up, settle
from phantom.kernels.spans import combine

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@inner
def plane_along(
    n0: float, n1: float, n2: float, h: float, rays: Floats, center: Floats, into: Floats
) -> None:
    """Write n.x - h about a centre and n.d, each with its steps to the next row and column."""
    into[0] = (
        n0 * (rays[0, 0] - center[0])
        + n1 * (rays[0, 1] - center[1])
        + n2 * (rays[0, 2] - center[2])
        - h
    )
    for step in range(1, 6):
        into[step] = n0 * rays[step, 0] + n1 * rays[step, 1] + n2 * rays[step, 2]


@inner
def cylinder_records(
    scene: Scene,
    leaf: int,
    row: int,
    column: int,
    rows: int,
    columns: int,
    fields: Ints,
    shortest: float,
    enough: float,
    held: Scratch,
) -> tuple[int, int]:
    """Record where the rays of a tile enter and leave the segments of a generalized cylinder.

    Returns how many records there are, negative for no room, and how many of them are paired up:
    a ray through very many segments would need too much room for what cancels.
    """
    rays, knots, slabs, middle = held.rays, held.knots, held.slabs, held.middle
    filled, paired = whole(0), whole(0)
    center = scene.leaf_center[leaf]
    parts = scene.first_part[leaf + 1] - scene.first_part[leaf]
    # What is left of a chord in the next part may be far shorter than the chord itself.
    least = shortest if parts == 1 else 1e-5 * shortest
    for part in range(scene.first_part[leaf], scene.first_part[leaf + 1]):
        first, last = scene.first_segment[part], scene.first_segment[part + 1]
        known = -1
        for k in range(first, last):
            i0, i1 = max(fields[k, 0] - row, 0), min(fields[k, 1] - row, rows)
            j0, j1 = max(fields[k, 2] - column, 0), min(fields[k, 3] - column, columns)
            if i0 >= i1 or j0 >= j1:
                continue
            # Neighbours read the same numbers of the plane between them.
            for knot in range(k + part, k + part + 2):
                if knot > known:
                    plane_along(
                        scene.knots[knot, 0],
                        scene.knots[knot, 1],
                        scene.knots[knot, 2],
                        scene.knots[knot, 3],
                        rays,
                        center,
                        knots[knot - first - part],
                    )
                    known = knot
            for axis in range(3):
                middle[axis] = center[axis] + scene.origins[k, axis]
            for axis in range(3):
                low, high = scene.boxes[k, axis, 0], scene.boxes[k, axis, 1]
                plane_along(
                    scene.axes[k, axis, 0],
                    scene.axes[k, axis, 1],
                    scene.axes[k, axis, 2],
                    0.5 * (low + high),
                    rays,
                    middle,
                    slabs[axis],
                )
                slabs[axis, 6] = 0.5 * (high - low)
            n = collect(held.lanes, knots, k - first, slabs, i0, i1, j0, j1)
            if n == 0:
                continue
            filled = isolate(
                n,
                i0,
                i1,
                j0,
                j1,
                rays[0, 0] - middle[0],
                rays[0, 1] - middle[1],
                rays[0, 2] - middle[2],
                scene,
                k,
                least,
                enough,
                held,
                filled,
                columns,
            )
            if filled < 0:
                held.senses[:] = 0.0
                return filled, paired
            if 2 * filled > len(held.pixels):
                filled = paired = pair_up(paired, filled, held)
    return filled, paired


@inner
def aim_tile(view: Floats, row: int, column: int, rows: int, columns: int, rays: Floats) -> float:
    """Write the rays of a tile; return the longest way from source to pixel in it, in mm."""
    for axis in range(3):
        for step in range(6):
            rays[step, axis] = view[step, axis]
        rays[0, axis] += row * view[1, axis] + column * view[2, axis]
        rays[3, axis] += row * view[4, axis] + column * view[5, axis]
    longest = 0.0
    for corner in range(4):
        square = 0.0
        for axis in range(3):
            d = rays[3, axis]
            if corner & 1:
                d += rows * rays[4, axis]
            if corner & 2:
                d += columns * rays[5, axis]
            square += d * d
        longest = max(longest, square)
    return math.sqrt(longest)


@inner
def quadric_slots(
    scene: Scene,
    leaf: int,
    i0: int,
    i1: int,
    j0: int,
    j1: int,
    columns: int,
    held: Scratch,
    slots: int,
) -> int:
    """Add the slots of a quadric leaf; return how many there are then, or -1 for no room."""
    if slots >= len(held.owners):
        return -1
    clear(held.ends, slots)
    held.owners[slots] = leaf
    form = scene.leaf_form[leaf]
    if form < 0:
        # Planes alone: they are cut from the whole way.
        for i in range(i0, i1):
            for j in range(j0, j1):
                held.ends[2 * slots + 1, i * columns + j] = 1.0
        return slots + 1
    left = ellipsoids(
        scene.forms[form],
        held.rays,
        scene.leaf_center[leaf, 0],
        scene.leaf_center[leaf, 1],
        scene.leaf_center[leaf, 2],
        held.ends,
        slots,
        i0,
        i1,
        j0,
        j1,
        columns,
    )
    if left == 0:
        return slots + 1
    return other_quadrics(scene, leaf, i0, i1, j0, j1, columns, held, slots + 1)


@inner
def leaf_slots(
    scene: Scene,
    row: int,
    column: int,
    rows: int,
    columns: int,
    leaf_fields: Ints,
    fields: Ints,
    shortest: float,
    enough: float,
    held: Scratch,
) -> int:
    """Fill the slots of a tile; return how many there are, or -1 for no room."""
    slots = whole(0)
    for leaf in range(len(scene.leaf_radius)):
        i0, i1 = max(leaf_fields[leaf, 0] - row, 0), min(leaf_fields[leaf, 1] - row, rows)
        j0, j1 = max(leaf_fields[leaf, 2] - column, 0), min(leaf_fields[leaf, 3] - column, columns)
        if i0 >= i1 or j0 >= j1:
            continue
        base = slots
        parts = scene.first_part[leaf + 1] - scene.first_part[leaf]
        if parts == 0:
            slots = quadric_slots(scene, leaf, i0, i1, j0, j1, columns, held, slots)
        else:
            count, paired = cylinder_records(
                scene, leaf, row, column, rows, columns, fields, shortest, enough, held
            )
            if count < 0:
                return -1
            if count > 0:
                slots = settle(leaf, parts > 1, count, paired, held, slots)
        if slots < 0:
            return -1
        for k in range(scene.first_plane[leaf], scene.first_plane[leaf + 1]):
            cutting = held.beam
            plane_along(
                scene.planes[k, 0],
                scene.planes[k, 1],
                scene.planes[k, 2],
                scene.planes[k, 3],
                held.rays,
                scene.leaf_center[leaf],
                cutting,
            )
            for slot in range(base, slots):
                cut(held.ends, slot, cutting, rows, columns)
    return slots


@kernel
def tiles(
    scene: Scene,
    view: Floats,
    leaf_fields: Ints,
    fields: Ints,
    first_row: int,
    last_row: int,
    shortest_mm: float,
    held: Scratch,
    out: Floats,
    above: int,
    failed: Ints,
) -> int:
    """Fill rows ``first_row`` to ``last_row`` of a picture; count tiles left out.

    ``out`` (M, rows, columns) is the picture from row ``above`` on.
    ``view`` is (6, 3): the origin of pixel (0, 0)'s ray, its steps to the next row and column, the
    way from it to the pixel, and its steps. ``leaf_fields`` (L, 4) and ``fields`` (S, 4) are the
    pixels, first and last row and column, beyond which a leaf or a segment is not seen. The first
    row and column of a tile that needs more room than there is are written to ``failed``.
    """
    width = out.shape[2]
    missing = 0
    for row in range(first_row, last_row, TILE_ROWS):
        rows = min(TILE_ROWS, last_row - row)
        for column in range(0, width, TILE_COLUMNS):
            columns = min(TILE_COLUMNS, width - column)
            longest = aim_tile(view, row, column, rows, columns, held.rays)
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
            else:
                combine(scene, held, slots, rows, columns, row - above, column, out)
    return missing
