"""``phantom stereo``: X-ray a phantom for two eyes and write the pictures."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Final

import typer

from phantom.cli.console import reporting
from phantom.cli.exposure import EXPOSURE, Word, worded
from phantom.cli.options import Abnormalities, AsJson, Settings, Target, subject
from phantom.cli.pairs import EYES, make_pair
from phantom.cli.radiograph import asked

STEREO: Final[Mapping[str, Word]] = {
    **EXPOSURE,
    "scope": Word("What the greys depend on.", "image|pair|fixed"),
    **EYES,
    "dose": Word("For both images together, or for each.", "split|per_image"),
}


@worded(STEREO)
def make(
    target: Target,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Where to: as for radiograph, or .zip; two files get -left and -right.",
            metavar="FILE",
        ),
    ] = None,
    words: Mapping[str, str] = MappingProxyType({}),
    truth_output: Annotated[
        str | None,
        typer.Option(
            "--truth-output", help="Where the ground truth goes to.", metavar="DIR|FILE.zip"
        ),
    ] = None,
    sidecar: Annotated[
        bool, typer.Option("--sidecar", help="Write what is known of the pair beside it, as .json.")
    ] = False,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """X-ray a phantom for the left and the right eye, and write the pictures."""
    with reporting(as_json=as_json):
        from phantom.requests.stereo import plan_pair
        from phantom.requests.words import STEREO_WORDS, request_tree

        given = asked(words, truth_output)
        tree = subject(target, settings, abnormality)
        planned = plan_pair(*request_tree(tree, given.items(), STEREO_WORDS))
        pose = planned.chosen.get("view", "view")
        make_pair(
            planned,
            given,
            Path(output or f"{planned.name}-{pose}-stereo.png"),
            told_path=output is not None,
            truth_output=truth_output,
            sidecar=sidecar,
            as_json=as_json,
        )
