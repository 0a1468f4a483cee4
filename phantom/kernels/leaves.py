"""A ray against every leaf of a scene: where it enters and leaves each."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import CELLS, Scene
from phantom.kernels.compiling import inner, whole
from phantom.kernels.cylinder import chords, contract
from phantom.kernels.quadric import half_line, roots

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


JOIN_MM = 1e-10
"""Intervals of one leaf nearer than this are one: far below what any surface is right to."""


@inner
def through_box(
    box: Floats,
    leaf: int,
    px: float,
    py: float,
    pz: float,
    dx: float,
    dy: float,
    dz: float,
    low: float,
    high: float,
) -> tuple[float, float]:
    """Clip [low, high] to a leaf's world box; an empty part has low > high."""
    for axis in range(3):
        p = px if axis == 0 else (py if axis == 1 else pz)
        d = dx if axis == 0 else (dy if axis == 1 else dz)
        if d == 0.0:
            if p < box[leaf, 0, axis] or p > box[leaf, 1, axis]:
                return 1.0, 0.0
            continue
        a, b = (box[leaf, 0, axis] - p) / d, (box[leaf, 1, axis] - p) / d
        if a > b:
            a, b = b, a
        low, high = max(low, a), min(high, b)
    return low, high


@inner
def append(
    leaf: int,
    entry: float,
    exit_: float,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
) -> int:
    """Add an interval, or join it to the leaf's last one where they share an end exactly."""
    if not exit_ > entry:
        return count
    if count > 0 and owners[count - 1] == leaf:
        if exits[count - 1] == entry:
            exits[count - 1] = exit_
            return count
        if entries[count - 1] == exit_:
            entries[count - 1] = entry
            return count
    if count >= len(entries):
        return -1
    entries[count], exits[count], owners[count] = entry, exit_, leaf
    return count + 1


@inner
def quadric_leaf(
    scene: Scene,
    leaf: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    low: float,
    high: float,
    shift: float,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
) -> int:
    """Add the intervals of a quadric leaf within [low, high] (both about ``shift``)."""
    if scene.leaf_form[leaf] < 0:
        return append(leaf, low + shift, high + shift, count, entries, exits, owners)
    kind, w0, w1 = roots(
        scene.forms[scene.leaf_form[leaf]], x, y, z, dx, dy, dz, scene.leaf_radius[leaf]
    )
    if kind == 1:
        low, high = max(low, w0), min(high, w1)
    elif kind == 4:
        high = min(high, w0)
    elif kind == 5:
        low = max(low, w0)
    elif kind == 0:
        return count
    elif kind == 2:
        count = append(leaf, low + shift, min(high, w0) + shift, count, entries, exits, owners)
        if count < 0:
            return count
        low = max(low, w1)
    return append(leaf, low + shift, high + shift, count, entries, exits, owners)


@inner
def cylinder_part(
    scene: Scene,
    leaf: int,
    part: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    low: float,
    high: float,
    shift: float,
    shortest: float,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
    work: Floats,
    lane: Floats,
    stack: Floats,
    found: Floats,
    counter: Ints,
) -> int:
    """Add the intervals of one part of a generalized cylinder within [low, high]."""
    first, last = scene.first_segment[part], scene.first_segment[part + 1]
    knot = first + part
    n0, n1, n2 = scene.knots[knot, 0], scene.knots[knot, 1], scene.knots[knot, 2]
    f0 = n0 * x + n1 * y + n2 * z - scene.knots[knot, 3]
    slope0 = n0 * dx + n1 * dy + n2 * dz
    for k in range(first, last):
        knot += 1
        n0, n1, n2 = scene.knots[knot, 0], scene.knots[knot, 1], scene.knots[knot, 2]
        f1 = n0 * x + n1 * y + n2 * z - scene.knots[knot, 3]
        slope1 = n0 * dx + n1 * dy + n2 * dz
        # The segment's wedge is F_k >= 0 > F_k+1: neighbours read the same crossing.
        a, b = low, high
        if slope0 > 0:
            a = max(a, -f0 / slope0)
        elif slope0 < 0:
            b = min(b, -f0 / slope0)
        elif f0 < 0:
            b = a - 1.0
        if slope1 > 0:
            b = min(b, -f1 / slope1)
        elif slope1 < 0:
            a = max(a, -f1 / slope1)
        elif f1 >= 0:
            b = a - 1.0
        f0, slope0 = f1, slope1
        if not a < b:
            continue
        ox, oy, oz = x - scene.origins[k, 0], y - scene.origins[k, 1], z - scene.origins[k, 2]
        e0 = e1 = e2 = 0.0
        for axis in range(3):
            u0, u1, u2 = scene.axes[k, axis, 0], scene.axes[k, axis, 1], scene.axes[k, axis, 2]
            p = u0 * ox + u1 * oy + u2 * oz
            d = u0 * dx + u1 * dy + u2 * dz
            a, b = half_line(p - scene.boxes[k, axis, 1], d, a, b)
            if not a < b:
                break
            a, b = half_line(scene.boxes[k, axis, 0] - p, -d, a, b)
            if not a < b:
                break
            if axis == 2:
                e2 = d
                break
            cells = CELLS / (scene.boxes[k, axis, 1] - scene.boxes[k, axis, 0])
            lane[2 * axis] = (p - scene.boxes[k, axis, 0]) * cells
            lane[2 * axis + 1] = d * cells
            if axis == 0:
                e0 = d
            else:
                e1 = d
        if not a < b:
            continue
        lane[4], lane[5], lane[6] = e0 * e0, e1 * e1, e2 * e2
        lane[7], lane[8], lane[9] = 2.0 * e0 * e1, 2.0 * e0 * e2, 2.0 * e1 * e2
        contract(scene.polynomials, k, ox, oy, oz, dx, dy, dz, work)
        chord_count = chords(
            work,
            stack,
            scene.hessians,
            scene.kinks,
            k,
            lane,
            a,
            b,
            shortest,
            scene.segment_table[k],
            scene.tables,
            found,
            len(found),
            counter,
        )
        if chord_count < 0:
            return -1
        for i in range(chord_count):
            count = append(
                leaf, found[i, 0] + shift, found[i, 1] + shift, count, entries, exits, owners
            )
            if count < 0:
                return -1
    return count


@inner
def cylinder_leaf(
    scene: Scene,
    leaf: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    low: float,
    high: float,
    shift: float,
    shortest: float,
    count: int,
    entries: Floats,
    exits: Floats,
    owners: Ints,
    work: Floats,
    lane: Floats,
    stack: Floats,
    found: Floats,
    counter: Ints,
) -> int:
    """Add the intervals of a generalized cylinder within [low, high] (both about ``shift``)."""
    start = count
    first, last = scene.first_part[leaf], scene.first_part[leaf + 1]
    # What is left of a chord in the next part may be far shorter than the chord itself.
    least = shortest if last - first == 1 else 1e-5 * shortest
    for part in range(first, last):
        count = cylinder_part(
            scene,
            leaf,
            part,
            x,
            y,
            z,
            dx,
            dy,
            dz,
            low,
            high,
            shift,
            least,
            count,
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
            return -1
    if last - first > 1:
        return unite(start, count, entries, exits)
    return count


@inner
def unite(start: int, count: int, entries: Floats, exits: Floats) -> int:
    """Sort the intervals from ``start`` on and join those that overlap; return the new count.

    The parts of one contour overlap a little where they were cut.
    """
    for i in range(start + 1, count):
        a, b = entries[i], exits[i]
        j = i
        while j > start and entries[j - 1] > a:
            entries[j], exits[j] = entries[j - 1], exits[j - 1]
            j -= 1
        entries[j], exits[j] = a, b
    kept = start
    for i in range(start + 1, count):
        if entries[i] <= exits[kept] + JOIN_MM:
            exits[kept] = max(exits[kept], exits[i])
        else:
            kept += 1
            entries[kept], exits[kept] = entries[i], exits[i]
    return min(kept + 1, count)


@inner
def leaf_intervals(
    scene: Scene,
    px: float,
    py: float,
    pz: float,
    dx: float,
    dy: float,
    dz: float,
    end: float,
    shortest: float,
    entries: Floats,
    exits: Floats,
    owners: Ints,
    work: Floats,
    lane: Floats,
    stack: Floats,
    found: Floats,
    counter: Ints,
) -> int:
    """Write every leaf's intervals on p + w d, 0 <= w <= end, d of length 1; return how many.

    A negative answer means there was no room: the caller brings more.
    """
    count = whole(0)
    for leaf in range(len(scene.leaf_radius)):
        low, high = through_box(scene.leaf_box, leaf, px, py, pz, dx, dy, dz, 0.0, end)
        if not low < high:
            continue
        # Distances are counted from the point of the ray nearest the leaf's centre.
        cx, cy, cz = (
            scene.leaf_center[leaf, 0],
            scene.leaf_center[leaf, 1],
            scene.leaf_center[leaf, 2],
        )
        x, y, z = px - cx, py - cy, pz - cz
        shift = -(x * dx + y * dy + z * dz)
        x, y, z = x + shift * dx, y + shift * dy, z + shift * dz
        low, high = -shift, end - shift
        radius = scene.leaf_radius[leaf]
        inside = radius * radius - (x * x + y * y + z * z)
        if inside <= 0:
            continue
        half = math.sqrt(inside)
        low, high = max(low, -half), min(high, half)
        for k in range(scene.first_plane[leaf], scene.first_plane[leaf + 1]):
            n0, n1, n2 = scene.planes[k, 0], scene.planes[k, 1], scene.planes[k, 2]
            low, high = half_line(
                n0 * x + n1 * y + n2 * z - scene.planes[k, 3],
                n0 * dx + n1 * dy + n2 * dz,
                low,
                high,
            )
        if not low < high:
            continue
        if scene.first_part[leaf] == scene.first_part[leaf + 1]:
            count = quadric_leaf(
                scene, leaf, x, y, z, dx, dy, dz, low, high, shift, count, entries, exits, owners
            )
        else:
            count = cylinder_leaf(
                scene,
                leaf,
                x,
                y,
                z,
                dx,
                dy,
                dz,
                low,
                high,
                shift,
                shortest,
                count,
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
            return -1
    return count
