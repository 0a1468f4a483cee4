"""PNG: 8 or 16 bits of grey, with the metadata as text."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.openimageio import write

METADATA_KEY = "phantom:metadata"
"""Keyword of the PNG text that holds the whole metadata as JSON."""


def png(grey: NDArray[Any], metadata: dict[str, Any]) -> bytes:
    """Return a PNG of (rows, columns) grey levels, uint8 or uint16.

    Text chunks: ``Software`` names the version, ``Title`` the phantom, and ``phantom:metadata`` is
    the whole metadata as JSON in ASCII. No time is written, so equal images have equal bytes.
    """
    text = json.dumps(metadata, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    attributes = {METADATA_KEY: text}
    software = metadata.get("software")
    if software is not None:
        attributes["Software"] = f"{software['name']} {software['version']}"
    named = metadata.get("phantom")
    if named is not None:
        attributes["DocumentName"] = str(named["name"]).encode("ascii", "replace").decode()
    return write(np.asarray(grey)[:, :, None], "png", attributes)
