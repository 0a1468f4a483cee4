"""The formats that can be written: by extension and by media type.

A format says what it takes from a result (grey levels, the numbers of a quantity, codes for them,
every quantity as a layer, or nothing but the metadata) and has one writer for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

from phantom.encode.content import (
    COLOR,
    IMAGES,
    Content,
    Take,
    codes,
    everything,
    grey,
    nothing,
    numbers,
)
from phantom.encode.dicom import for_presentation, for_processing, judged
from phantom.encode.exr import exr
from phantom.encode.jpeg import jpeg
from phantom.encode.npy import npy
from phantom.encode.png import png
from phantom.encode.sidecar import sidecar
from phantom.encode.tiff import tiff
from phantom.errors import InvalidInputError, Problem

SHOWN: Final = (*IMAGES, COLOR)
QUANTITIES: Final = (*IMAGES, "path_lengths", COLOR)

DRAWING: Final = "drawing"
"""What an SVG holds: the lines of a wireframe, as the bytes of its file."""

Known = TypeVar("Known")


@dataclass(frozen=True, slots=True)
class Format:
    """A file format.

    Attributes
    ----------
    name
        Short name; also what a request calls it.
    extensions
        In lower case, with the dot; the longest that fits a file's name counts.
    media_type
        As in ``Accept`` and ``Content-Type``.
    quantities
        The quantities it can hold.
    take
        Takes from a result what the format holds.
    write
        Makes the bytes; the metadata is left out where the format cannot hold it.
    """

    name: str
    extensions: tuple[str, ...]
    media_type: str
    quantities: tuple[str, ...]
    take: Take
    write: Callable[[Content], bytes]


FORMATS: Final[tuple[Format, ...]] = (
    Format("png", (".png",), "image/png", SHOWN, grey, lambda c: png(c.only, c.told)),
    Format("npy", (".npy",), "application/x-npy", QUANTITIES, numbers, lambda c: npy(c.only)),
    Format(
        "npy-uint16",
        (".u16.npy",),
        "application/x-npy;dtype=uint16",
        IMAGES,
        codes,
        lambda c: npy(c.only),
    ),
    Format("tiff", (".tif", ".tiff"), "image/tiff", SHOWN, grey, lambda c: tiff(c.only, c.told)),
    Format(
        "tiff-float32",
        (".f32.tif", ".f32.tiff"),
        "image/tiff;dtype=float32",
        SHOWN,
        numbers,
        lambda c: tiff(c.only, c.told),
    ),
    Format(
        "exr", (".exr",), "image/x-exr", QUANTITIES, everything, lambda c: exr(c.layers, c.told)
    ),
    Format("jpeg", (".jpg", ".jpeg"), "image/jpeg", SHOWN, grey, lambda c: jpeg(c.only, c.told)),
    Format("dicom", (".dcm",), "application/dicom", IMAGES, judged(grey), for_presentation),
    Format(
        "dicom-processing",
        (".raw.dcm",),
        "application/dicom;intent=processing",
        IMAGES,
        judged(codes),
        for_processing,
    ),
    Format(
        "json", (".json",), "application/json", QUANTITIES, nothing, lambda c: sidecar(c.beside)
    ),
)
"""Every format of pixels, the default first."""

SVG: Final = Format(
    "svg", (".svg",), "image/svg+xml", (DRAWING,), numbers, lambda c: c.only.tobytes()
)
"""Lines instead of pixels: a wireframe's alone."""

_OF_EXTENSION: Final[Mapping[str, Format]] = {
    extension: known for known in (*FORMATS, SVG) for extension in known.extensions
}


def format_of_path(path: Path | str) -> Format:
    """Return the format that a file's extension names, in either case.

    Raises
    ------
    InvalidInputError
        The extension is not known (``/output``).
    """
    return by_extension(path, _OF_EXTENSION)


def by_extension(path: Path | str, known: Mapping[str, Known], field: str = "/output") -> Known:
    """Return what a table has for a file's extension, in either case; the longest that fits.

    Raises
    ------
    InvalidInputError
        The extension is not in the table (at ``field``).
    """
    suffixes = [suffix.lower() for suffix in Path(path).suffixes]
    for start in range(len(suffixes)):
        extension = "".join(suffixes[start:])
        if extension in known:
            return known[extension]
    found = f"found the extension {suffixes[-1]!r}" if suffixes else "found no extension"
    raise _unknown(field, f"{found}, expected one of {', '.join(known)}")


def format_named(name: str) -> Format:
    """Return the format of that name or media type.

    Raises
    ------
    InvalidInputError
        There is none (``/format``).
    """
    for known in (*FORMATS, SVG):
        if name in (known.name, known.media_type):
            return known
    names = ", ".join(f"{known.name} ({known.media_type})" for known in FORMATS)
    raise _unknown("/format", f"found {name!r}, expected one of {names}")


def _unknown(path: str, message: str) -> InvalidInputError:
    return InvalidInputError([Problem(path, "unknown_format", message)])
