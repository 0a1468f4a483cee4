"""The algebra of densities along spans: pixels of one row that meet the same solids in one order.

Neighbouring rays nearly always do. So the operators are evaluated once a span, and what they say
is a sum of the ends of intervals, each with a factor of +1 or -1, the same for all its pixels.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import Scene
from phantom.kernels.compiling import inner, lane_loop, whole
from phantom.kernels.csg import sort_events, surviving, toggle
from phantom.kernels.scratch import MOST, PROGRAMS, Scratch

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SPAN = 64
"""Pixels looked at together at most."""


@lane_loop
def mark(ends: Floats, slot: int, start: int, width: int, bit: int, masks: Ints) -> int:
    """Set a bit for every pixel of a row that meets the slot; return how many do."""
    met = 0
    entries = ends[2 * slot, start : start + width]
    exits = ends[2 * slot + 1, start : start + width]
    for j in range(width):
        hit = exits[j] > entries[j]
        masks[j] |= bit if hit else 0
        met += 1 if hit else 0
    return met


@lane_loop
def falls(ends: Floats, before: int, after: int, start: int, width: int, wrong: Ints) -> None:
    """Note the pixels at which one end does not lie before the other, by its number at a tie."""
    here, there = ends[before, start : start + width], ends[after, start : start + width]
    if before < after:
        for j in range(width):
            wrong[j] |= 1 if here[j] > there[j] else 0
    else:
        for j in range(width):
            wrong[j] |= 1 if here[j] >= there[j] else 0


@lane_loop
def add(ends: Floats, end: int, factor: float, start: int, width: int, sums: Floats) -> None:
    """Add a multiple of one end."""
    where = ends[end, start : start + width]
    for j in range(width):
        sums[j] += factor * where[j]


@lane_loop
def reach(rays: Floats, row: int, width: int, ways: Floats) -> None:
    """Write how long the way from source to pixel is along a row, in mm."""
    dx0 = rays[3, 0] + row * rays[4, 0]
    dy0 = rays[3, 1] + row * rays[4, 1]
    dz0 = rays[3, 2] + row * rays[4, 2]
    dxj, dyj, dzj = rays[5, 0], rays[5, 1], rays[5, 2]
    for j in range(width):
        dx, dy, dz = dx0 + j * dxj, dy0 + j * dyj, dz0 + j * dzj
        ways[j] = math.sqrt(dx * dx + dy * dy + dz * dz)


@lane_loop
def put(sums: Floats, ways: Floats, first: int, width: int, out: Floats) -> None:
    """Turn parts of the way into mm and clear the sums."""
    there = ways[first : first + width]
    for j in range(width):
        out[j] = max(sums[j], 0.0) * there[j]
        sums[j] = 0.0


@inner
def look(ends: Floats, slots: int, start: int, width: int, masks: Ints, met: Ints) -> int:
    """Note the slots that pixels may meet, and which of them each pixel does.

    Where a mask has a bit for every slot these are all of them, else those that some pixels meet.
    Returns how many there are, or -1 where a mask has no bit left; one pixel needs no mask.
    """
    for j in range(width):
        masks[j] = 0
    if slots <= MOST:
        for slot in range(slots):
            mark(ends, slot, start, width, 1 << slot, masks)
            met[slot] = slot
        return slots
    count = whole(0)
    for slot in range(slots):
        if mark(ends, slot, start, width, 1 << min(count, MOST), masks) > 0:
            met[count] = slot
            count += 1
            if count > MOST and width > 1:
                return -1
    return count


@inner
def leading(ends: Floats, order: Ints, number: int, start: int, width: int, wrong: Ints) -> int:
    """Return how many pixels, from the first on, meet the ends in this order."""
    for m in range(width):
        wrong[m] = 0
    for e in range(number - 1):
        falls(ends, order[e], order[e + 1], start, width, wrong)
    alike = whole(0)
    while alike < width and wrong[alike] == 0:
        alike += 1
    return alike


@inner
def combine(
    scene: Scene,
    held: Scratch,
    slots: int,
    rows: int,
    columns: int,
    to_row: int,
    to_column: int,
    out: Floats,
) -> None:
    """Fill a tile of ``out`` (M, ., .), which begins at a row and a column there, from its slots.

    A row is looked at whole; where its pixels meet more slots than a mask has bits, half of it,
    and so on down to one pixel. What the operators made of the last few sets of slots is kept: the
    next row mostly meets the same ones in the same order. What a pixel gets depends on nothing but
    its own ends. One long function: handing a scene to another costs more than most spans do.
    """
    masks, met = held.masks, held.met
    ends, owners, events = held.ends, held.owners, held.events
    wrong, sums = held.wrong, held.sums
    known, sizes, orders, sets = held.known, held.sizes, held.orders, held.factors
    present, nodes, kept = held.present, held.nodes, held.kept
    leaves = len(scene.leaf_radius)
    root = len(scene.parent) - 1
    channels = out.shape[0]
    # Bits have one meaning in all rows only where there is one for every slot.
    steady = slots <= MOST
    for p in range(PROGRAMS):
        known[p] = 0
    newest = whole(0)
    for i in range(rows):
        reach(held.rays, i, columns, held.ways)
        first = 0
        while first < columns:
            last = columns
            count = look(ends, slots, i * columns + first, last - first, masks, met)
            while count < 0:
                last = first + (last - first + 1) // 2
                count = look(ends, slots, i * columns + first, last - first, masks, met)
            alone = last - first == 1
            j = first
            while j < last:
                mask = masks[j - first]
                end = j + 1
                limit = min(last, j + SPAN)
                while end < limit and masks[end - first] == mask:
                    end += 1
                if mask == 0:
                    j = end
                    continue
                start, width = i * columns + j, end - j
                p, alike = whole(PROGRAMS), whole(0)
                if steady:
                    p = whole(0)
                    while p < PROGRAMS and known[p] != mask:
                        p += 1
                    if p < PROGRAMS:
                        alike = leading(ends, orders[p], sizes[p], start, width, wrong)
                if alike == 0:
                    if p == PROGRAMS:
                        newest = (newest + 1) % PROGRAMS
                        p = newest
                    known[p] = mask if steady else 0
                    number = whole(0)
                    for bit in range(count):
                        if alone or mask >> bit & 1:
                            kept[number] = 2 * met[bit]
                            kept[number + 1] = 2 * met[bit] + 1
                            number += 2
                    order, factors = orders[p], sets[p]
                    sizes[p] = number
                    for e in range(number):
                        order[e] = e
                        events[e] = ends[kept[e], start]
                    sort_events(events, order, number)
                    for e in range(number):
                        order[e] = kept[order[e]]
                    alike = leading(ends, order, number, start, width, wrong)
                    for channel in range(channels):
                        for e in range(number):
                            factors[channel, e] = 0.0
                    for e in range(number):
                        toggle(
                            owners[order[e] // 2],
                            present,
                            scene.parent,
                            scene.operator,
                            scene.left,
                            scene.right,
                        )
                        if e == number - 1:
                            break
                        for m in range(
                            surviving(
                                root,
                                leaves,
                                present,
                                scene.operator,
                                scene.left,
                                scene.right,
                                nodes,
                                kept,
                            )
                        ):
                            channel = scene.leaf_material[kept[m]]
                            if channel >= 0:
                                factors[channel, e] -= 1.0
                                factors[channel, e + 1] += 1.0
                order, factors = orders[p], sets[p]
                for channel in range(channels):
                    used = False
                    for e in range(sizes[p]):
                        if factors[channel, e] != 0.0:
                            add(ends, order[e], factors[channel, e], start, alike, sums)
                            used = True
                    if used:
                        to = out[channel, to_row + i, to_column + j : to_column + j + alike]
                        put(sums, held.ways, j, alike, to)
                j += alike
            first = last
