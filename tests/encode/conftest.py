"""A result to be written, and a PNG reader of its own: the standard library's zlib and the rules of
the PNG specification."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

NAMES = ("bone, cortical", "Knochen-α")
SOURCE = [0.0, -1000.0, 0.0]


@dataclass
class Shot:
    """A picture of made-up numbers, (rows, columns) = (21, 34), with a known pose."""

    region: str | None = "knee"
    laterality: str | None = "left"
    codes: dict[str, Any] = field(default_factory=dict)
    view: dict[str, Any] = field(
        default_factory=lambda: {
            "source": SOURCE,
            "direction": None,
            "detector": {
                "center": [0.0, 150.0, 0.0],
                "right": [1.0, 0.0, 0.0],
                "down": [0.0, 0.0, -1.0],
                "columns": 34,
                "rows": 21,
                "pitch_mm": [0.2, 0.3],
            },
        }
    )
    beam: dict[str, Any] = field(default_factory=lambda: {"energy_kev": 60.0})
    seed: int = 5
    thickness: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        self.thickness = np.random.default_rng(self.seed).uniform(0, 90, (21, 34, 2))

    def quantity(self, name: str) -> Any:
        line_integral = self.thickness @ [0.05, 0.02]
        return {
            "path_lengths": self.thickness,
            "line_integral": line_integral,
            "transmission": np.exp(-line_integral),
            "signal": np.exp(-line_integral) * 0.9,
        }[name]

    def presented(self, name: str, presentation: int | None) -> Any:
        """Stretch, to 8 bits or as many as asked; bones are white, or dark for negative bits."""
        bits = presentation or 8
        values = self.quantity(name) * (1 if (name == "line_integral") == (bits > 0) else -1)
        levels = (values - values.min()) / (values.max() - values.min()) * (2 ** abs(bits) - 1)
        return np.rint(levels).astype(np.uint8 if abs(bits) == 8 else np.uint16)

    def shown(self, name: str, presentation: int | None) -> dict[str, Any]:
        return {"bits": presentation or 8}

    def metadata(self) -> dict[str, Any]:
        return {
            "software": {"name": "phantom-xray", "version": "1.2.3"},
            "phantom": {
                "name": "genou-α",
                "title": "",
                "document_sha256": "5ec2e7" * 10,
                "material_names": list(NAMES),
                "anatomy": {
                    "region": self.region,
                    "laterality": self.laterality,
                    "codes": self.codes,
                },
            },
            "units": {"line_integral": "1", "transmission": "1", "signal": "1"},
            "view": self.view,
            "beam": self.beam,
            "pitch_mm": self.view["detector"]["pitch_mm"],
            "magnification": 1.15,
            "seed": 77_001,
        }


@pytest.fixture
def shot() -> type[Shot]:
    return Shot


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
    assert rest == [0, 0, 0], "deflate, adaptive filters, not interlaced"
    channels = {0: 1, 2: 3}[colour]  # grey, or red, green and blue
    step = bits // 8 * channels
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
    shape = (height, width) if channels == 1 else (height, width, channels)
    return Png(pixels.reshape(shape), text, tuple(kind for kind, _ in chunks))


@pytest.fixture
def read_png() -> Callable[[bytes], Png]:
    return _read
