"""Arguments that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Target = Annotated[
    str, typer.Argument(metavar="NAME|FILE", help="A phantom of the library, or a document.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Answer, and complain, in JSON.")]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="A parameter of the library phantom."),
]

Abnormalities = Annotated[
    list[str] | None,
    typer.Option(
        "--abnormality",
        metavar="TYPE,NAME=VALUE,…|JSON",
        help="Something wrong with the library phantom; may be repeated.",
    ),
]


def subject(
    target: str, settings: list[str] | None, abnormalities: list[str] | None = None
) -> dict[str, object]:
    """Return the request's ``phantom`` for a library name or a document's file.

    Raises
    ------
    InvalidInputError
        A file that cannot be read, or parameters or abnormalities given for one.
    """
    from phantom import library
    from phantom.errors import InvalidInputError, Problem
    from phantom.requests.words import abnormality, parameters

    if target in library.names() or not _is_file(target):
        wanted: dict[str, object] = {"name": target}
        wanted["parameters"] = parameters(map(_pair, settings or ()))
        if abnormalities:
            wanted["abnormalities"] = [abnormality(text) for text in abnormalities]
        return wanted
    for option, field, given in (
        ("--set", "parameters", settings),
        ("--abnormality", "abnormalities", abnormalities),
    ):
        if given:
            message = f"found {option} with a file; expected it with a phantom of the library"
            raise InvalidInputError([Problem(f"/phantom/{field}", "unknown_field", message)])
    return {"document": read_file(target)}


def read_file(name: str) -> object:
    """Return the tree in a document's file, JSON or YAML."""
    from phantom.document.reading import read_tree

    return read_tree(Path(name))


def json_text(given: str, path: str) -> str:
    """Return JSON given as it is or in a file, or ``none``; ``path`` is where a request has it.

    Raises
    ------
    InvalidInputError
        The file cannot be read.
    """
    from phantom.errors import InvalidInputError, Problem

    if given.lstrip()[:1] == "{" or given.strip() == "none":
        return given
    try:
        text = Path(given).read_text(encoding="utf-8")
    except (OSError, ValueError):
        message = f"found no file {given[:200]!r} to read; expected one, or a JSON object"
        raise InvalidInputError([Problem(path, "unreadable", message)]) from None
    return text.strip()


def _is_file(target: str) -> bool:
    """Tell whether a target is, or is written as, a document's file."""
    try:
        return target.lower().endswith((".json", ".yaml", ".yml")) or Path(target).is_file()
    except OSError:  # no name a file could have
        return False


def _pair(text: str) -> tuple[str, str]:
    from phantom.errors import InvalidInputError, Problem

    name, equals, value = text.partition("=")
    if not equals:
        message = f"found --set {text[:60]!r}; expected NAME=VALUE"
        raise InvalidInputError([Problem("/phantom/parameters", "not_a_pair", message)])
    return name.strip(), value
