"""The contact sheet: small pictures of some of a set's images, under one range of greys."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from phantom.datasets.design import Design
from phantom.encode import png

if TYPE_CHECKING:
    from phantom.imaging import Radiograph

FloatArray = NDArray[np.float64]

SHOWN: Final = 36
ACROSS: Final = 6
SIDE: Final = 160
"""Pixels of the longer side of a small picture."""

CAPTION: Final = 14
GAP: Final = 6
CODES_PER_UNIT: Final = 4096
"""Small pictures are kept as line integrals in 16 bits."""

PERCENTILES: Final = (1.0, 99.7)
"""Of all small pictures together; what lies between spans the greys."""

_DOTS: Final = (
    "75557 26227 71747 71717 55711 74717 74757 71111"
    " 75757 75717 25755 65656 74447 65556 74647 74644"
)
_GLYPHS: Final = dict(zip("0123456789abcdef", _DOTS.split(), strict=True))
"""Five rows of three dots for each digit, a row an octal number."""


class Tile(NamedTuple):
    """A small picture, what stands under it, and whether it has a frame."""

    thumbnail: str
    caption: str
    framed: bool


def shown(design: Design) -> frozenset[int]:
    """Return which images are shown: the same distance apart, from the first to the last."""
    count = min(SHOWN, design.images)
    steps = max(count - 1, 1)
    return frozenset(round(k * (design.images - 1) / steps) for k in range(count))


def thumbnail(made: Radiograph, quantity: str) -> str:
    """Return a small picture as text: means over squares of pixels, as line integrals."""
    values = made.quantity(quantity)
    step = max(1, -(-max(values.shape) // SIDE))
    rows, columns = (n // step * step for n in values.shape)
    parts = values[:rows, :columns].reshape(rows // step, step, columns // step, step)
    means = parts.mean(axis=(1, 3))
    if quantity != "line_integral":
        full = made.open_field if quantity == "signal" else 1.0
        means = -np.log(np.clip(means / full, 1e-6, None))
    codes = np.clip(np.rint(means * CODES_PER_UNIT), 0, 65_535).astype("<u2")
    packed = codes.tobytes()
    return f"{codes.shape[0]}x{codes.shape[1]}:{base64.b64encode(packed).decode()}"


def _unpacked(small: str) -> FloatArray:
    shape, _, packed = small.partition(":")
    rows, columns = map(int, shape.split("x"))
    codes = np.frombuffer(base64.b64decode(packed), dtype="<u2").reshape(rows, columns)
    return codes.astype(np.float64) / CODES_PER_UNIT


def sheet(tiles: Sequence[Tile]) -> bytes:
    """Return a PNG of the small pictures, row by row, bones white."""
    pictures = [_unpacked(tile.thumbnail) for tile in tiles]
    values = np.concatenate([picture.ravel() for picture in pictures])
    low, high = np.percentile(values, PERCENTILES)
    scale = 255.0 / max(float(high - low), 1e-9)
    height, width = (max(p.shape[axis] for p in pictures) for axis in (0, 1))
    pitch = (height + CAPTION + GAP, width + GAP)
    across = min(ACROSS, len(tiles))
    down = -(-len(tiles) // across)
    grey = np.zeros((down * pitch[0] + GAP, across * pitch[1] + GAP), dtype=np.uint8)
    for number, (tile, picture) in enumerate(zip(tiles, pictures, strict=True)):
        top, left = (GAP + (number // across, number % across)[k] * pitch[k] for k in (0, 1))
        rows, columns = picture.shape
        if tile.framed:
            grey[top - 2 : top + rows + 2, left - 2 : left + columns + 2] = 255
        levels = np.rint(np.clip((picture - low) * scale, 0.0, 255.0))
        grey[top : top + rows, left : left + columns] = levels.astype(np.uint8)
        words = _written(tile.caption)[:, :width]
        top += height + 4
        grey[top : top + words.shape[0], left : left + words.shape[1]] = words
    return png(grey, {})


def _written(caption: str) -> NDArray[np.uint8]:
    """Return digits as dots of two pixels, 190 on 0."""
    letters = []
    for letter in caption:
        rows = [[int(row) >> bit & 1 for bit in (2, 1, 0)] for row in _GLYPHS[letter]]
        letters += [np.array(rows, dtype=np.uint8), np.zeros((5, 1), dtype=np.uint8)]
    dots: Any = np.concatenate(letters, axis=1) * np.uint8(190)
    whole: NDArray[np.uint8] = np.repeat(np.repeat(dots, 2, axis=0), 2, axis=1)
    return whole
