"""Jobs: sets that the service makes, one after the other, and that outlive a restart.

What is asked for stands in one SQLite file, the images in a folder a job. A key that a caller gives
a job makes it one job, however often it is posted: the key is unique in the file.
"""

from __future__ import annotations

import errno
import hashlib
import json
import logging
import os
import secrets
import shutil
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final

from api.job import ACTIVE, OVER, TABLE, Job, job_of
from api.problems import RefusedError
from phantom.datasets import Run, make
from phantom.datasets.checks import check, expected_bytes
from phantom.datasets.ledger import Counts, DiskFullError, HaltedError
from phantom.datasets.opening import of_tree
from phantom.errors import CancelledError, InvalidInputError, Problem
from phantom.requests.limits import Limits

logger = logging.getLogger("phantom.api")

LOOK_S: Final = 1.0
ROOM_S: Final = 5.0
"""How long a job without room waits before it is tried again."""


class Jobs:
    """The jobs of a service, and the thread that works at them.

    Parameters
    ----------
    folder
        Where they are kept.
    ttl_hours
        How long a job is kept after it has ended.
    max_bytes, max_images
        Most that all jobs may take, and most images of one.
    workers
        Processes that make images.
    limits
        Of one image.
    """

    def __init__(
        self,
        folder: Path,
        *,
        ttl_hours: float,
        max_bytes: int,
        max_images: int,
        workers: int,
        limits: Limits,
    ) -> None:
        self.folder = folder
        self._ttl_s, self._max_bytes = ttl_hours * 3600, max_bytes
        self._max_images = max_images
        self._workers, self._limits = workers, limits
        self._wake, self._leaving = threading.Event(), threading.Event()
        self._stop: dict[str, threading.Event] = {}
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Go on with what is not finished."""
        if self._path.exists():
            self._begin_thread()

    def stop(self) -> None:
        """Leave what is not finished for the next start."""
        self._leaving.set()
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
        self._thread = None
        self._leaving.clear()

    def submit(self, tree: object, key: str | None) -> tuple[Job, bool]:
        """Return the job of a design, and whether it is new.

        Raises
        ------
        InvalidInputError
            The design cannot be made.
        RefusedError
            422 for a key that another body has; 507 where there is no room.
        """
        canonical = json.dumps(tree, sort_keys=True, separators=(",", ":"))
        body = hashlib.sha256(canonical.encode("utf-8", "surrogatepass")).hexdigest()
        if key is not None and (known := self._of_key(key)) is not None:
            return self._same(known, body), False
        design = of_tree(tree)
        if design.images > self._max_images:
            message = f"found {design.images} images; expected {self._max_images} at most"
            raise InvalidInputError([Problem("/people", "too_large", message)])
        needed = expected_bytes(design, check(design, self._limits))
        self._check_room(needed)
        job = Job(
            id=secrets.token_hex(16),
            key=key,
            body=body,
            design=json.dumps(design.tree()),
            state="queued",
            images=design.images,
            done=0,
            aside=0,
            bytes=needed,
            created=time.time(),
            begun=None,
            first=0,
            ended=None,
            problem=None,
        )
        columns = Job.__slots__
        marks = ", ".join("?" * len(columns))
        with self._file() as file:
            added = file.execute(
                f"INSERT INTO job ({', '.join(columns)}) VALUES ({marks}) ON CONFLICT DO NOTHING",
                [getattr(job, name) for name in columns],
            ).rowcount
        if not added:  # another call with the same key was faster
            assert key is not None
            known = self._of_key(key)
            assert known is not None
            return self._same(known, body), False
        self._begin_thread()
        self._wake.set()
        return job, True

    def get(self, number: str) -> Job:
        """Return a job.

        Raises
        ------
        RefusedError
            404 where there is none.
        """
        with self._file() as file:
            row = file.execute("SELECT * FROM job WHERE id = ?", (number,)).fetchone()
        if row is None:
            raise RefusedError(HTTPStatus.NOT_FOUND, "no such job")
        return job_of(row)

    def all(self) -> list[Job]:
        """Return every job, the newest first."""
        with self._file() as file:
            rows = file.execute("SELECT * FROM job ORDER BY created DESC, id").fetchall()
        return [job_of(row) for row in rows]

    def cancel(self, number: str) -> Job:
        """Stop a job that is not over, and forget one that is; return what it was."""
        job = self.get(number)
        if job.state in OVER:
            with self._file() as file:
                file.execute("DELETE FROM job WHERE id = ? AND state = ?", (job.id, job.state))
            shutil.rmtree(self.results(job), ignore_errors=True)
            return job
        self._set(job.id, state="cancelled", ended=time.time())
        if job.id in self._stop:
            self._stop[job.id].set()
        self._wake.set()
        return self.get(number)

    def results(self, job: Job) -> Path:
        """Return the folder of a job's set."""
        return self.folder / job.id

    @property
    def _path(self) -> Path:
        return self.folder / "jobs.sqlite"

    @contextmanager
    def _file(self) -> Iterator[sqlite3.Connection]:
        """Give the file of jobs, in one transaction."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            file = sqlite3.connect(self._path, timeout=30.0, isolation_level=None)
        except OSError as error:
            raise _no_room(error) from error
        try:
            file.row_factory = sqlite3.Row
            file.execute("PRAGMA journal_mode=WAL")
            file.execute("PRAGMA synchronous=FULL")
            file.execute(TABLE)
            file.execute("BEGIN IMMEDIATE")
            yield file
            file.execute("COMMIT")
        except sqlite3.OperationalError as error:
            raise _no_room(error) from error
        finally:
            file.close()

    def _of_key(self, key: str) -> Job | None:
        with self._file() as file:
            row = file.execute("SELECT * FROM job WHERE key = ?", (key,)).fetchone()
        return None if row is None else job_of(row)

    def _same(self, known: Job, body: str) -> Job:
        if known.body != body:
            detail = "the Idempotency-Key was given with another body; expected a new key"
            raise RefusedError(HTTPStatus.UNPROCESSABLE_ENTITY, detail)
        return known

    def _set(self, number: str, **values: object) -> None:
        """Change a job, unless it was cancelled."""
        names = ", ".join(f"{name} = ?" for name in values)
        with self._file() as file:
            file.execute(
                f"UPDATE job SET {names} WHERE id = ? AND state != 'cancelled'",
                [*values.values(), number],
            )

    def _check_room(self, needed: int) -> None:
        """Refuse a set for which there is no room beside the others."""
        self._forget_old()
        asked = sum(job.bytes for job in self.all())
        if asked + needed > self._max_bytes:
            detail = (
                f"the set takes about {needed} bytes, and the sets that are kept {asked}"
                f" of {self._max_bytes}; delete some of them"
            )
            raise RefusedError(HTTPStatus.INSUFFICIENT_STORAGE, detail)
        free = shutil.disk_usage(self.folder).free
        if needed > free:
            detail = f"the set takes about {needed} bytes; {free} are free"
            raise RefusedError(HTTPStatus.INSUFFICIENT_STORAGE, detail)

    def _forget_old(self) -> None:
        for job in self.all():
            if job.ended is not None and time.time() - job.ended > self._ttl_s:
                self.cancel(job.id)

    def _begin_thread(self) -> None:
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(target=self._work, name="jobs", daemon=True)
            self._thread.start()

    def _work(self) -> None:
        """Make one set after the other until the service stops."""
        while not self._leaving.is_set():
            try:
                waiting = [job for job in reversed(self.all()) if job.state in ACTIVE]
                if waiting:
                    self._make(waiting[0])
                    continue
                self._forget_old()
            except Exception:  # the file of jobs itself has no room, say
                logger.exception("the jobs stand still")
            self._wake.wait(60.0 if not self._leaving.is_set() else 0.0)
            self._wake.clear()

    def _make(self, job: Job) -> None:
        """Make the set of a job, or go on with it."""
        stop = self._stop.setdefault(job.id, threading.Event())
        if self.get(job.id).state == "cancelled":
            return
        told = [0.0]

        def progress(counts: Counts) -> None:
            now = time.monotonic()
            if told[0] == 0.0:
                self._set(job.id, state="running", begun=time.time(), first=counts.done)
            if now - told[0] >= LOOK_S or counts.done + counts.aside == counts.total:
                told[0] = now
                self._set(job.id, done=counts.done, aside=counts.aside)

        def stopped() -> bool:
            return stop.is_set() or self._leaving.is_set()

        try:
            design = of_tree(json.loads(job.design))
            made = make(
                design,
                self.results(job),
                Run(workers=self._workers),
                limits=self._limits,
                progress=progress,
                cancelled=stopped,
            )
        except CancelledError:
            return
        except DiskFullError as error:
            self._wait_for_room(job, str(error), stop)
        except HaltedError as error:
            logger.warning("job %s: %s", job.id, error)
            self._set(job.id, state="failed", problem=str(error), ended=time.time())
        except InvalidInputError as error:
            if any(problem.kind == "disk_too_small" for problem in error.problems):
                self._wait_for_room(job, str(error), stop)
            else:
                self._set(job.id, state="failed", problem=str(error), ended=time.time())
        except Exception:
            logger.exception("job %s failed", job.id)
            problem = "a fault of ours; it has been logged"
            self._set(job.id, state="failed", problem=problem, ended=time.time())
        else:
            self._ended(job, made)
        finally:
            if not self._leaving.is_set():
                self._stop.pop(job.id, None)

    def _ended(self, job: Job, made: Any) -> None:
        self._set(
            job.id,
            state="done",
            done=made.images,
            aside=len(made.aside),
            bytes=made.bytes,
            ended=time.time(),
            problem=None,
        )

    def _wait_for_room(self, job: Job, problem: str, stop: threading.Event) -> None:
        """Leave a job for a while; what is finished of it is kept."""
        logger.warning("job %s has no room: %s", job.id, problem)
        with suppress(RefusedError):  # not even room for this
            self._set(job.id, state="out_of_space", problem=problem)
        until = time.monotonic() + ROOM_S
        while time.monotonic() < until and not stop.is_set() and not self._leaving.is_set():
            self._wake.wait(0.2)


def _no_room(error: Exception) -> Exception:
    """Return 507 for a fault of a drive without room, else the fault itself."""
    full = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
    if full or getattr(error, "sqlite_errorcode", 0) & 0xFF in (
        sqlite3.SQLITE_FULL,
        sqlite3.SQLITE_IOERR,
    ):
        return RefusedError(HTTPStatus.INSUFFICIENT_STORAGE, "no room is left for jobs")
    return error


def default_folder() -> Path:
    """Return where jobs are kept unless the operator says: with the user's other states."""
    home = os.environ.get("XDG_STATE_HOME")
    root = Path(home) if home else Path("~/.local/state").expanduser()
    return root / "phantom-xray" / "jobs"
