"""``phantom validate``: every problem of a document, or what it amounts to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from phantom.cli.console import answer, reporting, say
from phantom.cli.options import AsJson, read_file

if TYPE_CHECKING:
    from phantom.requests.summary import DocumentSummary


def validate(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A document, JSON or YAML.")],
    as_json: AsJson = False,
) -> None:
    """Check a document: list every problem, or its leaves, bounds, volume and mass."""
    with reporting(as_json=as_json):
        from phantom.cli.engine import ready
        from phantom.document import parse
        from phantom.requests.summary import summarise
        from phantom.scene import load

        tree = read_file(file)
        phantom = load(tree if isinstance(tree, dict) else parse(tree))
        ready(quiet=as_json)
        summary = summarise(phantom)
        if as_json:
            answer(summary.model_dump(mode="json"))
        else:
            _print(summary)
            say(f"{file} is a sound document")


def _print(summary: DocumentSummary) -> None:
    """Print the summary for a person."""
    answer(f"{summary.name}: {summary.title}".rstrip(": "))
    (x0, y0, z0), (x1, y1, z1) = summary.bounds_mm
    answer(f"bounds  x {x0:.3f} to {x1:.3f}, y {y0:.3f} to {y1:.3f}, z {z0:.3f} to {z1:.3f} mm")
    answer(f"volume  {summary.volume_mm3:.6g} mm³ (± {summary.volume_relative_error:.1g} of it)")
    for warning in summary.warnings:
        answer(f"warning {warning}")
    if summary.mass_g is not None:
        answer(f"mass    {summary.mass_g:.6g} g")
    for material in summary.materials:
        mass = "no density" if material.mass_g is None else f"{material.mass_g:.6g} g"
        answer(f"material {material.name}: {material.volume_mm3:.6g} mm³, {mass}")
    for leaf in summary.leaves:
        answer(f"leaf {leaf.label}: {leaf.material or 'no material'}")
