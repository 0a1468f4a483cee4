"""Documents on disk as phantoms of the library, beside those of installed packages.

The environment variable ``PHANTOM_DOCUMENTS`` names folders, with ``:`` between them (``;`` on
Windows). Each JSON or YAML file in one is a phantom by its name without the ending; it has no
parameters. Files are read when they are asked for, so a changed file is a changed phantom.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from phantom.document import Document, Model, read
from phantom.errors import InvalidDocumentError, InvalidInputError, Problem
from phantom.library.entries import Entry

VARIABLE: Final = "PHANTOM_DOCUMENTS"
ENDINGS: Final = (".json", ".yaml", ".yml")


class NoParameters(Model):
    """A document is what it is."""


def files() -> Mapping[str, Path]:
    """Return the files of the folders, by the name of the phantom each is; the first of a name."""
    found: dict[str, Path] = {}
    for folder in os.environ.get(VARIABLE, "").split(os.pathsep):
        if folder and Path(folder).is_dir():
            for path in sorted(Path(folder).iterdir()):
                if path.suffix.lower() in ENDINGS and path.is_file():
                    found.setdefault(path.stem, path)
    return found


def entry_of(name: str, path: Path) -> Entry[Any]:
    """Return the entry of a document's file.

    Raises
    ------
    InvalidInputError
        The file is no document; its problems stand under ``/document``.
    """
    try:
        document = read(path)
    except InvalidDocumentError as error:
        raise InvalidInputError(
            Problem(f"/document{p.path}", p.kind, p.message) for p in error.problems
        ) from None

    def build(_: NoParameters) -> Document:
        return document

    return Entry(
        name=name,
        title=document.title or name,
        summary=document.description or f"The document in {path.name}.",
        parameters=NoParameters,
        build=build,
    )
