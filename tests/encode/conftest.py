"""A PNG reader of its own: the standard library's zlib and the rules of the PNG specification."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray


@dataclass(frozen=True)
class Png:
    pixels: NDArray[np.generic]
    text: dict[str, str]
    chunks: tuple[bytes, ...]


def _unfilter(kind: int, line: bytearray, above: bytes, step: int) -> None:
    for i in range(len(line)):
        left = line[i - step] if i >= step else 0
        up = above[i]
        corner = above[i - step] if i >= step else 0
        if kind == 1:
            line[i] = (line[i] + left) % 256
        elif kind == 2:
            line[i] = (line[i] + up) % 256
        elif kind == 3:
            line[i] = (line[i] + (left + up) // 2) % 256
        elif kind == 4:
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda v: abs(guess - v))
            line[i] = (line[i] + nearest) % 256


def _read(data: bytes) -> Png:
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    position, chunks = 8, []
    while position < len(data):
        (length,) = struct.unpack(">I", data[position : position + 4])
        kind, body = data[position + 4 : position + 8], data[position + 8 : position + 8 + length]
        (checksum,) = struct.unpack(">I", data[position + 8 + length : position + 12 + length])
        assert zlib.crc32(kind + body) == checksum
        chunks.append((kind, body))
        position += 12 + length
    assert chunks[-1] == (b"IEND", b"")
    width, height, bits, colour, *rest = struct.unpack(">IIBBBBB", chunks[0][1])
    assert (colour, *rest) == (0, 0, 0, 0), "grey, deflate, adaptive filters, not interlaced"
    step = bits // 8
    raw = zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT"))
    assert len(raw) == height * (1 + width * step)
    above, lines = bytes(width * step), []
    for row in range(height):
        start = row * (1 + width * step)
        line = bytearray(raw[start + 1 : start + 1 + width * step])
        _unfilter(raw[start], line, above, step)
        above = bytes(line)
        lines.append(above)
    pixels = np.frombuffer(b"".join(lines), dtype=">u2" if bits == 16 else np.uint8)
    pairs = (body.split(b"\0", 1) for kind, body in chunks if kind == b"tEXt")
    text = {key.decode("latin-1"): value.decode("latin-1") for key, value in pairs}
    return Png(pixels.reshape(height, width), text, tuple(kind for kind, _ in chunks))


@pytest.fixture
def read_png() -> Callable[[bytes], Png]:
    return _read
