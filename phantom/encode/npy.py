"""NPY: the numbers of a quantity, little-endian, in single precision or as whole-number codes."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray


def npy(values: NDArray[Any]) -> bytes:
    """Return an NPY file of (rows, columns) or (rows, columns, M) values.

    Codes, uint16, are written as they are; all else as float32, which keeps 2^-24 of a value. The
    header has no room for metadata: a sidecar does.
    """
    kind = "<u2" if values.dtype == np.uint16 else "<f4"
    buffer = io.BytesIO()
    np.save(buffer, np.ascontiguousarray(values, dtype=kind), allow_pickle=False)
    return buffer.getvalue()
