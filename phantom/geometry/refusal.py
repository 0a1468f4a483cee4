"""How the mathematics says no: one problem, its place below the solid, and the figure."""

from __future__ import annotations

from phantom.errors import PhantomError, Problem


class RefusalError(PhantomError):
    """A shape is not a solid; ``problem.path`` is relative to the solid's own path."""

    def __init__(self, path: str, kind: str, message: str) -> None:
        self.problem = Problem(path, kind, message)
        super().__init__(str(self.problem))
