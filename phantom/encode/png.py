"""PNG: 8 or 16 bits of grey, with the metadata as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.attributes import METADATA_KEY, attributes
from phantom.encode.openimageio import write


def png(grey: NDArray[Any], metadata: Mapping[str, Any]) -> bytes:
    """Return a PNG of (rows, columns) grey levels, uint8 or uint16.

    Text chunks: ``Software`` names the version, ``Title`` the phantom, and ``phantom:metadata`` is
    the whole metadata as JSON in ASCII. No time is written, so equal images have equal bytes.
    """
    return write(np.asarray(grey)[:, :, None], "png", attributes(metadata, METADATA_KEY))
