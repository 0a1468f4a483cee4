"""NPY: the numbers of a quantity, single precision, little-endian."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray


def npy(values: NDArray[Any], metadata: dict[str, Any]) -> bytes:
    """Return an NPY file of (rows, columns) or (rows, columns, M) values as float32.

    Single precision keeps 2^-24 of a value. The header has no room for metadata: a sidecar does.
    """
    buffer = io.BytesIO()
    np.save(buffer, np.ascontiguousarray(values, dtype="<f4"), allow_pickle=False)
    return buffer.getvalue()
