"""What can be wrong with an input, said the same way on every face."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing wrong with an input.

    Attributes
    ----------
    path
        JSON pointer (RFC 6901) of the field as the user wrote it; ``""`` is the whole input.
    kind
        A short stable word for programs, such as ``missing`` or ``not_finite``.
    message
        What was found and what was expected, in one sentence.
    """

    path: str
    kind: str
    message: str

    def __str__(self) -> str:
        """Read as ``path: message``."""
        return f"{self.path or '(document)'}: {self.message}"


class PhantomError(Exception):
    """Root of every error this package raises on purpose."""


class InvalidInputError(PhantomError):
    """An input was refused; every problem found is listed, none was acted on."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[InvalidInputError], tuple[tuple[Problem, ...]]]:
        """Travel to another process with the problems, and not as their text."""
        return type(self), (self.problems,)


class InvalidDocumentError(InvalidInputError):
    """A phantom document was refused; paths are those of the document."""


class UnknownPhantomError(InvalidInputError):
    """The library holds no phantom of that name."""


class CancelledError(PhantomError):
    """The caller asked for a running trace to stop; nothing was returned."""


def pointer(parts: Iterable[str | int]) -> str:
    """Join field names and indices into a JSON pointer, escaping ``~`` and ``/`` (RFC 6901)."""
    return "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in parts)


def prefixed(prefix: str, problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return the problems with ``prefix`` put before every path."""
    return tuple(Problem(prefix + p.path, p.kind, p.message) for p in problems)
