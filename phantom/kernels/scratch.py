"""What a thread needs beside it to trace tiles: made once, used for one tile after another."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from phantom.compiled.layout import CELLS, Scene
from phantom.kernels.jets import FANS
from phantom.kernels.lanes import LANES, ROWS, STRIDE, TILE_COLUMNS
from phantom.kernels.verdicts import BLOCKS, SIZES

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST = 62
"""Slots that pixels looked at together may meet: the bits of a mask."""

PROGRAMS = 16
"""Sets of slots of which is kept what the operators make of them."""

_RECORDS = 128 * LANES


class Scratch(NamedTuple):
    """Arrays whose content means nothing between two tiles."""

    lanes: Floats  # (ROWS * STRIDE,)
    rays: Floats  # (6, 3) of the tile
    middle: Floats  # (3,) origin of a segment
    knots: Floats  # (n, 6) section planes along the rays
    fans: Floats  # (FANS,) a segment's polynomials along the rays
    slabs: Floats  # (3, 7) sides of a segment's box along the rays, half its width
    beam: Floats  # (10,) one ray in a segment's cells; a plane along the rays
    cells: Floats  # (CELLS, CELLS, 2) of one segment, along the rays of a tile
    blocks: Floats  # (SIZES * SIZES * BLOCKS,) of those
    pixels: Ints  # (records,) where rays enter or leave a leaf
    where: Floats  # (records,) part of the way from source to pixel
    signs: Floats  # (records,) 1 in, -1 out
    waiting: Floats  # (2, LANES) where a record is held back
    senses: Floats  # (2, LANES) its sign, 0 for none
    first: Floats  # (LANES,)
    last: Floats  # (LANES,)
    total: Floats  # (LANES,)
    book: Ints  # (3, LANES)
    ends: Floats  # (2 slots, LANES)
    owners: Ints  # (slots,) leaf
    masks: Ints  # (TILE_COLUMNS,) which slots a pixel meets
    wrong: Ints  # (TILE_COLUMNS,) where a span ends
    met: Ints  # (slots,) those that some pixels meet
    events: Floats  # (2 slots,)
    known: Ints  # (PROGRAMS,) slots that the operators were evaluated for, as masks
    sizes: Ints  # (PROGRAMS,) ends of those
    orders: Ints  # (PROGRAMS, 2 slots) the ends, in the order in which they are met
    factors: Floats  # (PROGRAMS, M, 2 slots) what each end counts for
    sums: Floats  # (TILE_COLUMNS,)
    ways: Floats  # (TILE_COLUMNS,) from source to pixel, in mm
    present: NDArray[np.uint8]  # (nodes,)
    nodes: Ints
    kept: Ints
    entries: Floats  # (8,) of one ray and one quadric
    exits: Floats  # (8,)
    found: Ints  # (8,)


def scratch(scene: Scene, channels: int, slots: int) -> Scratch:
    """Make what one thread needs for tiles of a scene with as many slots at most."""
    segments = int(np.diff(scene.first_segment).max(initial=0))
    number = 2 * slots
    ints = np.int64
    return Scratch(
        lanes=np.zeros(ROWS * STRIDE),
        rays=np.empty((6, 3)),
        middle=np.empty(3),
        knots=np.empty((segments + 1, 6)),
        fans=np.empty(FANS),
        slabs=np.empty((3, 7)),
        beam=np.empty(10),
        cells=np.empty((CELLS, CELLS, 2)),
        blocks=np.empty(SIZES * SIZES * BLOCKS),
        pixels=np.empty(_RECORDS, dtype=ints),
        where=np.empty(_RECORDS),
        signs=np.empty(_RECORDS),
        waiting=np.empty((2, LANES)),
        senses=np.zeros((2, LANES)),
        first=np.empty(LANES),
        last=np.empty(LANES),
        total=np.empty(LANES),
        book=np.empty((3, LANES), dtype=ints),
        ends=np.empty((2 * slots, LANES)),
        owners=np.empty(slots, dtype=ints),
        masks=np.empty(TILE_COLUMNS, dtype=ints),
        wrong=np.empty(TILE_COLUMNS, dtype=ints),
        met=np.empty(slots, dtype=ints),
        events=np.empty(number),
        known=np.empty(PROGRAMS, dtype=ints),
        sizes=np.empty(PROGRAMS, dtype=ints),
        orders=np.empty((PROGRAMS, number), dtype=ints),
        factors=np.empty((PROGRAMS, channels, number)),
        sums=np.zeros(TILE_COLUMNS),
        ways=np.empty(TILE_COLUMNS),
        present=np.zeros(len(scene.parent), dtype=np.uint8),
        nodes=np.empty(len(scene.parent) + number, dtype=ints),
        kept=np.empty(len(scene.leaf_radius) + number, dtype=ints),
        entries=np.empty(8),
        exits=np.empty(8),
        found=np.empty(8, dtype=ints),
    )
