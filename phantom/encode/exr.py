"""OpenEXR: every quantity as a named layer, in single precision."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.attributes import METADATA_KEY, attributes
from phantom.encode.openimageio import write

LONGEST_NAME_BYTES = 255
"""Of a channel (The OpenEXR file layout, "Predefined attributes": long names)."""


def exr(layers: Mapping[str, NDArray[Any]], metadata: Mapping[str, Any]) -> bytes:
    """Return an OpenEXR file of (rows, columns) layers as float32, under their names.

    The attribute ``phantom:metadata`` is the whole metadata as JSON. ZIP compression, no loss.
    """
    pixels = np.stack([layer.astype(np.float32) for layer in layers.values()], axis=-1)
    told = {"compression": "zip", **attributes(metadata, METADATA_KEY)}
    return write(pixels, "exr", told, tuple(layers))


def layer_names(prefix: str, names: Iterable[str]) -> tuple[str, ...]:
    """Return a layer's name, ``prefix.name``, for each name; all differ and can be written.

    Control characters become ``_``; a name that is too long, or that another already has, is cut
    and numbered.
    """
    found: list[str] = []
    for index, name in enumerate(names):
        plain = "".join(c if c.isprintable() else "_" for c in name)
        layer = f"{prefix}.{plain}"
        if layer in found or len(layer.encode()) > LONGEST_NAME_BYTES:
            end = f"~{index}"
            room = LONGEST_NAME_BYTES - len(end)
            layer = layer.encode()[:room].decode("utf-8", "ignore") + end
        found.append(layer)
    return tuple(found)
