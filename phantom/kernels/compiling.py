"""The one way kernels are compiled: cached, without the lock, without fast-math.

Numba's cache looks at the file of the kernel itself, not at those of the kernels it calls. So all
of them are kept in one folder named after all of their sources: a change anywhere starts afresh.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., object])


@cache
def cache_folder() -> str:
    """Return the folder of compiled kernels, made if need be.

    It lies in ``NUMBA_CACHE_DIR`` where that is set, else in the user's cache folder, else, where
    there is no home to write to, in a private folder of the system's temporary one.
    """
    here = Path(__file__).parent
    digest = hashlib.sha256()
    for source in [*sorted(here.glob("*.py")), here.parent / "compiled" / "layout.py"]:
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    homes = [os.environ.get("NUMBA_CACHE_DIR"), os.environ.get("XDG_CACHE_HOME")]
    roots = [Path(home) / "phantom-xray" for home in homes if home]
    roots.append(Path("~/.cache/phantom-xray"))
    for root in roots:
        try:
            folder = root.expanduser() / name
            folder.mkdir(parents=True, exist_ok=True)
        except (OSError, RuntimeError):
            continue
        if os.access(folder, os.W_OK):
            return str(folder)
    return tempfile.mkdtemp(prefix="phantom-xray-")


def kernel(function: Kernel) -> Kernel:
    """Compile a function on first call; division by zero gives inf or nan, as in numpy."""
    settings: Any = numba.config
    before = settings.CACHE_DIR
    # The place is read while the function is decorated; other users of numba keep theirs.
    settings.CACHE_DIR = cache_folder()
    try:
        compiled = numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    finally:
        settings.CACHE_DIR = before
    return cast(Kernel, compiled)


def is_compiled() -> bool:
    """Say whether some kernels are already in the cache, so that the first call will be quick."""
    return any(Path(cache_folder()).rglob("*.nbi"))
