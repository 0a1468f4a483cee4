"""``phantom preview``: look at a tessellated phantom, fast and coarse, and write the picture."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Final

import typer

from phantom.cli.drawing import draw
from phantom.cli.exposure import Word, worded
from phantom.cli.options import Abnormalities, AsJson, Settings, Target
from phantom.cli.render import RENDER

PREVIEW: Final[Mapping[str, Word]] = {
    **{name: word for name, word in RENDER.items() if name != "shadows"},
    "tolerance_mm": Word("How far a triangle may lie from the surface.", "MM"),
}
"""What a preview is asked for with."""


@worded(PREVIEW)
def make(
    target: Target,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: .png .jpg .tif .f32.tif .exr .npy .json",
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
    """Look at a phantom made of triangles: a quick picture to check a model by."""
    draw(
        "preview",
        target,
        output,
        words,
        sidecar=sidecar,
        settings=settings,
        abnormality=abnormality,
        as_json=as_json,
    )
