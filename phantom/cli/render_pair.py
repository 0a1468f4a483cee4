"""``phantom render-pair``: look at a phantom in visible light with two eyes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated

import typer

from phantom.cli.console import reporting
from phantom.cli.exposure import worded
from phantom.cli.options import Abnormalities, AsJson, Settings, Target, json_text, subject
from phantom.cli.pairs import EYES, make_pair
from phantom.cli.render import RENDER


@worded({**RENDER, **EYES})
def make(
    target: Target,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: as for render, or .zip; two files get -left and -right.",
            metavar="FILE",
        ),
    ] = None,
    words: Mapping[str, str] = MappingProxyType({}),
    sidecar: Annotated[
        bool, typer.Option("--sidecar", help="Write what is known of the pair beside it, as .json.")
    ] = False,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """Look at a phantom with the left and the right eye, and write the pictures."""
    with reporting(as_json=as_json):
        from phantom.requests.render_pair import plan_render_pair
        from phantom.requests.words import RENDER_PAIR_WORDS, request_tree

        given = dict(words)
        if "lighting" in given:
            given["lighting"] = json_text(given["lighting"], "/lighting")
        tree = subject(target, settings, abnormality)
        planned = plan_render_pair(*request_tree(tree, given.items(), RENDER_PAIR_WORDS))
        side = planned.chosen.get("view", "view")
        make_pair(
            planned,
            given,
            Path(output or f"{planned.name}-{side}-pair.png"),
            told_path=output is not None,
            sidecar=sidecar,
            as_json=as_json,
        )
