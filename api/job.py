"""One job as the service keeps it: the columns of a row, and what follows from them."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

ACTIVE: Final = ("queued", "running", "out_of_space")
OVER: Final = ("done", "failed", "cancelled")

TABLE: Final = """
CREATE TABLE IF NOT EXISTS job (
    id TEXT PRIMARY KEY,
    key TEXT UNIQUE,
    body TEXT NOT NULL,
    design TEXT NOT NULL,
    state TEXT NOT NULL,
    images INTEGER NOT NULL,
    done INTEGER NOT NULL DEFAULT 0,
    aside INTEGER NOT NULL DEFAULT 0,
    bytes INTEGER NOT NULL,
    created REAL NOT NULL,
    begun REAL,
    first INTEGER NOT NULL DEFAULT 0,
    ended REAL,
    problem TEXT
)
"""


@dataclass(frozen=True, slots=True)
class Job:
    """What is known of a job; its fields are the columns of the file."""

    id: str
    key: str | None
    body: str
    design: str
    state: str
    images: int
    done: int
    aside: int
    bytes: int
    created: float
    begun: float | None
    first: int
    ended: float | None
    problem: str | None

    @property
    def images_per_s(self) -> float | None:
        """How fast it goes; None where nothing can be said yet."""
        if self.begun is None or self.done <= self.first:
            return None
        until = self.ended if self.ended is not None else time.time()
        return (self.done - self.first) / max(until - self.begun, 1e-3)

    @property
    def seconds_left(self) -> float | None:
        """How long it will take yet; None where nothing can be said."""
        rate = self.images_per_s
        if rate is None or self.state != "running":
            return None
        return (self.images - self.done - self.aside) / rate


def job_of(row: Mapping[str, Any]) -> Job:
    """Return the job that a row of the file is."""
    return Job(**{name: row[name] for name in Job.__slots__})
