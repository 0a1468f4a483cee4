"""The one place where OpenImageIO is called.

OpenImageIO takes an array of (height, width) for one of (height × width, 1) or worse, and writes a
wrong file without an error; so every array goes through :func:`write` as (rows, columns, channels).
Its Python module has no way to write to memory; a file that lives in memory serves on Linux, and a
temporary one elsewhere.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

_DEPTHS: Final = {"uint8": "uint8", "uint16": "uint16"}
_DESCRIPTORS: Final = Path("/proc/self/fd")


def write(pixels: NDArray[np.generic], extension: str, attributes: Mapping[str, str]) -> bytes:
    """Return the bytes of an image file.

    Parameters
    ----------
    pixels
        (rows, columns, channels), uint8 or uint16.
    extension
        Says which format, without the dot.
    attributes
        Strings to put into the file; ASCII, since a PNG's text is read as Latin-1.
    """
    if pixels.ndim != 3:
        raise ValueError(f"expected (rows, columns, channels), found shape {pixels.shape}")
    if pixels.dtype.name not in _DEPTHS:
        raise ValueError(f"expected uint8 or uint16, found {pixels.dtype}")
    if hasattr(os, "memfd_create") and _DESCRIPTORS.is_dir():
        return _through_memory(pixels, extension, attributes)
    return _through_file(pixels, extension, attributes)


def _through_memory(
    pixels: NDArray[np.generic], extension: str, attributes: Mapping[str, str]
) -> bytes:
    descriptor = os.memfd_create("image")
    try:
        path = _DESCRIPTORS / str(descriptor)
        _write_file(path, pixels, extension, attributes)
        return path.read_bytes()
    finally:
        os.close(descriptor)


def _through_file(
    pixels: NDArray[np.generic], extension: str, attributes: Mapping[str, str]
) -> bytes:
    with tempfile.TemporaryDirectory(prefix="phantom-") as folder:
        path = Path(folder) / f"image.{extension}"
        _write_file(path, pixels, extension, attributes)
        return path.read_bytes()


def _write_file(
    path: Path, pixels: NDArray[np.generic], extension: str, attributes: Mapping[str, str]
) -> None:
    import OpenImageIO

    rows, columns, channels = pixels.shape
    spec = OpenImageIO.ImageSpec(columns, rows, channels, _DEPTHS[pixels.dtype.name])
    for name, value in attributes.items():
        spec.attribute(name, value)
    output = OpenImageIO.ImageOutput.create(extension)
    if output is None:
        raise OSError(f"OpenImageIO cannot write {extension}: {OpenImageIO.geterror()}")
    written = output.open(str(path), spec) and output.write_image(np.ascontiguousarray(pixels))
    if not written or not output.close():
        raise OSError(f"OpenImageIO could not write {extension}: {output.geterror()}")
