"""Long work off the event loop: a few at a time, stopped when its client goes away."""

from __future__ import annotations

import threading
from collections.abc import Callable
from http import HTTPStatus
from typing import TypeVar

from anyio import CapacityLimiter, create_task_group, get_cancelled_exc_class
from anyio.to_thread import run_sync
from fastapi import Request

from api.problems import RefusedError

T = TypeVar("T")


class Workshop:
    """Runs the calls that trace, so many at the same time and so many waiting."""

    def __init__(self, renders: int, queue: int) -> None:
        self._limiter = CapacityLimiter(renders)
        self._queue = queue

    async def run(self, request: Request, job: Callable[[Callable[[], bool]], T]) -> T:
        """Return what ``job`` returns; ``job`` is handed a test that says when to stop.

        The request's body must have been read. From then on the only message the server still has
        for us is that the client went away, and that is what is waited for beside the work.

        Raises
        ------
        RefusedError
            429 where too many calls are waiting.
        """
        if self._limiter.statistics().tasks_waiting >= self._queue and not self._free():
            raise RefusedError(
                HTTPStatus.TOO_MANY_REQUESTS, "too many calls are waiting", {"Retry-After": "5"}
            )
        gone = threading.Event()
        outcome: list[T] = []
        failure: list[Exception] = []

        async def watch() -> None:
            while (await request.receive())["type"] != "http.disconnect":
                pass
            gone.set()

        async with create_task_group() as group:
            group.start_soon(watch)
            try:
                outcome.append(await run_sync(job, gone.is_set, limiter=self._limiter))
            except get_cancelled_exc_class():
                gone.set()
                raise
            except Exception as error:  # kept out of the task group, which would wrap it
                failure.append(error)
            group.cancel_scope.cancel()
        if failure:
            raise failure[0]
        return outcome[0]

    def _free(self) -> bool:
        return self._limiter.available_tokens >= 1
