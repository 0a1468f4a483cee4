"""TIFF: grey levels, or one quantity in single precision; metadata as the image's description."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from phantom.encode.attributes import attributes
from phantom.encode.openimageio import channelled, write

# The floating-point predictor would make files a third smaller; several readers do not know it.
_NO_PREDICTOR = 1


def tiff(values: NDArray[Any], metadata: Mapping[str, Any]) -> bytes:
    """Return a TIFF of (rows, columns) values, or (rows, columns, 3) colours.

    They are uint8 or uint16, as they are, and all else as float32.

    Deflate compression. ``ImageDescription`` is the whole metadata as JSON in ASCII: OpenImageIO
    drops any other field of our own.
    """
    told: dict[str, str | int] = {"compression": "zip", **attributes(metadata, "ImageDescription")}
    if values.dtype.kind == "f":
        values = values.astype(np.float32)
        told["tiff:predictor"] = _NO_PREDICTOR
    return write(channelled(values), "tif", told)
