"""PNG: 8 or 16 bits of grey or colour, with the metadata as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.attributes import METADATA_KEY, attributes
from phantom.encode.openimageio import channelled, write


def png(grey: NDArray[Any], metadata: Mapping[str, Any]) -> bytes:
    """Return a PNG of (rows, columns) grey levels, or (rows, columns, 3), uint8 or uint16.

    Text chunks: ``Software`` names the version, ``Title`` the phantom, and ``phantom:metadata`` is
    the whole metadata as JSON in ASCII. No time is written, so equal images have equal bytes.
    """
    return write(channelled(np.asarray(grey)), "png", attributes(metadata, METADATA_KEY))
