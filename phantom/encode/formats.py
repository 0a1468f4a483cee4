"""The formats that can be written: by extension and by media type.

A format is one writer. What needs grey levels (PNG) is presented first; what holds numbers (NPY)
takes a quantity as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from numpy.typing import NDArray

from phantom.encode.npy import npy
from phantom.encode.png import png
from phantom.errors import InvalidInputError, Problem

Writer = Callable[[NDArray[Any], dict[str, Any]], bytes]


@dataclass(frozen=True, slots=True)
class Format:
    """A file format.

    Attributes
    ----------
    name
        Short name; also what a request calls it.
    extensions
        In lower case, with the dot.
    media_type
        As in ``Accept`` and ``Content-Type``.
    presented
        True where it holds grey levels, False where it holds the numbers of a quantity.
    quantities
        The quantities it can hold.
    write
        Takes the array and the metadata; the metadata is left out where the format cannot hold it.
    """

    name: str
    extensions: tuple[str, ...]
    media_type: str
    presented: bool
    quantities: tuple[str, ...]
    write: Writer


FORMATS: Final[tuple[Format, ...]] = (
    Format(
        "png",
        (".png",),
        "image/png",
        presented=True,
        quantities=("signal", "transmission", "line_integral"),
        write=png,
    ),
    Format(
        "npy",
        (".npy",),
        "application/x-npy",
        presented=False,
        quantities=("signal", "transmission", "line_integral", "path_lengths"),
        write=npy,
    ),
)
"""Every format, the default first."""


def format_of_path(path: Path | str) -> Format:
    """Return the format that a file's extension names, in either case.

    Raises
    ------
    InvalidInputError
        The extension is not known (``/output``).
    """
    extension = Path(path).suffix.lower()
    for known in FORMATS:
        if extension in known.extensions:
            return known
    names = ", ".join(e for known in FORMATS for e in known.extensions)
    found = f"found the extension {extension!r}" if extension else "found no extension"
    raise _unknown("/output", f"{found}, expected one of {names}")


def format_named(name: str) -> Format:
    """Return the format of that name or media type.

    Raises
    ------
    InvalidInputError
        There is none (``/format``).
    """
    for known in FORMATS:
        if name in (known.name, known.media_type):
            return known
    names = ", ".join(f"{known.name} ({known.media_type})" for known in FORMATS)
    raise _unknown("/format", f"found {name!r}, expected one of {names}")


def _unknown(path: str, message: str) -> InvalidInputError:
    return InvalidInputError([Problem(path, "unknown_format", message)])
