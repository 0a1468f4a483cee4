"""A wireframe as SVG 1.1: a group a leaf, a path a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

import numpy as np

if TYPE_CHECKING:
    from phantom.visible.drawing import Stroke


def svg(
    strokes: Sequence[Stroke],
    columns: int,
    rows: int,
    *,
    title: str,
    ink: str,
    paper: str,
    width: float,
) -> bytes:
    """Return strokes as a picture of lines, in units of pixels.

    A pixel's centre, at whole numbers in the strokes, lies half a unit from its corner here.
    """
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{columns}" height="{rows}" '
        f'viewBox="0 0 {columns} {rows}">',
        f"<title>{escape(title)}</title>",
        f'<rect width="{columns}" height="{rows}" fill="{paper}"/>',
        f'<g fill="none" stroke="{ink}" stroke-width="{width:g}" stroke-linecap="round" '
        'stroke-linejoin="round">',
    ]
    owner: str | None = None
    for stroke in strokes:
        if stroke.leaf != owner:
            if owner is not None:
                lines.append("</g>")
            owner = stroke.leaf
            lines.append(f"<g data-leaf={quoteattr(owner)}>")
        path = " ".join(_path(run) for run in stroke.runs)
        lines.append(f'<path class="{stroke.kind}" d="{path}"/>')
    if owner is not None:
        lines.append("</g>")
    return ("\n".join([*lines, "</g>", "</svg>"]) + "\n").encode()


def _path(run: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    points = " ".join(f"{x:.2f} {y:.2f}" for x, y in (run + 0.5).tolist())
    return f"M{points}"
