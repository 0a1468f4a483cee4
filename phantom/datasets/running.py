"""Making a set with processes of our own, which are watched.

One process a worker, started afresh where one dies. A dead worker takes no other with it: its
other images are free again, and the one it was making has failed once; after three failures that
image is set aside with its error. Processes are started as programs, never forked.
"""

from __future__ import annotations

import json
import os
import queue
import secrets
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from phantom.datasets.design import Design
from phantom.datasets.ledger import Counts, DiskFullError, HaltedError, Ledger
from phantom.errors import InvalidInputError, PhantomError, Problem
from phantom.tracing import default_workers

LOOK_S: Final = 0.2
"""How often workers are looked at where none says anything."""

LEASE_S: Final = 600.0
"""An image that takes longer has failed, and its worker is stopped."""

STILLBORN: Final = 3
"""Workers that end before they are ready, one after the other, before the run is given up."""


class WorkersLostError(PhantomError):
    """Workers end before they can start; what they said is on the standard error."""


@dataclass(slots=True)
class _Worker:
    """A running worker."""

    owner: str
    process: subprocess.Popen[str]
    image: int | None = None
    since: float = 0.0
    ready: bool = False
    listener: threading.Thread | None = None

    def bury(self) -> None:
        """Let go of what is left of a process that has ended, or is about to."""
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):
            self.process.stdin.close()
        if self.listener is not None:
            self.listener.join()


@dataclass(slots=True)
class Supervisor:
    """Runs the workers of one part of a set until nothing is left.

    Attributes
    ----------
    design, output, part
        What is made, the address it is made at, and the part's name.
    ledger
        That of the part.
    workers
        How many processes; None for one a processor.
    lease_s
        Longest that one image may take.
    """

    design: Design
    output: str
    part: str
    ledger: Ledger
    workers: int | None = None
    lease_s: float = LEASE_S
    _steps: queue.SimpleQueue[tuple[_Worker, dict[str, Any]]] = field(
        default_factory=queue.SimpleQueue, init=False
    )
    _alive: list[_Worker] = field(default_factory=list, init=False)
    _stillborn: int = field(default=0, init=False)

    def run(
        self,
        progress: Callable[[Counts], None] | None = None,
        cancelled: Callable[[], bool] | None = None,
    ) -> bool:
        """Make all that is open; return whether it came to its end, and was not cancelled.

        Raises
        ------
        DiskFullError
            No room is left; what is finished is kept.
        HaltedError
            The set's place cannot be written any more; what is finished is kept.
        InvalidInputError
            Workers do not reach the set's place (``/output``).
        WorkersLostError
            Workers cannot start.
        """
        counts = self.ledger.counts()
        wanted = min(self.workers or default_workers(), max(1, counts.open))
        if progress is not None:
            progress(counts)
        try:
            if counts.open:
                for _ in range(wanted):
                    self._start(wanted)
            while self._alive:
                if cancelled is not None and cancelled():
                    return False
                counts = self._heard(counts, progress)
                self._look(wanted)
        finally:
            self._stop()
        return True

    def _start(self, wanted: int) -> None:
        owner = secrets.token_hex(8)
        process = subprocess.Popen(
            [sys.executable, "-m", "phantom.datasets.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            start_new_session=True,  # a terminal's interrupt is the supervisor's to answer
        )
        worker = _Worker(owner, process, since=time.monotonic())
        assert process.stdin is not None
        job = {
            "owner": owner,
            "design": self.design.tree(),
            "output": self.output,
            "part": self.part,
            "ledger": str(self.ledger.path),
            "lease_s": self.lease_s * max(1, self._largest_unit()),
            "threads": max(1, default_workers() // wanted),
        }
        with suppress(BrokenPipeError):  # it has died already, which is found as with any other
            process.stdin.write(json.dumps(job) + "\n")
            process.stdin.flush()
        worker.listener = threading.Thread(target=self._listen, args=(worker,), daemon=True)
        worker.listener.start()
        self._alive.append(worker)

    def _largest_unit(self) -> int:
        from phantom.datasets.places import units

        return max(len(unit.images) for unit in units(self.design))

    def _listen(self, worker: _Worker) -> None:
        """Pass on what a worker says, and last that it says no more."""
        assert worker.process.stdout is not None
        for line in worker.process.stdout:
            try:
                step = json.loads(line)
            except ValueError:
                continue  # cut off as it died
            self._steps.put((worker, step))
        worker.process.stdout.close()
        worker.process.wait()
        self._steps.put((worker, {"step": "ended"}))

    def _heard(self, counts: Counts, progress: Callable[[Counts], None] | None) -> Counts:
        """Act on the next step that a worker told, if there is one before long."""
        try:
            worker, step = self._steps.get(timeout=LOOK_S)
        except queue.Empty:
            return counts
        kind = step["step"]
        if kind == "ready":
            worker.ready, self._stillborn = True, 0
        elif kind == "begin":
            worker.image, worker.since = step["image"], time.monotonic()
        elif kind in ("done", "failed"):
            worker.image = None
            if kind == "done":
                counts = counts._replace(open=counts.open - 1, done=counts.done + 1)
            elif step["aside"]:
                counts = counts._replace(open=counts.open - 1, aside=counts.aside + 1)
            if progress is not None:
                progress(counts)
        elif kind == "halted":
            raise (DiskFullError if step["full"] else HaltedError)(step["error"])
        elif kind == "refused":
            raise InvalidInputError(Problem(**problem) for problem in step["problems"])
        elif kind == "ended":
            counts = self._buried(worker, counts)
            if progress is not None:
                progress(counts)
        return counts

    def _buried(self, worker: _Worker, counts: Counts) -> Counts:
        """Free what a dead worker had; the image it was making has failed."""
        self._alive.remove(worker)
        worker.bury()
        if worker.image is not None:
            if self.ledger.failed(worker.image, self._death(worker)):
                counts = counts._replace(open=counts.open - 1, aside=counts.aside + 1)
        elif not worker.ready:
            self._stillborn += 1
            if self._stillborn >= STILLBORN:
                raise WorkersLostError(f"{STILLBORN} workers ended before they were ready")
        self.ledger.release(worker.owner)
        return counts

    def _death(self, worker: _Worker) -> str:
        status = worker.process.returncode
        if time.monotonic() - worker.since > self.lease_s:
            return f"it took longer than {self.lease_s:g} s"
        if status < 0:
            return f"its worker was ended by {signal.Signals(-status).name}"
        return f"its worker ended with status {status}"

    def _look(self, wanted: int) -> None:
        """Stop workers that take too long, and replace those that died."""
        for worker in self._alive:
            if worker.image is not None and time.monotonic() - worker.since > self.lease_s:
                worker.process.kill()
        if self._steps.empty() and len(self._alive) < wanted and self.ledger.counts().open:
            self._start(wanted)

    def _stop(self) -> None:
        """End every worker; what they had is free again."""
        for worker in self._alive:
            worker.process.kill()
        for worker in self._alive:
            worker.bury()
            self.ledger.release(worker.owner)
        self._alive.clear()


def lock(path: Path) -> int:
    """Return a descriptor that keeps others from the ledger at ``path`` until it is closed.

    Raises
    ------
    BlockingIOError
        Another run has it.
    """
    descriptor = os.open(f"{path}.lock", os.O_RDWR | os.O_CREAT, 0o644)
    try:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:  # a system without it: two runs at once are the person's to avoid
        pass
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor
