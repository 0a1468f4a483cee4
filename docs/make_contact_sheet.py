"""Makes the contact sheets of the library: every phantom in its standard views, as it comes.

uv run python docs/make_contact_sheet.py            all of them
uv run python docs/make_contact_sheet.py knee hand  the sheets of these
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from phantom import library
from phantom.requests.radiograph import plan

SHEETS = {
    "anatomy": ("knee", "hand", "chest", "breast", "stomach-and-liver"),
    "test-objects": (
        "step-wedge",
        "contrast-detail",
        "line-pairs",
        "slanted-edge",
        "low-contrast-spheres",
        "beads",
        "stereo-targets",
        "shepp-logan-3d",
        "sphere",
    ),
    "studies": ("breast-of-spheres", "knee-1993", "fan", "deformed"),
}
POSES: dict[tuple[str, str], dict[str, object]] = {
    ("breast", "mlo"): {"compression": "mlo"},
    ("chest", "left_lateral"): {"arms": "raised"},
}
SIDE, CAPTION, COLUMNS, RENDERED = 320, 18, 4, 960
IMAGES = Path(__file__).parent / "images"


def picture(name: str, view: str) -> Image.Image:
    """Return a phantom in a view, in the pose for it, made small."""
    parameters = POSES.get((name, view), {})
    request = {"phantom": {"name": name, "parameters": parameters}, "view": {"preset": view}}
    return framed(request, f"{name}   {view}")


def framed(request: dict[str, object], caption: str) -> Image.Image:
    """Return the radiograph that a request asks for, made small, over its caption."""
    planned = plan({"detector": {"columns": RENDERED}, **request})
    grey = planned.render().presented("signal", planned.presentation)
    small = Image.fromarray(np.asarray(grey)).resize((SIDE, SIDE), Image.Resampling.LANCZOS)
    frame = Image.new("L", (SIDE + 4, SIDE + CAPTION + 4), 48)
    frame.paste(small, (2, 2))
    ImageDraw.Draw(frame).text((6, SIDE + 5), caption, fill=230)
    return frame


def side_by_side(pictures: list[Image.Image]) -> Image.Image:
    """Return pictures of one size in rows of a few."""
    wide, high = pictures[0].size
    columns = min(COLUMNS, len(pictures))
    rows = -(-len(pictures) // columns)
    whole = Image.new("L", (columns * wide, rows * high), 48)
    for index, one in enumerate(pictures):
        whole.paste(one, (index % columns * wide, index // columns * high))
    return whole


def sheet(names: tuple[str, ...]) -> Image.Image:
    """Return the pictures of these phantoms side by side."""
    return side_by_side([picture(name, v) for name in names for v in library.entry(name).views])


if __name__ == "__main__":
    for title, names in SHEETS.items():
        if len(sys.argv) == 1 or set(sys.argv[1:]) & set(names):
            known = tuple(name for name in names if name in library.names())
            sheet(known).save(IMAGES / f"phantoms-{title}.png", optimize=True)
