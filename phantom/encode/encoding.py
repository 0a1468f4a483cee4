"""A result to bytes, or to a file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from numpy.typing import NDArray

from phantom.encode.files import write_atomically
from phantom.encode.formats import FORMATS, Format, format_named, format_of_path
from phantom.encode.picture import Picture
from phantom.errors import InvalidInputError, Problem

PresentationT = TypeVar("PresentationT")


class Encoded(NamedTuple):
    """A file's content.

    Attributes
    ----------
    data
        The bytes; the same for the same result.
    media_type
        What they are.
    """

    data: bytes
    media_type: str


def encode(
    picture: Picture[PresentationT],
    quantity: str = "signal",
    presentation: PresentationT | None = None,
    format: Format | str = FORMATS[0],
) -> Encoded:
    """Return a result as the content of a file.

    Parameters
    ----------
    picture
        The result, such as a ``phantom.imaging.Radiograph``.
    quantity
        What to write, such as ``signal`` or ``path_lengths``.
    presentation
        How a quantity becomes grey levels; formats that hold numbers do not use it.
    format
        A :class:`Format`, its name or its media type.

    Raises
    ------
    InvalidInputError
        An unknown format, or a quantity it cannot hold (``/quantity``).
    """
    chosen = format_named(format) if isinstance(format, str) else format
    if quantity not in chosen.quantities:
        held = ", ".join(chosen.quantities)
        message = f"found {quantity!r}, but {chosen.name} holds one of {held}"
        raise InvalidInputError([Problem("/quantity", "not_in_format", message)])
    array: NDArray[Any]
    if chosen.presented:
        array = picture.presented(quantity, presentation)
    else:
        array = picture.quantity(quantity)
    return Encoded(chosen.write(array, picture.metadata()), chosen.media_type)


def save(
    picture: Picture[PresentationT],
    path: Path | str,
    quantity: str = "signal",
    presentation: PresentationT | None = None,
    *,
    sidecar: bool = False,
) -> None:
    """Write a result to a file, whole or not at all; the extension says the format.

    With ``sidecar`` its metadata goes to a JSON file of the same name beside it.

    Raises
    ------
    InvalidInputError
        An unknown extension, a quantity the format cannot hold, or no such folder.
    """
    path = Path(path)
    encoded = encode(picture, quantity, presentation, format_of_path(path))
    write_atomically(path, encoded.data)
    if sidecar:
        text = json.dumps(picture.metadata(), ensure_ascii=False, allow_nan=False, indent=1)
        write_atomically(path.with_suffix(".json"), f"{text}\n".encode())
