"""h(phi) of a contour: negative inside, with its gradient."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import kernel

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@kernel
def circle(x: float, y: float) -> tuple[float, float, float]:
    """Return h, dh/dx and dh/dy of the unit circle."""
    return x * x + y * y - 1.0, 2.0 * x, 2.0 * y


@kernel
def star(
    x: float,
    y: float,
    table: int,
    first_cell: Ints,
    edges: Floats,
    cells: Floats,
    first_bucket: Ints,
    buckets: Ints,
) -> tuple[float, float, float]:
    """Return h, dh/dx and dh/dy of a tabulated contour (:mod:`phantom.compiled.sections`)."""
    if abs(x) >= abs(y):
        chart, major, minor = (0.0, x, y) if x >= 0 else (2.0, -x, -y)
    else:
        chart, major, minor = (1.0, y, -x) if y >= 0 else (3.0, -y, x)
    if major == 0.0:
        return -1.0, 0.0, 0.0
    t = minor / major
    T = 2.0 * chart + t + 1.0
    count = first_bucket[table + 1] - first_bucket[table]
    bucket = min(int(T * count * 0.125), count - 1)
    cell = buckets[first_bucket[table] + bucket]
    # Edges of a table with n cells take n + 1 places: one more than its cells per table.
    edge = cell + table
    last = first_cell[table + 1] - 1
    while cell < last and edges[edge + 1] <= T:
        cell += 1
        edge += 1
    half = 0.5 * (edges[edge + 1] - edges[edge])
    z = (T - edges[edge] - half) / half
    c0, c1, c2 = cells[cell, 0], cells[cell, 1], cells[cell, 2]
    c3, c4, c5 = cells[cell, 3], cells[cell, 4], cells[cell, 5]
    g = ((((c5 * z + c4) * z + c3) * z + c2) * z + c1) * z + c0
    slope = ((((5 * c5 * z + 4 * c4) * z + 3 * c3) * z + 2 * c2) * z + c1) / half
    g_major, g_minor = major * (2.0 * g - t * slope), major * slope
    if chart == 0.0:
        gx, gy = g_major, g_minor
    elif chart == 1.0:
        gx, gy = -g_minor, g_major
    elif chart == 2.0:
        gx, gy = -g_major, -g_minor
    else:
        gx, gy = g_minor, -g_major
    return major * major * g - 1.0, gx, gy
