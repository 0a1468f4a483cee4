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
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

_DEPTHS: Final = {"uint8": "uint8", "uint16": "uint16", "float32": "float"}
_DESCRIPTORS: Final = Path("/proc/self/fd")
_STAMPED: Final = frozenset({"exr", "tif", "tiff"})
_NO_TIME: Final = "    :  :     :  :  "
"""An unknown time as EXIF 2.32, section 4.6.5 (DateTime), has it."""


def write(
    pixels: NDArray[np.generic],
    extension: str,
    attributes: Mapping[str, str | int],
    channel_names: Sequence[str] = (),
) -> bytes:
    """Return the bytes of an image file.

    Parameters
    ----------
    pixels
        (rows, columns, channels), uint8, uint16 or float32.
    extension
        Says which format, without the dot.
    attributes
        What to put into the file or to tell its writer. ASCII, since a PNG's text is read as
        Latin-1 and a TIFF's as ASCII.
    channel_names
        One a channel, where the format has names for them.

    Raises
    ------
    ValueError
        An array of another shape or type, or one that the format would hold as another type.
    OSError
        OpenImageIO could not write it.
    """
    if pixels.ndim != 3:
        raise ValueError(f"expected (rows, columns, channels), found shape {pixels.shape}")
    if pixels.dtype.name not in _DEPTHS:
        raise ValueError(f"expected one of {', '.join(_DEPTHS)}, found {pixels.dtype}")

    import OpenImageIO

    rows, columns, channels = pixels.shape
    spec = OpenImageIO.ImageSpec(columns, rows, channels, _DEPTHS[pixels.dtype.name])
    if channel_names:
        spec.channelnames = tuple(channel_names)
    if extension in _STAMPED:
        spec.attribute("DateTime", _NO_TIME)
    for name, value in attributes.items():
        spec.attribute(name, value)
    if hasattr(os, "memfd_create") and _DESCRIPTORS.is_dir():
        data = _through_memory(pixels, extension, spec)
    else:
        data = _through_file(pixels, extension, spec)
    if not data:
        raise OSError(f"OpenImageIO wrote an empty {extension}")
    return data


def _through_memory(pixels: NDArray[np.generic], extension: str, spec: Any) -> bytes:
    descriptor = os.memfd_create("image")
    try:
        path = _DESCRIPTORS / str(descriptor)
        _write_file(path, pixels, extension, spec)
        return path.read_bytes()
    finally:
        os.close(descriptor)


def _through_file(pixels: NDArray[np.generic], extension: str, spec: Any) -> bytes:
    with tempfile.TemporaryDirectory(prefix="phantom-") as folder:
        path = Path(folder) / f"image.{extension}"
        _write_file(path, pixels, extension, spec)
        return path.read_bytes()


def _write_file(path: Path, pixels: NDArray[np.generic], extension: str, spec: Any) -> None:
    import OpenImageIO

    output = OpenImageIO.ImageOutput.create(extension)
    if output is None:
        raise OSError(f"OpenImageIO cannot write {extension}: {OpenImageIO.geterror()}")
    if not output.open(str(path), spec):
        raise OSError(f"OpenImageIO could not open a {extension}: {output.geterror()}")
    held = output.spec().format
    if held != spec.format:
        output.close()
        raise ValueError(f"expected what {extension} holds, {held}; found {pixels.dtype}")
    if not output.write_image(np.ascontiguousarray(pixels)) or not output.close():
        raise OSError(f"OpenImageIO could not write {extension}: {output.geterror()}")
