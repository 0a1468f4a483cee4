"""How the command line talks: answers to stdout, all else to stderr, and the exit status."""

from __future__ import annotations

import json
import sys
import time
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

    from phantom.errors import Problem

BAD_INPUT = 2
OUR_FAULT = 1
PATIENCE_S = 1.0
"""What takes longer than this gets a progress bar."""


def say(text: str) -> None:
    """Tell the person something that is not part of the answer."""
    print(_printable(text), file=sys.stderr, flush=True)


def answer(content: object) -> None:
    """Print the answer, as JSON where it is not text already."""
    print(content if isinstance(content, str) else json.dumps(content, indent=2))


def _printable(text: str) -> str:
    """Return the text with what the terminal's encoding lacks, or would obey, escaped."""
    safe = "".join(c if c.isprintable() or c == "\n" else repr(c)[1:-1] for c in text)
    encoding = sys.stderr.encoding or "utf-8"
    return safe.encode(encoding, "backslashreplace").decode(encoding)


def refuse(problems: Iterable[Problem], *, as_json: bool) -> typer.Exit:
    """Print the problems, one a line or as HTTP lists them, and return how to leave."""
    listed = list(problems)
    if as_json:
        content = [{"path": p.path, "kind": p.kind, "message": p.message} for p in listed]
        print(json.dumps({"problems": content}, indent=2), file=sys.stderr)
    else:
        for problem in listed:
            say(str(problem))
    return typer.Exit(BAD_INPUT)


@contextmanager
def reporting(*, as_json: bool) -> Iterator[None]:
    """Turn what goes wrong inside into messages and an exit status: 2 bad input, 1 our fault."""
    from phantom.errors import InvalidInputError

    try:
        yield
    except InvalidInputError as error:
        raise refuse(error.problems, as_json=as_json) from None
    except (typer.Exit, KeyboardInterrupt, BrokenPipeError):
        raise
    except Exception:
        traceback.print_exc()
        say("a fault of ours; the lines above say where")
        raise typer.Exit(OUR_FAULT) from None


class Bar:
    """A progress bar on stderr that appears after a second, and only on a terminal."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._begun = time.monotonic()
        self._shown: tuple[Progress, TaskID] | None = None

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown is not None:
            self._shown[0].stop()

    def __call__(self, done: int, total: int) -> None:
        """Note that ``done`` of ``total`` steps are behind us."""
        if self._shown is None:
            if not sys.stderr.isatty() or time.monotonic() - self._begun < PATIENCE_S:
                return
            self._shown = self._show(total)
        progress, task = self._shown
        progress.update(task, completed=done)

    def _show(self, total: int) -> tuple[Progress, TaskID]:
        from rich.console import Console
        from rich.progress import Progress

        progress = Progress(console=Console(stderr=True), transient=True)
        progress.start()
        return progress, progress.add_task(self._title, total=total)
