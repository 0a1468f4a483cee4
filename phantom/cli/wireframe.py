"""``phantom wireframe``: draw the (u, v) net of a phantom."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Final

import typer

from phantom.cli.drawing import draw
from phantom.cli.exposure import Word, worded
from phantom.cli.options import Abnormalities, AsJson, Settings, Target
from phantom.cli.render import RENDER

_LIGHT = ("lighting", "shadows", "samples_per_pixel")

WIREFRAME: Final[Mapping[str, Word]] = {
    **{name: word for name, word in RENDER.items() if name not in _LIGHT},
    "rings": Word("Sections of each leaf.", "N"),
    "lines": Word("Lines along each leaf.", "N"),
    "hidden_lines": Word("Draw what lies behind a surface, too.", None),
    "line_width_px": Word("Of the lines, in pixels.", "X"),
}
"""What a wireframe is asked for with."""


@worded(WIREFRAME)
def make(
    target: Target,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: .svg .png .jpg .tif .f32.tif .exr .npy .json",
            metavar="FILE",
        ),
    ] = None,
    words: Mapping[str, str] = MappingProxyType({}),
    sidecar: Annotated[
        bool, typer.Option("--sidecar", help="Write the metadata beside it, as .json.")
    ] = False,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """Draw the net of a phantom's leaves: sections, and lines along them."""
    draw(
        "wireframe",
        target,
        output,
        words,
        sidecar=sidecar,
        settings=settings,
        abnormality=abnormality,
        as_json=as_json,
    )
