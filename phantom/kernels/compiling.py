"""The one way kernels are compiled: cached, without the lock, without fast-math.

Numba's cache looks at the file of the kernel itself, not at those of the kernels it calls. So all
of them are kept in one folder named after all of their sources: a change anywhere starts afresh.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import pkgutil
import platform
import shutil
import stat
import tempfile
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numpy as np

from phantom.kernels.registers import LoopCompiler, WideCompiler

Kernel = TypeVar("Kernel", bound=Callable[..., object])


_INNER: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "_nrt": False}
"""Functions for kernels alone. They make no arrays, so nothing in them counts references: scenes of
forty arrays are handed on, and counting each time would cost a tenth of an image's time."""


@cache
def cache_folder() -> str:
    """Return the folder of compiled kernels, made if need be.

    It lies in ``NUMBA_CACHE_DIR`` where that is set, else in the user's cache folder, else, where
    there is no home to write to, in a folder of the user's own under the system's temporary one.
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
    return _shared_temporary(name)


def _shared_temporary(name: str) -> str:
    """Return a folder of this user alone under the system's temporary one.

    Compiled kernels are run as they are found: a folder that anybody else could have written to,
    or a link, is never used; then one is made for this process and removed with it.
    """
    user = os.getuid() if hasattr(os, "getuid") else 0
    root = Path(tempfile.gettempdir()) / f"phantom-xray-{user}"
    try:
        root.mkdir(mode=0o700, exist_ok=True)
        found = root.lstat()
        private = stat.S_ISDIR(found.st_mode) and not found.st_mode & 0o077
        if private and found.st_uid == user:
            (root / name).mkdir(exist_ok=True)
            return str(root / name)
    except OSError:
        pass
    folder = tempfile.mkdtemp(prefix="phantom-xray-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def kernel(function: Kernel) -> Kernel:
    """Compile a function on first call; division by zero gives inf or nan, as in numpy."""
    return _compiled(function)


def inner(function: Kernel) -> Kernel:
    """Compile a function that only kernels call, not Python; it must not make arrays."""
    return _compiled(function, **_INNER)


def lane(function: Kernel) -> Kernel:
    """Compile a function that is laid into the loops that call it, so that they can be packed."""
    return _compiled(function, fastmath={"contract"}, forceinline=True, **_INNER)


def lane_loop(function: Kernel) -> Kernel:
    """Compile a loop over lanes; no array it is given may be a part of another.

    A product and a sum may be rounded once instead of twice; nothing else is loosened.
    """
    return _compiled(function, LoopCompiler, fastmath={"contract"}, **_INNER)


def whole(value: int) -> int:
    """Return a whole number whose value is not part of its type.

    Numba takes a literal for a type of its own and would compile what is called with a variable
    that begins as one a second time.
    """
    return np.int64(value)  # type: ignore[return-value]


def _compiled(
    function: Kernel, compiler: type[WideCompiler] = WideCompiler, **options: Any
) -> Kernel:
    settings: Any = numba.config
    before = settings.CACHE_DIR
    # The place is read while the function is decorated; other users of numba keep theirs.
    settings.CACHE_DIR = cache_folder()
    try:
        compiled = numba.njit(
            nogil=True, cache=True, error_model="numpy", pipeline_class=compiler, **options
        )(function)
    finally:
        settings.CACHE_DIR = before
    return cast(Kernel, compiled)


whole = lane(whole)


LIGHT = ("first_hit", "normals", "phong", "zbuffer")
"""Modules whose kernels only pictures in visible light need."""


def _marker(light: bool) -> Path:
    """Return the file that says that the kernels are compiled for this processor and numba."""
    codegen: Any = import_module("numba.core.codegen")
    target = (platform.machine(), codegen.get_host_cpu_features())
    versions = (numba.__version__, platform.python_version())
    digest = hashlib.sha256(repr((target, versions)).encode()).hexdigest()
    return Path(cache_folder()) / f"{'complete' if light else 'rays'}-{digest[:16]}"


def complete(light: bool = True) -> bool:
    """Tell whether every kernel was compiled before, so that it only has to be loaded.

    Without ``light`` those for visible light do not count.
    """
    return _marker(True).exists() or (not light and _marker(False).exists())


def mark_complete(light: bool = True) -> None:
    """Note that every kernel is compiled, or all but those for visible light."""
    _marker(light).touch()


def compiled_so_far(light: bool = True) -> tuple[int, int]:
    """Return how many kernels lie compiled on disk, and how many of them there are to be."""
    kernels = 0
    for module in pkgutil.iter_modules([str(Path(__file__).parent)]):
        if not light and module.name in LIGHT:
            continue
        found = import_module(f"{__package__}.{module.name}")
        kernels += sum(
            hasattr(member, "py_func") and member.__module__ == found.__name__
            for member in vars(found).values()
        )
    python = "".join(platform.python_version_tuple()[:2])
    on_disk = sum(1 for _ in Path(cache_folder()).rglob(f"*.py{python}.nbi"))
    return min(on_disk, kernels), kernels
