"""The one way kernels are compiled: cached, without the lock, without fast-math."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., object])


def kernel(function: Kernel) -> Kernel:
    """Compile a function on first call; division by zero gives inf or nan, as in numpy."""
    return cast(Kernel, numba.njit(nogil=True, cache=True, error_model="numpy")(function))
