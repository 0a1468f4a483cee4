"""``phantom export``: write a phantom for other programs, as a mesh or as a volume of labels."""

from __future__ import annotations

from typing import Annotated

import typer

from phantom.cli.console import Bar, answer, reporting, say
from phantom.cli.options import Abnormalities, AsJson, Settings, Target, subject
from phantom.cli.radiograph import tell_defaults


def make(
    target: Target,
    output: Annotated[
        str,
        typer.Option(
            "-o",
            "--output",
            help="Where to: .stl .stl.zip .obj .glb, or .nii .nii.gz .mha",
            metavar="FILE",
        ),
    ],
    what: Annotated[
        str | None,
        typer.Option("--what", help="What of a mesh.", metavar="leaves|parts|result"),
    ] = None,
    tolerance_mm: Annotated[
        str | None,
        typer.Option(
            "--tolerance-mm", help="How far a triangle may lie from the surface.", metavar="MM"
        ),
    ] = None,
    spacing_mm: Annotated[
        str | None,
        typer.Option("--spacing-mm", help="Of a volume's voxels.", metavar="MM|[MM,MM,MM]"),
    ] = None,
    energy_kev: Annotated[
        str | None,
        typer.Option(
            "--energy-kev", help="Photon energy of the attenuations in the table.", metavar="KEV"
        ),
    ] = None,
    table: Annotated[
        str | None,
        typer.Option(
            "--table",
            help="Where the table of materials goes to, .json or .csv; else beside the file.",
            metavar="FILE",
        ),
    ] = None,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """Write a phantom as meshes or as a volume of labels, with a table of its materials."""
    options = {
        "what": what,
        "tolerance_mm": tolerance_mm,
        "spacing_mm": spacing_mm,
        "energy_kev": energy_kev,
    }
    with reporting(as_json=as_json):
        from phantom.cli.engine import ready
        from phantom.export.files import is_volume
        from phantom.requests.export import EXPORT_WORDS, plan_export
        from phantom.requests.words import request_tree

        given = {word: text for word, text in options.items() if text is not None}
        tree = subject(target, settings, abnormality)
        planned = plan_export(
            *request_tree(tree, given.items(), EXPORT_WORDS), output=output, table=table
        )
        tell_defaults(planned.chosen, given, None)
        if is_volume(output):  # meshes are made without a kernel
            ready(quiet=as_json)
        with Bar("sampling" if is_volume(output) else "tessellating") as bar:
            made = planned.write(progress=bar)
        say(f"wrote {made.output} and {made.table}")
        if as_json:
            answer({"output": str(made.output), "table": str(made.table), **made.told})
