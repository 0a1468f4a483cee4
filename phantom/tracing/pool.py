"""Bands of work on the library's own threads; kernels release the lock while they run."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from threading import Lock, Thread
from typing import TYPE_CHECKING

from phantom.errors import CancelledError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from phantom.compiled.layout import Scene
    from phantom.scene import Phantom

    Floats = NDArray[np.float64]


def default_workers() -> int:
    """Return the number of processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_bands(
    work: Callable[[int, int], None],
    bands: Sequence[tuple[int, int]],
    *,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Run ``work(start, end)`` for every band; what each writes must not depend on the order.

    Parameters
    ----------
    work
        Does one band; it runs on several threads at once, the caller's among them.
    bands
        Half-open ranges.
    workers
        Threads, by default one a processor.
    cancelled
        Asked between bands; once it says yes nothing new is started.
    progress
        Told now and then, on the caller's thread, how many of how many units are done; last, all.

    Raises
    ------
    CancelledError
        Where ``cancelled`` said yes before the last band was started.
    """
    shift = _Shift(work, bands)
    count = max(1, min(workers or default_workers(), len(bands)))
    threads = [Thread(target=shift.labour, name=f"phantom-{k}") for k in range(1, count)]
    total, told = sum(end - start for start, end in bands), 0
    try:
        for thread in threads:
            thread.start()
        # The caller's own thread works too.
        while not shift.over():
            if cancelled is not None and cancelled():
                raise CancelledError("the trace was cancelled")
            shift.one()
            if progress is not None:
                told = shift.done
                progress(told, total)
    finally:
        shift.stop()
        for thread in threads:
            if thread.ident is not None:
                thread.join()
    if shift.error is not None:
        raise shift.error
    if progress is not None and told < total:
        progress(total, total)


class _Shift:
    """Bands that threads take one after the other."""

    def __init__(self, work: Callable[[int, int], None], bands: Sequence[tuple[int, int]]) -> None:
        self._work, self._bands = work, bands
        self._next, self._lock = 0, Lock()
        self.done = 0
        self.error: BaseException | None = None

    def over(self) -> bool:
        """Tell whether nothing is left to begin."""
        return self._next >= len(self._bands)

    def stop(self) -> None:
        """Begin nothing new."""
        with self._lock:
            self._next = len(self._bands)

    def one(self) -> None:
        """Do the next band, if there is one; what goes wrong stops all."""
        with self._lock:
            if self.over():
                return
            start, end = self._bands[self._next]
            self._next += 1
        try:
            self._work(start, end)
        except BaseException as error:
            with self._lock:
                self.error = self.error or error
            self.stop()
            return
        with self._lock:
            self.done += end - start

    def labour(self) -> None:
        """Do bands until nothing is left."""
        while not self.over():
            self.one()


def cut_bands(total: int, size: int) -> list[tuple[int, int]]:
    """Cut ``range(total)`` into half-open bands of at most ``size``."""
    return [(start, min(start + size, total)) for start in range(0, total, size)]


def warm(light: bool = True) -> None:
    """Compile every kernel, or load it from the cache: one small trace of each kind.

    Without ``light`` those are left out that only pictures in visible light need.
    """
    import numpy as np

    from phantom.kernels.beer import add_material
    from phantom.kernels.compiling import mark_complete
    from phantom.scene import load
    from phantom.tracing.points import materials_at
    from phantom.tracing.raster import raster
    from phantom.tracing.rays import intervals, path_lengths

    phantom = load(
        {
            "format": "phantom/1",
            "name": "warm",
            "materials": {"m": {"attenuation_per_mm": 1.0}},
            "solid": {"type": "sphere", "center": [0, 0, 0], "radius": 1.0, "material": "m"},
        }
    )
    raster(
        phantom,
        source=np.array([0.0, 0.0, -9.0]),
        direction=None,
        first_pixel=np.array([0.0, 0.0, 9.0]),
        column_step=np.array([1.0, 0.0, 0.0]),
        row_step=np.array([0.0, 1.0, 0.0]),
        columns=1,
        rows=1,
    )
    origin, along = np.array([[0.0, 0.0, -9.0]]), np.array([[0.0, 0.0, 1.0]])
    intervals(phantom, origin, along)
    path_lengths(phantom, origin, along)
    materials_at(phantom, origin)
    for lengths in (np.zeros(1), np.broadcast_to(0.0, 1)):  # to be written to, and not
        add_material(np.ascontiguousarray(lengths), 1.0, True, np.empty(1))
    if light:
        _warm_light(phantom, origin, along)
    mark_complete(light)


def _warm_light(phantom: Phantom, origin: Floats, along: Floats) -> None:
    """Compile the kernels for visible light: one ray, one pixel."""
    import numpy as np

    from phantom.tracing.seen import first_hits
    from phantom.tracing.shading import shaded

    first_hits(phantom, origin, along)
    view = np.array([[0, 0, -9], [0, 0, 0], [0, 0, 0], [0, 0, 18], [0, 1, 0], [1, 0, 0]], float)
    lights = np.array([[0.0, 0.0, -1.0, 0.0]]), np.ones((1, 3))
    look, shown = np.full((1, 7), 0.25), np.ones(1, dtype=np.uint8)
    shaded(phantom, view, 1, 1, 1, shown, look, np.ones(3), lights, shadows=True)
    _warm_meshes(phantom.compiled.scene, view, look, lights)


def _warm_meshes(scene: Scene, view: Floats, look: Floats, lights: tuple[Floats, Floats]) -> None:
    """Compile the kernels for meshes: one triangle on one pixel."""
    import numpy as np

    from phantom.kernels import phong, zbuffer

    corners = np.array([[[-1.0, -1, 9], [1, -1, 9], [0, 1, 9]]])
    whole = np.array([[0, 1, 0, 1]], dtype=np.int64)
    heads, links, owners = (np.empty(s, dtype=np.int64) for s in ((1, 1), 4, 4))
    lists = (heads, links, np.empty(4), owners)
    zbuffer.crossings(corners, whole, view, 0, *lists)
    found, hits = np.empty((1, 1)), np.zeros((1, 1, 4), dtype=np.int64)
    triangles, normals = np.zeros((1, 1), dtype=np.int64), np.empty((1, 1, 3))
    shown, leaf = np.ones(1, dtype=np.uint8), np.zeros(1, dtype=np.int64)
    zbuffer.resolve(scene, shown, leaf, 1e-9, *lists, found, hits, triangles)
    zbuffer.facets(corners, corners, view, 0, found, triangles, normals)
    rgb, coverage = np.zeros((1, 1, 3)), np.zeros((1, 1))
    phong.shade_facets(view, 0, found, hits, normals, look, np.ones(3), *lights, 1, rgb, coverage)
