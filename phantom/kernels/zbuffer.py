"""Closed triangle meshes on a raster: every crossing of every ray, and what is seen first.

The ray of pixel (row i, column j) is ``o + t d`` with o and d linear in i and j. It crosses a
triangle where the three edge functions ``E_ab = d . (a x b) - o . (d x (a - b))``, linear in i and
j too, have one sign (M. Olano and T. Greer, *Triangle Scan Conversion using 2D Homogeneous
Coordinates*, Graphics Hardware 1997): no triangle need be cut where it passes behind the eye. Two
triangles see the edge they share with exactly opposite values, and a 0 is decided by the slopes, as
if the raster were shifted by next to nothing: so a ray enters a closed mesh as often as it leaves
it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import kernel
from phantom.kernels.csg import sort_events, toggle
from phantom.kernels.first_hit import first_of_ray, first_shown

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]


@kernel
def edge(a: Floats, b: Floats, view: Floats, out: Floats) -> None:
    """Write an edge function's value at pixel (0, 0), its step along a row and down a column."""
    nx = a[1] * b[2] - a[2] * b[1]
    ny = a[2] * b[0] - a[0] * b[2]
    nz = a[0] * b[1] - a[1] * b[0]
    d = view[3]
    ux, uy, uz = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    mx, my, mz = d[1] * uz - d[2] * uy, d[2] * ux - d[0] * uz, d[0] * uy - d[1] * ux
    out[0] = d[0] * nx + d[1] * ny + d[2] * nz
    right, down = view[5], view[4]
    across, below = view[2], view[1]
    out[1] = (right[0] * nx + right[1] * ny + right[2] * nz) - (
        across[0] * mx + across[1] * my + across[2] * mz
    )
    out[2] = (down[0] * nx + down[1] * ny + down[2] * nz) - (
        below[0] * mx + below[1] * my + below[2] * mz
    )


@kernel
def side_of(value: float, along: float, below: float) -> int:
    """Return the sign of an edge function; of 0 that of a step along the row, or down."""
    if value != 0.0:
        return 1 if value > 0.0 else -1
    if along != 0.0:
        return 1 if along > 0.0 else -1
    if below != 0.0:
        return 1 if below > 0.0 else -1
    return 0


@kernel
def crossings(
    corners: Floats,
    fields: Ints,
    view: Floats,
    first_row: int,
    heads: Ints,
    links: Ints,
    depths: Floats,
    owners: Ints,
) -> int:
    """List every crossing of a band of rays with triangles, pixel by pixel.

    Parameters
    ----------
    corners
        (T, 3, 3) mm, about the origin of the ray of pixel (0, 0).
    fields
        (T, 4) first and last row and column, half-open, of pixels that may see each triangle.
    view
        (6, 3) origin, its steps down and along a row, direction, and its steps.
    first_row
        Of the band.
    heads
        (rows, columns): filled with the first crossing of each pixel, -1 for none.
    links, depths, owners
        (room,) filled with the next crossing of the pixel, its t, and twice the triangle, one more
        where the ray leaves.

    Returns
    -------
    How many crossings there are, or -1 where there was no room.
    """
    rows, columns = heads.shape
    heads[:] = -1
    count = 0
    one, two, three = np.empty(3), np.empty(3), np.empty(3)
    for k in range(len(corners)):
        top, bottom = max(fields[k, 0] - first_row, 0), min(fields[k, 1] - first_row, rows)
        left, right = max(fields[k, 2], 0), min(fields[k, 3], columns)
        if top >= bottom or left >= right:
            continue
        a, b, c = corners[k, 0], corners[k, 1], corners[k, 2]
        edge(b, c, view, one)
        edge(c, a, view, two)
        edge(a, b, view, three)
        px, py, pz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        qx, qy, qz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        nx, ny, nz = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
        level = a[0] * nx + a[1] * ny + a[2] * nz
        along = view[2, 0] * nx + view[2, 1] * ny + view[2, 2] * nz
        below = view[1, 0] * nx + view[1, 1] * ny + view[1, 2] * nz
        for i in range(top, bottom):
            row = first_row + i
            e1, e2, e3 = one[0] + row * one[2], two[0] + row * two[2], three[0] + row * three[2]
            for j in range(left, right):
                f1, f2, f3 = e1 + j * one[1], e2 + j * two[1], e3 + j * three[1]
                s = side_of(f1, one[1], one[2])
                if s == 0 or side_of(f2, two[1], two[2]) != s:
                    continue
                if side_of(f3, three[1], three[2]) != s:
                    continue
                slope = f1 + f2 + f3
                if slope == 0.0:
                    continue
                t = (level - j * along - row * below) / slope
                if not 0.0 < t < math.inf:
                    continue
                if count == len(links):
                    return -1
                links[count] = heads[i, j]
                depths[count] = t
                owners[count] = 2 * k + (1 if s > 0 else 0)
                heads[i, j] = count
                count += 1
    return count


@kernel
def resolve(
    scene: Scene,
    shown: Flags,
    leaf_of: Ints,
    tolerance: float,
    heads: Ints,
    links: Ints,
    depths: Floats,
    owners: Ints,
    found: Floats,
    hits: Ints,
    triangles: Ints,
) -> None:
    """Find what each pixel of a band sees first, from its list of crossings.

    Parameters
    ----------
    shown
        (L,) whether a leaf is shown; others are looked through.
    leaf_of
        (T,) leaf of each triangle.
    tolerance
        What is thinner, in t, is not seen.
    heads, links, depths, owners
        As :func:`crossings` leaves them.
    found, hits, triangles
        (rows, columns) filled with the t of the first hit, inf for none; for hits alone,
        (rows, columns, 4) with what :data:`phantom.kernels.first_hit.SURFACE` and so on tell, and
        (rows, columns) with its triangle.
    """
    rows, columns = heads.shape
    longest = 0
    for i in range(rows):
        for j in range(columns):
            length, at = 0, heads[i, j]
            while at >= 0:
                length += 1
                at = links[at]
            longest = max(longest, length)
    leaves = len(scene.leaf_radius)
    t, order = np.empty(longest), np.empty(longest, dtype=np.int64)
    which = np.empty(longest, dtype=np.int64)
    # A leaf whose way in lies behind the eye has been entered at 0: one interval more.
    entries, exits = np.empty(longest), np.empty(longest)
    whose = np.empty(longest, dtype=np.int64)
    where, sorted_ = np.empty(2 * longest), np.empty(2 * longest, dtype=np.int64)
    inside = np.zeros(leaves, dtype=np.int64)
    since = np.zeros(leaves)
    present = np.zeros(len(scene.parent), dtype=np.uint8)
    nodes = np.empty(len(scene.parent) + 1, dtype=np.int64)
    kept = np.empty(leaves + 1, dtype=np.int64)
    hit = np.empty(4, dtype=np.int64)
    # What is seen where a leaf is by itself.
    alone = np.empty(leaves, dtype=np.int64)
    for k in range(leaves):
        toggle(k, present, scene.parent, scene.operator, scene.left, scene.right)
        alone[k] = first_shown(scene, shown, present, nodes, kept)
        toggle(k, present, scene.parent, scene.operator, scene.left, scene.right)
    for i in range(rows):
        for j in range(columns):
            found[i, j] = math.inf
            at = heads[i, j]
            if at < 0:
                continue
            count = 0
            while at >= 0:
                t[count], which[count], order[count] = depths[at], owners[at], count
                count += 1
                at = links[at]
            # What is left more often than it is entered was entered behind the eye.
            for k in range(count):
                inside[leaf_of[which[k] // 2]] += 1 if which[k] % 2 == 1 else -1
            first, second, begun = 0, -1, False
            for k in range(count):
                begun = begun or inside[leaf_of[which[k] // 2]] != 0
                if t[k] < t[first]:
                    first, second = k, first
                elif k != first and (second < 0 or t[k] < t[second]):
                    second = k
            leaf = leaf_of[which[first] // 2]
            if not begun and alone[leaf] >= 0 and t[second] - t[first] > tolerance:
                # Mostly one leaf begins where nothing was, and is seen.
                found[i, j], triangles[i, j] = t[first], which[first] // 2
                hits[i, j, 0], hits[i, j, 1] = leaf, alone[leaf]
                hits[i, j, 2], hits[i, j, 3] = 1, 0
                continue
            sort_events(t, order, count)
            pieces = 0
            for k in range(count):
                event = order[k]
                leaf = leaf_of[which[event] // 2]
                if which[event] % 2 == 0:
                    if inside[leaf] == 0:
                        since[leaf] = t[event]
                    inside[leaf] += 1
                else:
                    inside[leaf] -= 1
                    if inside[leaf] == 0:
                        entries[pieces], exits[pieces] = since[leaf], t[event]
                        whose[pieces] = leaf
                        pieces += 1
            for k in range(count):
                leaf = leaf_of[which[k] // 2]
                inside[leaf], since[leaf] = 0, 0.0
            seen = first_of_ray(
                scene,
                pieces,
                entries,
                exits,
                whose,
                shown,
                tolerance,
                where,
                sorted_,
                present,
                nodes,
                kept,
                hit,
            )
            if seen == math.inf:
                continue
            found[i, j] = seen
            for k in range(4):
                hits[i, j, k] = hit[k]
            for k in range(count):
                if t[k] == seen and leaf_of[which[k] // 2] == hit[0]:
                    triangles[i, j] = which[k] // 2
                    break


@kernel
def facets(
    corners: Floats,
    slopes: Floats,
    view: Floats,
    first_row: int,
    found: Floats,
    triangles: Ints,
    normals: Floats,
) -> None:
    """Write the normal (rows, columns, 3) of each pixel, between those of a triangle's corners.

    ``slopes`` are the corners' unit normals (T, 3, 3).
    """
    one, two, three = np.empty(3), np.empty(3), np.empty(3)
    for i in range(found.shape[0]):
        for j in range(found.shape[1]):
            if found[i, j] == math.inf:
                continue
            k, row = triangles[i, j], first_row + i
            a, b, c = corners[k, 0], corners[k, 1], corners[k, 2]
            edge(b, c, view, one)
            edge(c, a, view, two)
            edge(a, b, view, three)
            e1 = one[0] + row * one[2] + j * one[1]
            e2 = two[0] + row * two[2] + j * two[1]
            e3 = three[0] + row * three[2] + j * three[1]
            x = e1 * slopes[k, 0, 0] + e2 * slopes[k, 1, 0] + e3 * slopes[k, 2, 0]
            y = e1 * slopes[k, 0, 1] + e2 * slopes[k, 1, 1] + e3 * slopes[k, 2, 1]
            z = e1 * slopes[k, 0, 2] + e2 * slopes[k, 1, 2] + e3 * slopes[k, 2, 2]
            length = math.sqrt(x * x + y * y + z * z)
            normals[i, j, 0] = normals[i, j, 1] = normals[i, j, 2] = 0.0
            if length > 0.0:
                # All three weights have the sign of the side that is seen.
                length = length if e1 + e2 + e3 > 0.0 else -length
                normals[i, j, 0], normals[i, j, 1] = x / length, y / length
                normals[i, j, 2] = z / length
