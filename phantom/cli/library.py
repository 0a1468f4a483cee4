"""``phantom list`` and ``phantom show``: what the library holds."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from phantom.cli.console import answer, reporting
from phantom.cli.options import Abnormalities, AsJson, Settings


def list_phantoms(as_json: AsJson = False) -> None:
    """List the phantoms of the library."""
    with reporting(as_json=as_json):
        from phantom import library

        lines = library.catalogue()
        if as_json:
            answer([line._asdict() for line in lines])
            return
        width = max((len(line.name) for line in lines), default=0)
        for line in lines:
            answer(f"{line.name:{width}}  {line.title}")


def show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A phantom of the library.")],
    document: Annotated[
        bool, typer.Option("--document", help="Print the phantom's document instead.")
    ] = False,
    settings: Settings = None,
    abnormality: Abnormalities = None,
    as_json: AsJson = False,
) -> None:
    """Show one phantom of the library: its parameters and views, or its document."""
    with reporting(as_json=as_json):
        from phantom import library
        from phantom.cli.options import subject

        entry = library.entry(name)
        if document:
            wanted: Any = subject(name, settings, abnormality)
            built = library.document(name, wanted["parameters"], wanted.get("abnormalities", ()))
            answer(built.model_dump(mode="json", exclude_none=True))
            return
        schema = entry.parameters.model_json_schema()
        if as_json:
            answer(
                {
                    "name": entry.name,
                    "title": entry.title,
                    "summary": entry.summary,
                    "views": list(entry.views),
                    "parameters": schema,
                    "abnormalities": {
                        kind: model.model_json_schema()
                        for kind, model in entry.abnormalities.items()
                    },
                }
            )
            return
        answer(f"{entry.name}: {entry.title}\n\n{entry.summary}\n\nviews: {' '.join(entry.views)}")
        for parameter, field in schema.get("properties", {}).items():
            answer(f"\n--set {parameter}={field.get('default')}\n    {_meaning(field)}")
        for kind, model in entry.abnormalities.items():
            answer(f"\n--abnormality {kind}\n    {model.__doc__}")
            for part, field in model.model_json_schema().get("properties", {}).items():
                if part not in ("type", "name"):
                    answer(f"    {part}={field.get('default', '')}: {_meaning(field)}")


def _meaning(field: dict[str, Any]) -> str:
    """Say in one line what a parameter is, and between what it lies."""
    bounds = field if "type" in field else next(iter(field.get("anyOf", [{}])))
    least, greatest = bounds.get("minimum"), bounds.get("maximum")
    said = str(field.get("description", ""))
    return said if least is None or greatest is None else f"{said} From {least:g} to {greatest:g}."
