"""Having the engine ready before it is needed."""

from __future__ import annotations

import threading

from phantom.cli.console import say

COMPILING_S = 3.0
"""Loading compiled kernels takes a second; what takes longer than this is compiling them."""


def ready() -> None:
    """Compile the kernels where that has not been done on this machine yet, and say so."""
    from phantom.tracing import warm

    notice = threading.Timer(COMPILING_S, say, ("compiling kernels, once",))
    notice.daemon = True
    notice.start()
    try:
        warm()
    finally:
        notice.cancel()
