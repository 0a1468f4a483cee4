"""Where each pixel of a tile enters and leaves each leaf.

A slot holds one interval of one leaf a pixel, as two rows of ``ends``: entry and exit, as parts of
the way from source to pixel. Equal ends mean that it is missed; a leaf that a ray meets several
times has several slots.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, lane_loop, whole
from phantom.kernels.lanes import LANES, at
from phantom.kernels.leaves import quadric_leaf
from phantom.kernels.scratch import Scratch

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

JOIN = 1e-13
"""Intervals of one leaf nearer than this part of the way from source to pixel are one."""


@lane_loop
def clear(ends: Floats, slot: int) -> None:
    """Make a slot that every pixel misses."""
    for p in range(LANES):
        ends[2 * slot, p] = 0.0
        ends[2 * slot + 1, p] = 0.0


@inner
def pair_up(start: int, end: int, held: Scratch) -> int:
    """Cancel records of one segment against those of the one before; return where they end now.

    A ray that runs on inside through the plane between two segments leaves the one where it enters
    the other, to the last bit. Of each pixel two records are held back, since either may be the
    partner of one to come; the rest is written from ``start`` on.
    """
    pixels, where, signs = held.pixels, held.where, held.signs
    waiting, senses = held.waiting, held.senses
    for r in range(start, end):
        p, w, sign = at(0, pixels[r]), where[r], signs[r]
        if senses[0, p] == -sign and waiting[0, p] == w:
            senses[0, p] = 0.0
            continue
        if senses[1, p] == -sign and waiting[1, p] == w:
            senses[1, p] = 0.0
            continue
        if senses[1, p] != 0.0:
            # The older one goes: it has met the records of a whole segment.
            pixels[at(0, start)], where[at(0, start)], signs[at(0, start)] = (
                p,
                waiting[1, p],
                senses[1, p],
            )
            start += 1
        waiting[1, p], senses[1, p] = waiting[0, p], senses[0, p]
        waiting[0, p], senses[0, p] = w, sign
    return start


@inner
def let_go(filled: int, held: Scratch) -> int:
    """Record all that was held back; return how many records there are, or -1 for no room."""
    pixels, where, signs = held.pixels, held.where, held.signs
    waiting, senses = held.waiting, held.senses
    if filled + 2 * LANES > len(pixels):
        return -1
    for side in range(2):
        for p in range(LANES):
            if senses[side, p] != 0.0:
                pixels[at(0, filled)], where[at(0, filled)], signs[at(0, filled)] = (
                    p,
                    waiting[side, p],
                    senses[side, p],
                )
                senses[side, p] = 0.0
                filled += 1
    return filled


@inner
def settle(
    leaf: int,
    united: bool,
    count: int,
    paired: int,
    held: Scratch,
    slots: int,
) -> int:
    """Turn the records of one leaf into slots; return how many slots there are, or -1 for no room.

    Nearly always a pixel's records add up to one interval: where its ends lie as far apart as the
    pieces are long together. Where they do not, or where ``united`` parts may overlap, what cancels
    is taken out and the rest sorted. ``book`` (3, lanes) counts a pixel's records, says where they
    begin once they are brought together, and how many have been.
    """
    pixels, where, signs = held.pixels, held.where, held.signs
    first, last, total, book = held.first, held.last, held.total, held.book
    ends, owners = held.ends, held.owners
    cancelled = united or paired > 0
    if cancelled:
        count = let_go(pair_up(paired, count, held), held)
    if count < 0 or slots >= len(owners):
        return -1
    for p in range(LANES):
        first[p], last[p], total[p], book[0, p] = 2.0, -1.0, 0.0, 0
    for r in range(count):
        p, w = at(0, pixels[r]), where[r]
        book[0, p] += 1
        if signs[r] > 0.0:
            first[p] = min(first[p], w)
            total[p] -= w
        else:
            last[p] = max(last[p], w)
            total[p] += w
    base = slots
    clear(ends, base)
    owners[base] = leaf
    slots += 1
    unsettled = False
    for p in range(LANES):
        if book[0, p] == 0:
            continue
        if not united and last[p] - first[p] - total[p] <= 1e-12:
            ends[2 * base, p], ends[2 * base + 1, p] = first[p], last[p]
            book[0, p] = 0
        else:
            unsettled = True
    if not unsettled:
        return slots
    if not cancelled:
        count = let_go(pair_up(whole(0), count, held), held)
        if count < 0:
            return -1
        for p in range(LANES):
            book[1, p], book[0, p] = book[0, p], 0
        for r in range(count):
            book[0, pixels[r]] += 1 if book[1, pixels[r]] > 0 else 0
    several = count
    for p in range(LANES):
        if book[0, p] > 0:
            book[1, p], book[2, p] = several, 0
            several += book[0, p]
    # The rest is brought together behind the records, pixel by pixel, and sorted on the way.
    if several > len(pixels):
        return -1
    for r in range(count):
        p = pixels[r]
        if book[0, p] == 0:
            continue
        k = book[1, p] + book[2, p]
        book[2, p] += 1
        while k > book[1, p] and (
            where[k - 1] > where[r] or (where[k - 1] == where[r] and signs[k - 1] < signs[r])
        ):
            where[k], signs[k] = where[k - 1], signs[k - 1]
            k -= 1
        where[k], signs[k] = where[r], signs[r]
    for p in range(LANES):
        if book[0, p] == 0:
            continue
        depth, slot, entry = 0.0, base, 0.0
        begun = False
        for k in range(book[1, p], book[1, p] + book[0, p]):
            if depth == 0.0:
                if not begun:
                    entry, begun = where[k], True
                elif where[k] > ends[2 * slot + 1, p] + JOIN:
                    slot += 1
                    entry = where[k]
                    if slot >= slots:
                        if slot >= len(owners):
                            return -1
                        clear(ends, slot)
                        owners[slot] = leaf
                        slots += 1
            depth += signs[k]
            if depth == 0.0:
                ends[2 * slot, p], ends[2 * slot + 1, p] = entry, where[k]
    return slots


@lane_loop
def cut(
    ends: Floats,
    slot: int,
    plane: Floats,
    rows: int,
    columns: int,
) -> None:
    """Keep of a slot what lies where f + w d <= 0.

    ``plane`` holds f and its steps to the next row and column, then d and its steps.
    """
    f0, fi, fj = plane[0], plane[1], plane[2]
    d0, di, dj = plane[3], plane[4], plane[5]
    for i in range(rows):
        f, d = f0 + i * fi, d0 + i * di
        for j in range(columns):
            p = i * columns + j
            value, slope = f + j * fj, d + j * dj
            t = -value / slope
            a, b = ends[2 * slot, p], ends[2 * slot + 1, p]
            a = t if (slope < 0.0) & (t > a) else a
            b = t if (slope > 0.0) & (t < b) else b
            b = a if (slope == 0.0) & (value > 0.0) else b
            missed = b <= a
            ends[2 * slot, p] = 0.0 if missed else a
            ends[2 * slot + 1, p] = 0.0 if missed else b


@lane_loop
def ellipsoids(
    form: Floats,
    rays: Floats,
    cx: float,
    cy: float,
    cz: float,
    ends: Floats,
    slot: int,
    i0: int,
    i1: int,
    j0: int,
    j1: int,
    columns: int,
) -> int:
    """Fill a slot with the part of the ray inside a quadric that the ray meets in one piece.

    Returns how many pixels of the rectangle do not, a <= 0 or nearly: they are left with an exit of
    -1.
    """
    a00, a11, a22, a01, a02, a12 = form[0], form[1], form[2], form[3], form[4], form[5]
    b0, b1, b2, c = form[6], form[7], form[8], form[9]
    oxj, oyj, ozj = rays[2, 0], rays[2, 1], rays[2, 2]
    dxj, dyj, dzj = rays[5, 0], rays[5, 1], rays[5, 2]
    scale = 1e-9 * (abs(a00) + abs(a11) + abs(a22))
    left, first = 0, float(j0)
    for i in range(i0, i1):
        ox = rays[0, 0] + i * rays[1, 0] - cx
        oy = rays[0, 1] + i * rays[1, 1] - cy
        oz = rays[0, 2] + i * rays[1, 2] - cz
        dx0 = rays[3, 0] + i * rays[4, 0]
        dy0 = rays[3, 1] + i * rays[4, 1]
        dz0 = rays[3, 2] + i * rays[4, 2]
        entries = ends[2 * slot, i * columns + j0 : i * columns + j1]
        exits = ends[2 * slot + 1, i * columns + j0 : i * columns + j1]
        for m in range(j1 - j0):
            j = first + m
            x, y, z = ox + j * oxj, oy + j * oyj, oz + j * ozj
            dx, dy, dz = dx0 + j * dxj, dy0 + j * dyj, dz0 + j * dzj
            adx = a00 * dx + a01 * dy + a02 * dz
            ady = a01 * dx + a11 * dy + a12 * dz
            adz = a02 * dx + a12 * dy + a22 * dz
            a = adx * dx + ady * dy + adz * dz
            b = adx * x + ady * y + adz * z + b0 * dx + b1 * dy + b2 * dz
            plain = a > scale * (dx * dx + dy * dy + dz * dz)
            over = 1.0 / (a if plain else 1.0)
            # About the point of the ray where Q is least the two roots are equal and opposite.
            shift = -b * over
            x, y, z = x + shift * dx, y + shift * dy, z + shift * dz
            b = adx * x + ady * y + adz * z + b0 * dx + b1 * dy + b2 * dz
            level = (
                x * (a00 * x + 2.0 * (a01 * y + a02 * z + b0))
                + y * (a11 * y + 2.0 * (a12 * z + b1))
                + z * (a22 * z + 2.0 * b2)
                + c
            )
            square = b * b - a * level
            half = math.sqrt(max(square, 0.0)) * over
            middle = shift - b * over
            entry, exit_ = max(middle - half, 0.0), min(middle + half, 1.0)
            hit = plain & (square > 0.0) & (exit_ > entry)
            entries[m] = entry if hit else 0.0
            exits[m] = exit_ if hit else (0.0 if plain else -1.0)
            left += 0 if plain else 1
    return left


@inner
def other_quadrics(
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
    """Fill the slots of a quadric leaf pixel by pixel where :func:`ellipsoids` left an exit of -1.

    The leaf's first slot is ``slots - 1``. Returns how many there are then, or -1 for no room.
    """
    rays, ends, owners = held.rays, held.ends, held.owners
    entries, exits = held.entries, held.exits
    base = slots - 1
    for i in range(i0, i1):
        for j in range(j0, j1):
            p = i * columns + j
            if ends[2 * base + 1, p] >= 0.0:
                continue
            ends[2 * base + 1, p] = 0.0
            x = rays[0, 0] + i * rays[1, 0] + j * rays[2, 0] - scene.leaf_center[leaf, 0]
            y = rays[0, 1] + i * rays[1, 1] + j * rays[2, 1] - scene.leaf_center[leaf, 1]
            z = rays[0, 2] + i * rays[1, 2] + j * rays[2, 2] - scene.leaf_center[leaf, 2]
            dx = rays[3, 0] + i * rays[4, 0] + j * rays[5, 0]
            dy = rays[3, 1] + i * rays[4, 1] + j * rays[5, 1]
            dz = rays[3, 2] + i * rays[4, 2] + j * rays[5, 2]
            length = math.sqrt(dx * dx + dy * dy + dz * dz)
            dx, dy, dz = dx / length, dy / length, dz / length
            shift = -(x * dx + y * dy + z * dz)
            x, y, z = x + shift * dx, y + shift * dy, z + shift * dz
            count = quadric_leaf(
                scene,
                leaf,
                x,
                y,
                z,
                dx,
                dy,
                dz,
                -shift,
                length - shift,
                shift,
                whole(0),
                entries,
                exits,
                held.found,
            )
            for m in range(count):
                if base + m >= slots:
                    if slots >= len(owners):
                        return -1
                    clear(ends, slots)
                    owners[slots] = leaf
                    slots += 1
                ends[2 * (base + m), p] = entries[m] / length
                ends[2 * (base + m) + 1, p] = exits[m] / length
    return slots
