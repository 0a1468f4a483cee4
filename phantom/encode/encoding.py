"""A result to bytes, or to a file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from phantom.encode.content import Content, Wanted
from phantom.encode.files import write_atomically
from phantom.encode.formats import FORMATS, Format, format_named, format_of_path
from phantom.encode.picture import Picture
from phantom.encode.sidecar import sidecar as sidecar_bytes
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
    beside
        What a sidecar says of them, as plain JSON values.
    """

    data: bytes
    media_type: str
    beside: Mapping[str, Any]


def encode(
    picture: Picture[PresentationT],
    quantity: str = "signal",
    presentation: PresentationT | None = None,
    format: Format | str = FORMATS[0],
    *,
    blind: bool = False,
) -> Encoded:
    """Return a result as the content of a file.

    Parameters
    ----------
    picture
        The result, such as a ``phantom.imaging.Radiograph``.
    quantity
        What to write, such as ``signal`` or ``path_lengths``; OpenEXR holds all of them.
    presentation
        How a quantity becomes grey levels; formats that hold numbers do not use it.
    format
        A :class:`Format`, its name or its media type.
    blind
        Leave out what the file says of itself, and an OpenEXR's layers of materials, so that a
        reader learns nothing but what the picture shows. What a DICOM file cannot do without stays:
        pitch, orientation, body part and view.

    Raises
    ------
    InvalidInputError
        An unknown format, or a quantity it cannot hold (``/quantity``).
    """
    chosen = format_named(format) if isinstance(format, str) else format
    check_held(chosen, quantity)
    layers, file = chosen.take(picture, Wanted(quantity, presentation, blind))
    content = Content(layers, {"format": chosen.name, **file}, picture.metadata(), blind)
    return Encoded(chosen.write(content), chosen.media_type, content.beside)


def check_held(format: Format, quantity: str) -> None:
    """Refuse a format that cannot hold the quantity (``/quantity``)."""
    if quantity not in format.quantities:
        held = ", ".join(format.quantities)
        message = f"found {quantity!r}, but {format.name} holds one of {held}"
        raise InvalidInputError([Problem("/quantity", "not_in_format", message)])


def save(
    picture: Picture[PresentationT],
    path: Path | str,
    quantity: str = "signal",
    presentation: PresentationT | None = None,
    *,
    sidecar: bool = False,
    blind: bool = False,
) -> Encoded:
    """Write a result to a file, whole or not at all, and return it; the extension says the format.

    With ``sidecar`` its metadata goes to a JSON file of the same name beside it.

    Raises
    ------
    InvalidInputError
        An unknown extension, a quantity the format cannot hold, or no such folder.
    """
    path = Path(path)
    encoded = encode(picture, quantity, presentation, format_of_path(path), blind=blind)
    write_atomically(path, encoded.data)
    if sidecar:
        write_atomically(path.with_suffix(".json"), sidecar_bytes(encoded.beside))
    return encoded
