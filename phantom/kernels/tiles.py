"""A raster tile by tile: every leaf's lanes, their slots, and the algebra over spans."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import kernel
from phantom.kernels.isolation import STEP_MM, isolate
from phantom.kernels.lanes import LANES, ROWS, STRIDE, TILE_COLUMNS, TILE_ROWS, collect
from phantom.kernels.slots import clear, cut, ellipsoids, other_quadrics, settle
from phantom.kernels.spans import MOST, combine

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RECORDS = 12 * LANES
"""Records that one leaf may leave in a tile."""


@kernel
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


@kernel
def cylinder_records(
    scene: Scene,
    leaf: int,
    rays: Floats,
    row: int,
    column: int,
    rows: int,
    columns: int,
    fields: Ints,
    shortest: float,
    enough: float,
    S: Floats,
    knots: Floats,
    slabs: Floats,
    beam: Floats,
    middle: Floats,
    pixels: Ints,
    where: Floats,
    signs: Floats,
) -> int:
    """Record where the rays of a tile enter and leave the segments of a generalized cylinder."""
    filled = 0
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
            n = collect(S, knots, k - first, slabs, i0, i1, j0, j1)
            if n == 0:
                continue
            filled = isolate(
                S,
                n,
                rays,
                rays[0, 0] - middle[0],
                rays[0, 1] - middle[1],
                rays[0, 2] - middle[2],
                slabs,
                scene,
                k,
                least,
                enough,
                beam,
                pixels,
                where,
                signs,
                filled,
                columns,
            )
            if filled < 0:
                return -1
    return filled


@kernel
def tiles(
    scene: Scene,
    view: Floats,
    leaf_fields: Ints,
    fields: Ints,
    first_row: int,
    last_row: int,
    shortest_mm: float,
    room: int,
    out: Floats,
    failed: Ints,
) -> int:
    """Fill rows ``first_row`` to ``last_row`` of ``out`` (M, rows, columns); count tiles left out.

    ``view`` is (6, 3): the origin of pixel (0, 0)'s ray, its steps to the next row and column, the
    way from it to the pixel, and its steps. ``leaf_fields`` (L, 4) and ``fields`` (S, 4) are the
    pixels, first and last row and column, beyond which a leaf or a segment is not seen. The first
    row and column of a tile that needs more room than there is are written to ``failed``.
    """
    width = out.shape[2]
    leaves = len(scene.leaf_radius)
    most = 0
    for part in range(len(scene.first_segment) - 1):
        most = max(most, scene.first_segment[part + 1] - scene.first_segment[part])
    S = np.zeros(ROWS * STRIDE)
    knots, slabs, beam = np.empty((most + 1, 6)), np.empty((3, 8)), np.empty(10)
    middle, rays = np.empty(3), np.empty((6, 3))
    pixels, where = np.empty(RECORDS, dtype=np.int64), np.empty(RECORDS)
    signs = np.empty(RECORDS)
    first, last, total = np.empty(LANES), np.empty(LANES), np.empty(LANES)
    book = np.empty((3, LANES), dtype=np.int64)
    ends, owners = np.empty((2 * room, LANES)), np.empty(room, dtype=np.int64)
    masks = np.empty(TILE_COLUMNS, dtype=np.int64)
    wrong, met = np.empty(TILE_COLUMNS, dtype=np.int64), np.empty(room + 1, dtype=np.int64)
    events, order = np.empty(2 * MOST + 4), np.empty(2 * MOST + 4, dtype=np.int64)
    factors, sums = np.empty((out.shape[0], 2 * MOST + 4)), np.zeros(TILE_COLUMNS)
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 2 * MOST + 4, dtype=np.int64)
    kept = np.empty(leaves + 2 * MOST + 4, dtype=np.int64)
    entries, exits, found = np.empty(8), np.empty(8), np.empty(8, dtype=np.int64)
    missing = 0
    for row in range(first_row, last_row, TILE_ROWS):
        rows = min(TILE_ROWS, last_row - row)
        for column in range(0, width, TILE_COLUMNS):
            columns = min(TILE_COLUMNS, width - column)
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
                    d += (rows * rays[4, axis]) if corner & 1 else 0.0
                    d += (columns * rays[5, axis]) if corner & 2 else 0.0
                    square += d * d
                longest = max(longest, square)
            longest = np.sqrt(longest)
            slots = 0
            for leaf in range(leaves):
                i0, i1 = max(leaf_fields[leaf, 0] - row, 0), min(leaf_fields[leaf, 1] - row, rows)
                j0 = max(leaf_fields[leaf, 2] - column, 0)
                j1 = min(leaf_fields[leaf, 3] - column, columns)
                if i0 >= i1 or j0 >= j1:
                    continue
                base = slots
                if scene.first_part[leaf] == scene.first_part[leaf + 1]:
                    if slots >= room:
                        slots = -1
                        break
                    clear(ends, slots)
                    owners[slots] = leaf
                    slots += 1
                    form = scene.leaf_form[leaf]
                    if form < 0:
                        for i in range(i0, i1):
                            for j in range(j0, j1):
                                ends[2 * base + 1, i * columns + j] = 1.0
                    else:
                        left = ellipsoids(
                            scene.forms[form],
                            rays,
                            scene.leaf_center[leaf, 0],
                            scene.leaf_center[leaf, 1],
                            scene.leaf_center[leaf, 2],
                            ends,
                            base,
                            i0,
                            i1,
                            j0,
                            j1,
                            columns,
                        )
                        if left > 0:
                            slots = other_quadrics(
                                scene,
                                leaf,
                                rays,
                                i0,
                                i1,
                                j0,
                                j1,
                                columns,
                                ends,
                                owners,
                                slots,
                                True,
                                entries,
                                exits,
                                found,
                            )
                else:
                    count = cylinder_records(
                        scene,
                        leaf,
                        rays,
                        row,
                        column,
                        rows,
                        columns,
                        fields,
                        shortest_mm / longest,
                        STEP_MM / longest,
                        S,
                        knots,
                        slabs,
                        beam,
                        middle,
                        pixels,
                        where,
                        signs,
                    )
                    if count < 0:
                        slots = -1
                    elif count > 0:
                        united = scene.first_part[leaf + 1] - scene.first_part[leaf] > 1
                        slots = settle(
                            leaf,
                            united,
                            pixels,
                            where,
                            signs,
                            count,
                            first,
                            last,
                            total,
                            book,
                            ends,
                            owners,
                            slots,
                        )
                if slots < 0:
                    break
                for plane in range(scene.first_plane[leaf], scene.first_plane[leaf + 1]):
                    plane_along(
                        scene.planes[plane, 0],
                        scene.planes[plane, 1],
                        scene.planes[plane, 2],
                        scene.planes[plane, 3],
                        rays,
                        scene.leaf_center[leaf],
                        beam,
                    )
                    for slot in range(base, slots):
                        cut(
                            ends,
                            slot,
                            beam[0],
                            beam[1],
                            beam[2],
                            beam[3],
                            beam[4],
                            beam[5],
                            rows,
                            columns,
                        )
            done = slots >= 0 and combine(
                scene,
                rays,
                ends,
                owners,
                slots,
                rows,
                columns,
                masks,
                wrong,
                met,
                events,
                order,
                factors,
                sums,
                present,
                nodes,
                kept,
                out[:, row : row + rows, column : column + columns],
            )
            if not done:
                failed[missing, 0], failed[missing, 1] = row, column
                missing += 1
    return missing
