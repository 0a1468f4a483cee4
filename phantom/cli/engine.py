"""Having the engine ready before it is needed."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module

from phantom.cli.console import Bar, say

LOOKING_S = 0.5
_BLAS = "scipy.linalg.cython_blas"


def ready(*, quiet: bool = False, load: bool = False, light: bool = False) -> None:
    """Compile the kernels where that has not been done on this machine yet, and say so.

    Parameters
    ----------
    quiet
        Compile without a word.
    load
        Have kernels that were compiled before loaded too, as a service wants them; a command loads
        those that it uses.
    light
        Have those for visible light too.
    """
    _import_numba()
    from phantom.kernels.compiling import complete
    from phantom.tracing import warm

    if complete(light):
        if load:
            warm(light)
        return
    if quiet:
        warm(light)
        return
    say("compiling kernels, once")
    with _progress(light):
        warm(light)


@contextmanager
def _progress(light: bool) -> Iterator[None]:
    """Show how many kernels are compiled, on a terminal."""
    from phantom.kernels.compiling import compiled_so_far

    done = threading.Event()

    def look(bar: Bar) -> None:
        while not done.wait(LOOKING_S):
            bar(*compiled_so_far(light))

    with Bar("compiling") as bar:
        watcher = threading.Thread(target=look, args=(bar,), daemon=True)
        watcher.start()
        try:
            yield
        finally:
            done.set()
            watcher.join()


def _import_numba() -> None:
    """Import numba without scipy's linear algebra, which no kernel uses: 0.3 s less.

    Numba asks for it when it first compiles or loads a kernel, and does without where it is not
    there. In a library that would take matrix products from other people's kernels; a process of
    the command line has none.
    """
    absent = _BLAS not in sys.modules
    if absent:
        sys.modules[_BLAS] = None  # type: ignore[assignment]
    try:
        with suppress(ImportError):
            import_module("numba.np.arraymath")
    finally:
        if absent:
            del sys.modules[_BLAS]
