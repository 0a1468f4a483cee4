"""The ledger of a set that is being made: a row an image, in SQLite, on a local disk.

Write-ahead log, ``synchronous=FULL``: what was acknowledged is on disk. A unit (a case's views, or
a shard) is claimed by one UPDATE … RETURNING, so that no two workers ever get the same. A claim is
a lease: when it runs out, the unit is free again.
"""

from __future__ import annotations

import errno
import sqlite3
import zlib
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Final, NamedTuple

from phantom.datasets.places import Unit
from phantom.errors import InvalidInputError, PhantomError, Problem

TRIES: Final = 3
"""Failures of an image before it is set aside."""

BUSY_S: Final = 60.0
"""How long a writer waits for the others."""

_TABLES: Final = """
CREATE TABLE IF NOT EXISTS about (name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS image (
    number INTEGER PRIMARY KEY,
    unit INTEGER NOT NULL,
    state TEXT NOT NULL DEFAULT 'open' CHECK (state IN ('open', 'taken', 'done', 'aside')),
    attempt INTEGER NOT NULL DEFAULT 0,
    owner TEXT,
    lease REAL,
    sha256 TEXT,
    record BLOB,
    error TEXT
);
CREATE INDEX IF NOT EXISTS by_state ON image (state, unit);
CREATE INDEX IF NOT EXISTS by_unit ON image (unit);
"""

_CLAIM: Final = """
UPDATE image SET state = 'taken', owner = :owner, lease = :until
WHERE unit = (
    SELECT unit FROM image
    WHERE state = 'open' OR (state = 'taken' AND lease < :now)
    ORDER BY unit LIMIT 1
) AND (state = 'open' OR (state = 'taken' AND lease < :now))
RETURNING number, unit
"""


_FULL: Final = (
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_IOERR_WRITE,
    sqlite3.SQLITE_IOERR_FSYNC,
    sqlite3.SQLITE_IOERR_SHMSIZE,
)
"""What SQLite says of a drive without room; the log's index is met before the log itself."""


_UNUSABLE: Final = (
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_CORRUPT,
    sqlite3.SQLITE_NOTADB,
)
"""What it says of a file that cannot be a ledger, by the last eight bits."""


class HaltedError(PhantomError):
    """The set or its ledger cannot be read or written; what is finished is kept."""


class DiskFullError(HaltedError):
    """No room is left for the set or its ledger; what is finished is kept."""


class Claim(NamedTuple):
    """What a worker has to make: images of one unit."""

    unit: int
    images: tuple[int, ...]


class Counts(NamedTuple):
    """How many images are in which state."""

    open: int
    taken: int
    done: int
    aside: int

    @property
    def total(self) -> int:
        """All of them."""
        return sum(self)


class Ledger:
    """The ledger of one part of a set.

    Parameters
    ----------
    path
        Of the file; its folder is made if need be.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with room():
            self._file = sqlite3.connect(
                self.path, timeout=BUSY_S, isolation_level=None, check_same_thread=False
            )
            self._file.execute("PRAGMA journal_mode=WAL")
            self._file.execute("PRAGMA synchronous=FULL")

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()

    def open_for(self, digest: str, part: str, units: Iterable[Unit]) -> None:
        """Enter the units of a part of a set, unless that was done before.

        Raises
        ------
        InvalidInputError
            The ledger is of another design, or of another part (``/output``).
        """
        about = {"design": digest, "part": part}
        with self._change() as change:
            for statement in _TABLES.split(";\n"):
                change.execute(statement)
            known = dict(change.execute("SELECT name, value FROM about"))
            if not known:
                change.executemany("INSERT INTO about VALUES (?, ?)", about.items())
                rows = ((n, unit.number) for unit in units for n in unit.images)
                change.executemany("INSERT INTO image (number, unit) VALUES (?, ?)", rows)
            elif known != about:
                word = (
                    "design, or version of this program," if known["design"] != digest else "part"
                )
                message = (
                    f"found the ledger of another {word} at {str(self.path)!r};"
                    " expected an empty place, or the same again"
                )
                raise InvalidInputError([Problem("/output", "other_design", message)])

    def free_all(self) -> None:
        """Open what nobody works at any more, after a run that was killed."""
        with self._change() as change:
            change.execute(
                "UPDATE image SET state = 'open', owner = NULL, lease = NULL WHERE state = 'taken'"
            )

    def claim(self, owner: str, now: float, lease_s: float) -> Claim | None:
        """Take the next open unit; None where there is none."""
        with room():
            rows = self._file.execute(
                _CLAIM, {"owner": owner, "now": now, "until": now + lease_s}
            ).fetchall()
        if not rows:
            return None
        return Claim(rows[0][1], tuple(sorted(number for number, _ in rows)))

    def renew(self, owner: str, until: float) -> None:
        """Put off the end of an owner's lease."""
        with self._change() as change:
            change.execute(
                "UPDATE image SET lease = ? WHERE owner = ? AND state = 'taken'", (until, owner)
            )

    def done(self, owner: str, made: Iterable[tuple[int, str, str]]) -> None:
        """Acknowledge images: (number, hash of the picture's file, record), all at once."""
        rows = [(sha, zlib.compress(text.encode(), 1), n, owner) for n, sha, text in made]
        with self._change() as change:
            change.executemany(
                "UPDATE image SET state = 'done', owner = NULL, lease = NULL, error = NULL,"
                " sha256 = ?, record = ? WHERE number = ? AND owner = ? AND state = 'taken'",
                rows,
            )

    def failed(self, number: int, error: str) -> bool:
        """Note that an image could not be made; return whether it is now set aside."""
        with self._change() as change:
            change.execute(
                "UPDATE image SET attempt = attempt + 1, error = ?, owner = NULL, lease = NULL,"
                " state = CASE WHEN attempt + 1 >= ? THEN 'aside' ELSE 'open' END"
                " WHERE number = ? AND state IN ('taken', 'open')",
                (error, TRIES, number),
            )
            (state,) = change.execute(
                "SELECT state FROM image WHERE number = ?", (number,)
            ).fetchone()
        return bool(state == "aside")

    def release(self, owner: str) -> None:
        """Open what an owner had taken and has not made."""
        with self._change() as change:
            change.execute(
                "UPDATE image SET state = 'open', owner = NULL, lease = NULL"
                " WHERE owner = ? AND state = 'taken'",
                (owner,),
            )

    def reopen(self, unit: int) -> None:
        """Have a unit made again, whose files are not what they were."""
        with self._change() as change:
            change.execute(
                "UPDATE image SET state = 'open', sha256 = NULL, record = NULL"
                " WHERE unit = ? AND state = 'done'",
                (unit,),
            )

    def counts(self) -> Counts:
        """Return how many images are in which state."""
        found = dict(self._file.execute("SELECT state, count(*) FROM image GROUP BY state"))
        return Counts(*(found.get(state, 0) for state in Counts._fields))

    def has_any(self) -> bool:
        """Tell whether anything was made, or set aside; False for a ledger without tables."""
        try:
            counts = self.counts()
        except sqlite3.OperationalError:
            return False
        return bool(counts.done or counts.aside)

    def records(self) -> Iterator[tuple[int, int, str]]:
        """Yield (number, unit, record) of every image that is done, in order."""
        query = "SELECT number, unit, record FROM image WHERE state = 'done' ORDER BY number"
        with closing(self._file.cursor()) as cursor:
            for number, unit, packed in cursor.execute(query):
                yield number, unit, zlib.decompress(packed).decode()

    def aside(self) -> list[tuple[int, str]]:
        """Return (number, error) of every image that is set aside, in order."""
        query = "SELECT number, error FROM image WHERE state = 'aside' ORDER BY number"
        return list(self._file.execute(query))

    @contextmanager
    def _change(self) -> Iterator[sqlite3.Connection]:
        """Give a transaction that is on disk when the block ends well, and never was otherwise."""
        with room():
            self._file.execute("BEGIN IMMEDIATE")
            try:
                yield self._file
                self._file.execute("COMMIT")
            except BaseException:
                if self._file.in_transaction:
                    self._file.execute("ROLLBACK")
                raise


@contextmanager
def room() -> Iterator[None]:
    """Tell what cannot be written by one error, whether a file or the ledger met it.

    Raises
    ------
    DiskFullError
        No room is left.
    HaltedError
        Something else is wrong with a drive, a store or the ledger, and not with an image.
    """
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
            raise DiskFullError(f"no room is left: {error.strerror}") from error
        raise HaltedError(str(error) or type(error).__name__) from error
    except sqlite3.DatabaseError as error:
        code = getattr(error, "sqlite_errorcode", 0)
        if code in _FULL:
            raise DiskFullError("no room is left for the ledger") from error
        if code & 0xFF in _UNUSABLE:
            raise HaltedError(f"its ledger: {error}") from error
        raise
