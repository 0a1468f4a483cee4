"""h(phi) of a contour: negative inside, with its gradient."""

from __future__ import annotations

from phantom.compiled.layout import Tables
from phantom.kernels.compiling import inner


@inner
def circle(x: float, y: float) -> tuple[float, float, float]:
    """Return h, dh/dx and dh/dy of the unit circle."""
    return x * x + y * y - 1.0, 2.0 * x, 2.0 * y


@inner
def chart_of(x: float, y: float) -> tuple[int, float, float]:
    """Return the chart of a point and its major and minor coordinates there."""
    if abs(x) >= abs(y):
        return (0, x, y) if x >= 0 else (2, -x, -y)
    return (1, y, -x) if y >= 0 else (3, -y, x)


@inner
def cell_of(T: float, table: int, tables: Tables) -> int:
    """Return the cell of a table that holds the pseudo-angle T; its edge lies ``table`` later."""
    count = tables.first_bucket[table + 1] - tables.first_bucket[table]
    bucket = min(int(T * count * 0.125), count - 1)
    cell = tables.buckets[tables.first_bucket[table] + bucket]
    last = tables.first_cell[table + 1] - 1
    while cell < last and tables.edges[cell + table + 1] <= T:
        cell += 1
    return int(cell)


@inner
def turned(chart: int, major: float, minor: float) -> tuple[float, float]:
    """Turn a vector of a chart back to x and y."""
    if chart == 0:
        return major, minor
    if chart == 1:
        return -minor, major
    if chart == 2:
        return -major, -minor
    return minor, -major


@inner
def star(x: float, y: float, table: int, tables: Tables) -> tuple[float, float, float]:
    """Return h, dh/dx and dh/dy of a fixed contour (:mod:`phantom.compiled.sections`)."""
    chart, major, minor = chart_of(x, y)
    if major == 0.0:
        return -1.0, 0.0, 0.0
    t = minor / major
    T = 2.0 * chart + t + 1.0
    cell = cell_of(T, table, tables)
    low = tables.edges[cell + table]
    half = 0.5 * (tables.edges[cell + table + 1] - low)
    z = (T - low - half) / half
    c = tables.cells
    g, slope = c[cell, 5], 0.0
    for i in range(4, -1, -1):
        slope = slope * z + g
        g = g * z + c[cell, i]
    slope /= half
    gx, gy = turned(chart, major * (2.0 * g - t * slope), major * slope)
    return major * major * g - 1.0, gx, gy


@inner
def changing_star(
    x: float, y: float, tau: float, table: int, tables: Tables
) -> tuple[float, float, float, float]:
    """Return h, dh/dx, dh/dy and dh/dtau of a contour that changes along the segment."""
    chart, major, minor = chart_of(x, y)
    if major == 0.0:
        return -1.0, 0.0, 0.0, 0.0
    t = minor / major
    T = 2.0 * chart + t + 1.0
    cell = cell_of(T, table, tables)
    low = tables.edges[cell + table]
    half = 0.5 * (tables.edges[cell + table + 1] - low)
    z = (T - low - half) / half
    c = tables.tensors
    row = cell - len(tables.cells)
    g = slope = rate = 0.0
    for i in range(5, -1, -1):
        value, first = c[row, i, 6], 0.0
        for j in range(5, -1, -1):
            first = first * tau + value
            value = value * tau + c[row, i, j]
        slope = slope * z + g
        g = g * z + value
        rate = rate * z + first
    slope /= half
    gx, gy = turned(chart, major * (2.0 * g - t * slope), major * slope)
    square = major * major
    return square * g - 1.0, gx, gy, square * rate
