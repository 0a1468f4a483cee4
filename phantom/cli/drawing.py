"""What the commands for previews and wireframes share."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from phantom.cli.console import Bar, answer, reporting, say
from phantom.cli.options import json_text, subject
from phantom.cli.radiograph import tell_defaults


def draw(
    style: str,
    target: str,
    output: str | None,
    words: Mapping[str, str],
    *,
    sidecar: bool,
    settings: list[str] | None,
    abnormality: list[str] | None,
    as_json: bool,
) -> None:
    """Make a picture of a style as a command asks for it, write it and say so."""
    with reporting(as_json=as_json):
        from phantom.cli.engine import ready
        from phantom.encode import format_of_path, save
        from phantom.requests.draw import DRAW_WORDS, plan_draw, quantity_of
        from phantom.requests.words import request_tree

        given = {"style": style, **words}
        if "lighting" in given:
            given["lighting"] = json_text(given["lighting"], "/lighting")
        tree = subject(target, settings, abnormality)
        planned = plan_draw(*request_tree(tree, given.items(), DRAW_WORDS))
        side = planned.chosen.get("view", "view")
        path = Path(output or f"{planned.phantom.document.name}-{side}-{style}.png")
        format = format_of_path(path)
        planned.check_format(format)
        tell_defaults(planned.chosen, given, None if output else path)
        ready(quiet=as_json, light=True)
        with Bar("drawing") as bar:
            made = planned.render(progress=bar)
        saved = save(made, path, quantity_of(format), planned.request.tone, sidecar=sidecar)
        say(f"wrote {path}")
        for warning in made.told["warnings"]:
            say(f"warning: {warning}")
        if as_json:
            answer({"output": str(path), **saved.beside})
