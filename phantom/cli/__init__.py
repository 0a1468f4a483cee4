"""The command line: the words of the HTTP service, for a terminal.

Nothing of the engine is imported before a command runs, so that ``phantom --help`` is instant.
"""

from __future__ import annotations

import gc

import typer

from phantom.cli import (
    dataset,
    documents,
    export,
    library,
    preview,
    radiograph,
    render,
    render_pair,
    serve,
    stereo,
    wireframe,
)

app = typer.Typer(
    name="phantom",
    help="Exact X-ray images of phantoms: documents in, radiographs out.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command("list")(library.list_phantoms)
app.command("show")(library.show)
app.command("validate")(documents.validate)
app.command("radiograph")(radiograph.make)
app.command("stereo")(stereo.make)
app.command("render")(render.make)
app.command("render-pair")(render_pair.make)
app.command("preview")(preview.make)
app.command("wireframe")(wireframe.make)
app.command("export")(export.make)
app.add_typer(dataset.app, name="dataset")
app.command("serve")(serve.serve)


def main() -> None:
    """Run the command line; the console script ``phantom``."""
    # Loading modules makes hardly any garbage: look for it less often.
    gc.set_threshold(100_000)
    app()


__all__ = ["app", "main"]
