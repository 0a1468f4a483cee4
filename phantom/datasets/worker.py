"""A worker: a process that claims units, makes them, and ends when its supervisor does.

``python -m phantom.datasets.worker`` reads one line of JSON, the job, and tells one line of JSON a
step: ``ready``, ``begin`` and ``done`` of an image, ``failed``, ``halted`` and ``refused``. Its
input stays open for as long as the supervisor lives; where it ends, the worker does, at once.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from dataclasses import asdict
from typing import IO, Any

from phantom.datasets.ledger import DiskFullError, HaltedError, Ledger, room
from phantom.datasets.making import Maker
from phantom.datasets.opening import of_tree
from phantom.datasets.places import units
from phantom.datasets.storage import check_shared, storage
from phantom.datasets.units import make_image, make_shard, worded
from phantom.errors import CancelledError, InvalidInputError


def main() -> None:
    """Do the job that stands on the standard input."""
    told = os.fdopen(os.dup(1), "w", buffering=1, encoding="utf-8")
    os.dup2(2, 1)  # whatever a library prints is no step
    job = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_supervisor, daemon=True).start()
    Work(job, told).run()


def _end_with_supervisor() -> None:
    while os.read(0, 4096):
        pass
    os._exit(0)


class Work:
    """The job of one worker."""

    def __init__(self, job: dict[str, Any], told: IO[str]) -> None:
        self._told = told
        self._owner: str = job["owner"]
        self._lease_s: float = job["lease_s"]
        self._design = of_tree(job["design"])
        self._where = storage(job["output"], job["part"])
        self._maker = Maker(self._design, job["threads"])
        self._ledger = Ledger(job["ledger"])
        self._units = units(self._design)

    def run(self) -> None:
        """Make units until none is left."""
        self._tell("ready")
        try:
            with room():
                check_shared(self._where)
            while (
                claim := self._ledger.claim(self._owner, time.time(), self._lease_s)
            ) is not None:
                if self._design.sharded:
                    self._shard(claim.unit, claim.images)
                else:
                    for number in claim.images:
                        self._image(number)
        except HaltedError as error:
            self._tell("halted", error=str(error), full=isinstance(error, DiskFullError))
        except InvalidInputError as error:
            self._tell("refused", problems=[asdict(problem) for problem in error.problems])

    def _image(self, number: int) -> None:
        self._begin(number)
        try:
            record = make_image(self._maker, self._where, number)
        except (HaltedError, CancelledError):
            raise
        except Exception as error:
            self._failed(number, error)
        else:
            self._ledger.done(self._owner, [record])
            self._tell("done", image=number)

    def _shard(self, unit: int, images: tuple[int, ...]) -> None:
        own = self._units[unit]
        first = next(u.number for u in self._units if u.split == own.split)
        records = make_shard(
            self._maker, self._where, own, first, images, self._begin, self._failed
        )
        self._ledger.done(self._owner, records)
        for record in records:
            self._tell("done", image=record.number)

    def _begin(self, number: int) -> None:
        self._tell("begin", image=number)

    def _failed(self, number: int, error: Exception) -> bool:
        aside = self._ledger.failed(number, worded(error))
        self._tell("failed", image=number, aside=aside, error=worded(error))
        return aside

    def _tell(self, step: str, **more: object) -> None:
        self._told.write(json.dumps({"step": step, **more}) + "\n")


if __name__ == "__main__":
    main()
