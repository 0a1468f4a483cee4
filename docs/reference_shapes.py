"""Draw X-rays of reference shapes as one contact sheet, docs/images/reference-shapes.png.

Run from the project's root: ``uv run python docs/reference_shapes.py``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

import phantom
from phantom.encode import png, write_atomically

SHEET = Path("docs/images/reference-shapes.png")
TILE = 200
GAP = 6
PER_ROW = 5

LINE = {"type": "line", "start": [0, 0, -50], "end": [0, 0, 50]}


def star(outer: float, inner: float, points: int = 5) -> list[list[float]]:
    """Corners of a star, a tip along n first."""
    radii = [outer if k % 2 == 0 else inner for k in range(2 * points)]
    angles = [math.pi * k / points for k in range(2 * points)]
    return [[r * math.cos(a), r * math.sin(a)] for r, a in zip(radii, angles, strict=True)]


def band(middle: list[tuple[float, float, float]], half: float) -> list[list[float]]:
    """Outline of a band of half-width ``half`` about points that tell which way is out."""
    outer = [[x + half * math.cos(a), y + half * math.sin(a)] for x, y, a in middle]
    inner = [[x - half * math.cos(a), y - half * math.sin(a)] for x, y, a in middle]
    return outer + inner[::-1]


def c_shape() -> list[list[float]]:
    angles = [math.radians(40 + 280 * k / 28) for k in range(29)]
    return band([(25 * math.cos(a), 25 * math.sin(a), a) for a in angles], 8)


def spiral() -> list[list[float]]:
    angles = [3.6 * math.pi * (k / 71) for k in range(72)]
    radii = [8 + 2.9 * a for a in angles]
    return band(
        [(r * math.cos(a), r * math.sin(a), a) for r, a in zip(radii, angles, strict=True)], 4
    )


SQUARE = {"type": "polygon", "points": [[22, 22], [-22, 22], [-22, -22], [22, -22]]}
SHAPES: dict[str, dict[str, Any]] = {
    "torus": {
        "axis": {
            "type": "arc",
            "center": [0, 0, 0],
            "normal": [0, 1, 0],
            "start": [35, 0, 0],
            "angle_deg": 360,
        },
        "contour": {"type": "circle", "radius": 14},
    },
    "twisted prism": {
        "axis": LINE,
        "contour": {**SQUARE, "corner_radius": 0},
        "sweep": {"type": "linear", "rotate_deg": {"knots": [[0, 0], [1, 135]]}},
    },
    "sharp star prism": {
        "axis": LINE,
        "contour": {"type": "polygon", "points": star(42, 17), "corner_radius": 0},
    },
    "helix tube": {
        "axis": {
            "type": "helix",
            "center": [0, 0, -42],
            "axis": [0, 0, 1],
            "start": [30, 0, -42],
            "pitch": 28,
            "turns": 3,
        },
        "contour": {"type": "circle", "radius": 8},
    },
    "C section": {
        "axis": LINE,
        "contour": {"type": "polygon", "points": c_shape(), "corner_radius": 0},
    },
    "kidney section": {
        "axis": LINE,
        "contour": {
            "type": "spline",
            "points": [
                *([-30, 14], [-10, 4], [10, 4], [30, 14], [38, -2], [28, -20]),
                *([0, -27], [-28, -20], [-38, -2]),
            ],
        },
    },
    "spiral section": {
        "axis": LINE,
        "contour": {"type": "polygon", "points": spiral(), "corner_radius": 0},
    },
    "morph": {
        "axis": LINE,
        "sweep": {
            "type": "morph",
            "contours": [
                {
                    "at": 0,
                    "contour": {"type": "polygon", "points": star(44, 22), "corner_radius": 2},
                },
                {"at": 0.5, "contour": {"type": "circle", "radius": 20}},
                {"at": 1, "contour": {**SQUARE, "corner_radius": 8}},
            ],
        },
    },
    "truncated ellipsoid": {
        "axis": LINE,
        "contour": {"type": "ellipse", "semi_axes": [40, 25]},
        "sweep": {"type": "linear", "scale": {"formula": "sqrt(1 - (1.8*u - 0.9)**2)"}},
    },
    "sheared and offset cylinder": {
        "axis": LINE,
        "contour": {"type": "circle", "radius": 18},
        "sweep": {
            "type": "linear",
            "shear": {"knots": [[0, -1], [1, 1]]},
            "offset": [{"formula": "22*sin(2*pi*u)"}, 0],
        },
    },
}
# Prisms stand with their ends toward the X-ray's source, a little turned, to show their section.
LEANING = {"sharp star prism", "C section", "kidney section", "spiral section"}


def document(name: str, shape: dict[str, Any]) -> dict[str, Any]:
    solid: dict[str, Any] = {**shape, "type": "generalized_cylinder", "material": "matter"}
    turns = [([1, 0, 0], 79), ([0, 0, 1], 8)] if name in LEANING else [([0, 0, 1], 25)]
    if name in ("torus", "truncated ellipsoid"):
        turns = [([0, 0, 1], 35)]
    for axis, angle in turns:
        rotate = {"axis": axis, "angle_deg": angle}
        solid = {"type": "transformed", "solid": solid, "rotate": rotate}
    return {
        "format": "phantom/1",
        "name": name.replace(" ", "-"),
        "materials": {"matter": {"attenuation_per_mm": 0.02}},
        "solid": solid,
    }


def tile(name: str) -> np.ndarray:
    """Return the X-ray of one shape, (TILE, TILE) grey levels."""
    loaded = phantom.load(document(name, SHAPES[name]))
    view = phantom.preset_view(loaded, "ap", columns=TILE, rows=TILE)
    return phantom.radiograph(loaded, view).presented("signal", None)


def sheet() -> np.ndarray:
    """Return all X-rays in rows, from left to right in the order of SHAPES."""
    rows = -(-len(SHAPES) // PER_ROW)
    height, width = (n * (TILE + GAP) + GAP for n in (rows, PER_ROW))
    whole = np.full((height, width), 255, dtype=np.uint8)
    for index, name in enumerate(SHAPES):
        top, left = (GAP + n * (TILE + GAP) for n in divmod(index, PER_ROW))
        whole[top : top + TILE, left : left + TILE] = tile(name)
    return whole


def main() -> None:
    title = "Reference shapes: " + ", ".join(SHAPES)
    write_atomically(SHEET, png(sheet(), {"description": title}))
    print(f"wrote {SHEET}")


if __name__ == "__main__":
    main()
