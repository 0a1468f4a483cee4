"""Having the engine ready before it is needed."""

from __future__ import annotations

from phantom.cli.console import say


def ready() -> None:
    """Compile the kernels where that has not been done on this machine yet, and say so."""
    from phantom.tracing import warm

    warm()
