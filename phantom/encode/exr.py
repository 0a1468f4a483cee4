"""OpenEXR: every quantity as a named layer, in single precision; one view or several."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.attributes import METADATA_KEY, attributes
from phantom.encode.openimageio import Part, write_parts

LONGEST_NAME_BYTES = 255
"""Of a channel (The OpenEXR file layout, "Predefined attributes": long names)."""


def exr(layers: Mapping[str, NDArray[Any]], metadata: Mapping[str, Any]) -> bytes:
    """Return an OpenEXR file of (rows, columns) layers as float32, under their names.

    The attribute ``phantom:metadata`` is the whole metadata as JSON. ZIP compression, no loss.
    """
    return write_parts([_part(layers, metadata)], "exr")


def exr_views(
    views: Mapping[str, Mapping[str, NDArray[Any]]], metadata: Mapping[str, Any]
) -> bytes:
    """Return an OpenEXR file of several views, each with the same layers under their names.

    Each view is a part of its own, whose attributes ``view`` and ``name`` are the view's name
    (OpenEXR 2, multi-part files); the first part has the metadata.
    """
    parts = [
        _part(layers, {} if index else metadata, {"view": view, "oiio:subimagename": view})
        for index, (view, layers) in enumerate(views.items())
    ]
    return write_parts(parts, "exr")


def _part(
    layers: Mapping[str, NDArray[Any]],
    metadata: Mapping[str, Any],
    more: Mapping[str, str] | None = None,
) -> Part:
    pixels = np.stack([layer.astype(np.float32) for layer in layers.values()], axis=-1)
    told = {"compression": "zip", **(more or {}), **attributes(metadata, METADATA_KEY)}
    return Part(pixels, told, tuple(layers))


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
