"""The rays of one exposure: those to the pixels' centres, and those that the detector needs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from phantom.imaging.detection import (
    Acquisition,
    Lattice,
    Window,
    lattice,
    scatter_lattice,
    source_points,
)
from phantom.imaging.view import FloatArray, View

if TYPE_CHECKING:
    from phantom.scene import Phantom

Each = Callable[[int, FloatArray], None]


@dataclass
class Traces:
    """What an exposure traces of a phantom, one image of rays after the other.

    Attributes
    ----------
    phantom, view, acquisition
        What is traced; None for the centres of the pixels alone.
    workers, cancelled, progress
        As in :func:`phantom.tracing.raster`; progress counts the rows of all images of rays.
    """

    phantom: Phantom
    view: View
    acquisition: Acquisition | None
    workers: int | None = None
    cancelled: Callable[[], bool] | None = None
    progress: Callable[[int, int], None] | None = None
    _done: int = field(default=0, init=False)
    _total: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        """Count the rows that there will be."""
        detector, asked = self.view.detector, self.acquisition
        self._total = detector.rows
        if asked is None:
            return
        if not self._by_centres:
            points = len(source_points(self.view, asked.focal_spot))
            self._total += points * detector.rows * asked.samples_per_pixel[1]
        if asked.scatter is not None:
            self._total += scatter_lattice(detector).rows

    @property
    def _by_centres(self) -> bool:
        """Whether the rays to the pixels' centres are all that the detector needs."""
        asked = self.acquisition
        return asked is None or (
            asked.samples_per_pixel == (1, 1)
            and len(source_points(self.view, asked.focal_spot)) == 1
        )

    def centres(self, each: Each | None = None) -> FloatArray:
        """Return (rows, columns, M) mm from the view's source to the centre of every pixel.

        ``each`` is given every band of rows, (M, rows, columns), as soon as it is traced.
        """
        detector = self.view.detector
        return self._traced(lattice(detector, Window.whole(detector)), self._source, each)

    def centres_by_bands(self, each: Each) -> None:
        """Trace what :meth:`centres` does, and keep nothing but what ``each`` makes of it."""
        from phantom.tracing import raster_bands

        detector = self.view.detector
        rays = lattice(detector, Window.whole(detector))
        raster_bands(self.phantom, each, **self._asked(rays, self._source))
        self._done += rays.rows

    def samples(self, centres: FloatArray) -> Iterator[tuple[float, FloatArray]]:
        """Yield the weight and the path lengths of each point of the focal spot.

        ``centres`` is what :meth:`centres` gave; it is not traced a second time.
        """
        asked = self.acquisition
        if asked is None or self._by_centres:
            yield 1.0, centres
            return
        detector = self.view.detector
        rays = lattice(detector, Window.whole(detector), asked.samples_per_pixel)
        for weight, source in source_points(self.view, asked.focal_spot):
            yield weight, self._traced(rays, source)

    def field(self) -> FloatArray | None:
        """Return the path lengths over the coarse lattice of scatter; None without scatter."""
        if self.acquisition is None or self.acquisition.scatter is None:
            return None
        return self._traced(scatter_lattice(self.view.detector), self._source)

    @property
    def _source(self) -> FloatArray | None:
        return None if self.view.source is None else np.asarray(self.view.source, dtype=np.float64)

    def _traced(
        self, rays: Lattice, source: FloatArray | None, each: Each | None = None
    ) -> FloatArray:
        from phantom.tracing import raster

        found = raster(self.phantom, each=each, **self._asked(rays, source))
        self._done += rays.rows
        return found

    def _asked(self, rays: Lattice, source: FloatArray | None) -> dict[str, Any]:
        """Return what a raster is told of one image of rays."""
        told, before = self.progress, self._done

        def counted(done: int, _: int) -> None:
            assert told is not None
            told(before + done, self._total)

        along = self.view.direction
        return {
            "source": source,
            "direction": None if along is None else np.asarray(along, dtype=np.float64),
            "first_pixel": rays.first_pixel,
            "column_step": rays.column_step,
            "row_step": rays.row_step,
            "columns": rays.columns,
            "rows": rays.rows,
            "workers": self.workers,
            "cancelled": self.cancelled,
            "progress": None if told is None else counted,
        }
