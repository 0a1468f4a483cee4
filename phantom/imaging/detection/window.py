"""Which pixels of a detector are worked on, and the grid of rays that they need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phantom.imaging.view import Detector, FloatArray


@dataclass(frozen=True)
class Window:
    """A block of a detector's pixels: its first row and column, and how many there are."""

    first_row: int
    first_column: int
    rows: int
    columns: int

    @classmethod
    def whole(cls, detector: Detector) -> Window:
        """Return the window of every pixel."""
        return cls(0, 0, detector.rows, detector.columns)

    def grown(self, halo: tuple[int, int], detector: Detector) -> Window:
        """Return it with (rows, columns) more on every side, as far as the detector goes."""
        first_row = max(self.first_row - halo[0], 0)
        first_column = max(self.first_column - halo[1], 0)
        last_row = min(self.first_row + self.rows + halo[0], detector.rows)
        last_column = min(self.first_column + self.columns + halo[1], detector.columns)
        return Window(first_row, first_column, last_row - first_row, last_column - first_column)

    @property
    def row_indices(self) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """(rows,) indices on the whole detector."""
        return np.arange(self.first_row, self.first_row + self.rows, dtype=np.int64)

    @property
    def column_indices(self) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """(columns,) indices on the whole detector."""
        return np.arange(self.first_column, self.first_column + self.columns, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Lattice:
    """A grid of points on the detector to trace rays to, as ``phantom.tracing.raster`` takes it.

    Attributes
    ----------
    first_pixel, column_step, row_step
        (3,) mm: the first point, and the steps along a row and to the next row.
    columns, rows
        How many points.
    """

    first_pixel: FloatArray
    column_step: FloatArray
    row_step: FloatArray
    columns: int
    rows: int


def lattice(detector: Detector, window: Window, samples: tuple[int, int] = (1, 1)) -> Lattice:
    """Return the points of a window, ``samples`` (along a row, down a column) in every pixel.

    The samples of a pixel are the centres of its equal parts; one sample is its centre.
    """
    right, down = detector.axes
    pitch_x, pitch_y = detector.pitch_xy_mm
    across, along = samples
    first = detector.pixel(
        window.first_column - 0.5 + 0.5 / across, window.first_row - 0.5 + 0.5 / along
    )
    return Lattice(
        first_pixel=first,
        column_step=right * (pitch_x / across),
        row_step=down * (pitch_y / along),
        columns=window.columns * across,
        rows=window.rows * along,
    )
