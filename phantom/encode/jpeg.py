"""JPEG: a preview that loses a little; metadata as its comment."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.attributes import json_text
from phantom.encode.openimageio import channelled, write

QUALITY = 95
"""Of 100, as the Independent JPEG Group counts it."""

LONGEST_COMMENT_BYTES = 65_533
"""A segment's length has 16 bits and counts itself (ITU-T T.81, B.2.4.5)."""

_START, _COMMENT = b"\xff\xd8", b"\xff\xfe"


def jpeg(grey: NDArray[Any], metadata: Mapping[str, Any]) -> bytes:
    """Return a JPEG of (rows, columns) grey levels, or (rows, columns, 3).

    Of 16 bits the upper 8 are kept, rounded.

    The comment is the whole metadata as JSON in ASCII, or, where that is too long for one, a word
    on where to find it. It is put in here: OpenImageIO's writer ends the process over a long one.
    """
    if grey.dtype == np.uint16:
        grey = ((grey.astype(np.uint32) + 128) // 257).astype(np.uint8)
    told = {"compression": f"jpeg:{QUALITY}"}
    if grey.ndim == 3:
        told["jpeg:subsampling"] = "4:4:4"  # colours as sharp as brightness
    data = write(channelled(grey), "jpg", told)
    if not metadata:
        return data
    comment = json_text(metadata).encode("ascii")
    if len(comment) > LONGEST_COMMENT_BYTES:
        comment = b"The metadata is too long for a JPEG; ask for a JSON sidecar."
    segment = _COMMENT + struct.pack(">H", len(comment) + 2) + comment
    after = len(_START) + 2 + struct.unpack(">H", data[4:6])[0]  # after JFIF's own segment
    return data[:after] + segment + data[after:]
