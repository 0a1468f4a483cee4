"""``phantom render``: look at a phantom in visible light and write the picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Final

import typer

from phantom.cli.console import Bar, answer, reporting, say
from phantom.cli.exposure import Word, worded
from phantom.cli.options import Abnormalities, AsJson, Settings, Target, json_text, subject
from phantom.cli.radiograph import tell_defaults

RENDER: Final[Mapping[str, Word]] = {
    "view": Word("Side that is looked at, or a camera in JSON.", "VIEW"),
    "azimuth_deg": Word("Of the eye, from the front to the patient's left.", "DEG"),
    "elevation_deg": Word("Of the eye, toward the head.", "DEG"),
    "parallel": Word("Parallel lines of sight.", None),
    "field_of_view_deg": Word("Across the picture's width.", "DEG"),
    "zoom": Word("How much larger than fitted.", "X"),
    "columns": Word("Pixels in a row.", "N"),
    "rows": Word("Pixels in a column.", "N"),
    "hide": Word("Materials and leaves to look through.", "NAME,…"),
    "samples_per_pixel": Word("Rays along each side of a pixel.", "N"),
    "lighting": Word("Ambient light and lights.", "FILE|JSON"),
    "shadows": Word("Solids keep the lights from one another.", None),
    "background": Word("Behind the phantom.", "black|white|R,G,B"),
    "mode": Word("How light becomes levels.", "srgb|stretch"),
    "bits": Word("Of a level.", "8|16"),
}
"""What a picture is asked for with, in the order of :data:`phantom.requests.words.RENDER_WORDS`."""


@worded(RENDER)
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
    """Look at a phantom of the library, or a document, in visible light, and write the picture."""
    with reporting(as_json=as_json):
        from phantom.cli.engine import ready
        from phantom.encode import format_of_path, save
        from phantom.encode.content import COLOR
        from phantom.requests.render import plan_render
        from phantom.requests.words import RENDER_WORDS, request_tree

        given = dict(words)
        if "lighting" in given:
            given["lighting"] = json_text(given["lighting"], "/lighting")
        tree = subject(target, settings, abnormality)
        planned = plan_render(*request_tree(tree, given.items(), RENDER_WORDS))
        side = planned.chosen.get("view", "view")
        path = Path(output or f"{planned.phantom.document.name}-{side}-render.png")
        planned.check_format(format_of_path(path))
        tell_defaults(planned.chosen, given, None if output else path)
        ready(quiet=as_json, light=True)
        with Bar("tracing") as bar:
            made = planned.render(progress=bar)
        saved = save(made, path, COLOR, planned.request.tone, sidecar=sidecar)
        say(f"wrote {path}")
        for warning in made.told["warnings"]:
            say(f"warning: {warning}")
        if as_json:
            answer({"output": str(path), **saved.beside})
