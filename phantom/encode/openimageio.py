"""The one place where OpenImageIO is called.

What it does without an error, and what is done about it here:

- It takes an array of (height, width) for one of (height × width, 1) or worse; so every array comes
  as (rows, columns, channels).
- It converts numbers that the format cannot hold, nan to 0 and 16 bits to 8; so a file that would
  hold other numbers than the array is refused.
- It stamps EXR and TIFF with the time; so they get EXIF's word for an unknown time, and equal
  images have equal bytes.
- Its Python module cannot write to memory. A file that lives in memory serves on Linux, a temporary
  one elsewhere. Some writers leave that file empty; an empty file is refused.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

_DEPTHS: Final = {"uint8": "uint8", "uint16": "uint16", "float32": "float"}
_DESCRIPTORS: Final = Path("/proc/self/fd")
_STAMPED: Final = frozenset({"exr", "tif", "tiff"})
_NO_TIME: Final = "    :  :     :  :  "
"""An unknown time as EXIF 2.32, section 4.6.5 (DateTime), has it."""


class Part(NamedTuple):
    """One image of a file.

    Attributes
    ----------
    pixels
        (rows, columns, channels), uint8, uint16 or float32.
    attributes
        What to put into the file or to tell its writer. ASCII, since a PNG's text is read as
        Latin-1 and a TIFF's as ASCII.
    channel_names
        One a channel, where the format has names for them.
    """

    pixels: NDArray[np.generic]
    attributes: Mapping[str, str | int]
    channel_names: Sequence[str] = ()


def channelled(image: NDArray[Any]) -> NDArray[Any]:
    """Return (rows, columns) grey, or (rows, columns, 3) colours, with an axis of channels."""
    return image[:, :, np.newaxis] if image.ndim == 2 else image


def write(
    pixels: NDArray[np.generic],
    extension: str,
    attributes: Mapping[str, str | int],
    channel_names: Sequence[str] = (),
) -> bytes:
    """Return the bytes of an image file of one :class:`Part`; see :func:`write_parts`."""
    return write_parts([Part(pixels, attributes, channel_names)], extension)


def write_parts(parts: Sequence[Part], extension: str) -> bytes:
    """Return the bytes of an image file.

    Parameters
    ----------
    parts
        One, or more where the format can hold several.
    extension
        Says which format, without the dot.

    Raises
    ------
    ValueError
        An array of another shape or type, or one that the format would hold as another type.
    OSError
        OpenImageIO could not write it.
    """
    specs = [_spec(part, extension) for part in parts]
    images = [part.pixels for part in parts]
    if hasattr(os, "memfd_create") and _DESCRIPTORS.is_dir():
        data = _through_memory(images, extension, specs)
    else:
        data = _through_file(images, extension, specs)
    if not data:
        raise OSError(f"OpenImageIO wrote an empty {extension}")
    return data


def _spec(part: Part, extension: str) -> Any:
    import OpenImageIO

    pixels = part.pixels
    if pixels.ndim != 3:
        raise ValueError(f"expected (rows, columns, channels), found shape {pixels.shape}")
    if pixels.dtype.name not in _DEPTHS:
        raise ValueError(f"expected one of {', '.join(_DEPTHS)}, found {pixels.dtype}")
    rows, columns, channels = pixels.shape
    spec = OpenImageIO.ImageSpec(columns, rows, channels, _DEPTHS[pixels.dtype.name])
    if part.channel_names:
        spec.channelnames = tuple(part.channel_names)
    if extension in _STAMPED:
        spec.attribute("DateTime", _NO_TIME)
    for name, value in part.attributes.items():
        spec.attribute(name, value)
    return spec


def _through_memory(
    images: Sequence[NDArray[np.generic]], extension: str, specs: Sequence[Any]
) -> bytes:
    descriptor = os.memfd_create("image")
    try:
        path = _DESCRIPTORS / str(descriptor)
        _write_file(path, images, extension, specs)
        return path.read_bytes()
    finally:
        os.close(descriptor)


def _through_file(
    images: Sequence[NDArray[np.generic]], extension: str, specs: Sequence[Any]
) -> bytes:
    with tempfile.TemporaryDirectory(prefix="phantom-") as folder:
        path = Path(folder) / f"image.{extension}"
        _write_file(path, images, extension, specs)
        return path.read_bytes()


def _write_file(
    path: Path, images: Sequence[NDArray[np.generic]], extension: str, specs: Sequence[Any]
) -> None:
    import OpenImageIO

    output = OpenImageIO.ImageOutput.create(extension)
    if output is None:
        raise OSError(f"OpenImageIO cannot write {extension}: {OpenImageIO.geterror()}")
    if not output.open(str(path), specs[0] if len(specs) == 1 else tuple(specs)):
        raise OSError(f"OpenImageIO could not open a {extension}: {output.geterror()}")
    for index, (pixels, spec) in enumerate(zip(images, specs, strict=True)):
        if index and not output.open(str(path), spec, "AppendSubimage"):
            raise OSError(f"OpenImageIO could not add to a {extension}: {output.geterror()}")
        held = output.spec().format
        if held != spec.format:
            output.close()
            raise ValueError(f"expected what {extension} holds, {held}; found {pixels.dtype}")
        if not output.write_image(np.ascontiguousarray(pixels)):
            raise OSError(f"OpenImageIO could not write {extension}: {output.geterror()}")
    if not output.close():
        raise OSError(f"OpenImageIO could not write {extension}: {output.geterror()}")
