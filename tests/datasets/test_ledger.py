"""The ledger gives each unit to one worker, keeps what was acknowledged, and knows whose it is."""

from __future__ import annotations

import errno
import os
import sqlite3
from concurrent.futures import ThreadPoolExecutor

import pytest

from phantom.datasets.ledger import TRIES, Counts, DiskFullError, HaltedError, Ledger, room
from phantom.datasets.places import Unit
from phantom.errors import InvalidInputError

UNITS = [Unit(k, "train", range(2 * k, 2 * k + 2)) for k in range(20)]


@pytest.fixture
def ledger(tmp_path):
    made = Ledger(tmp_path / "ledger.sqlite")
    made.open_for("digest", "00000-of-00001", UNITS)
    yield made
    made.close()


def test_it_keeps_a_log_ahead_and_waits_for_the_disk(ledger):
    assert ledger._file.execute("PRAGMA journal_mode").fetchone() == ("wal",)
    assert ledger._file.execute("PRAGMA synchronous").fetchone() == (2,)


def test_no_two_workers_get_the_same_unit(ledger):
    def work(owner):
        own = Ledger(ledger.path)
        found = []
        while (claim := own.claim(owner, 0.0, 60.0)) is not None:
            found.append(claim)
        own.close()
        return found

    with ThreadPoolExecutor(4) as pool:
        found = [claim for claims in pool.map(work, "abcd") for claim in claims]
    assert sorted(claim.unit for claim in found) == list(range(20))
    assert all(claim.images == (2 * claim.unit, 2 * claim.unit + 1) for claim in found)


def test_a_lease_that_has_run_out_is_anyones(ledger):
    first = ledger.claim("a", 0.0, 10.0)
    assert first is not None
    assert ledger.claim("b", 9.0, 10.0) != first
    assert ledger.claim("c", 11.0, 10.0) == first
    ledger.done("a", [(0, "x", "{}")])
    assert ledger.counts().done == 0, "who lost the lease acknowledges nothing"
    ledger.done("c", [(0, "x", "{}")])
    assert ledger.counts().done == 1


def test_an_image_is_set_aside_after_three_failures(ledger):
    for attempt in range(TRIES):
        assert ledger.claim(f"w{attempt}", 0.0, 10.0).images[0] == 0
        assert ledger.failed(0, "it broke") == (attempt == TRIES - 1)
        ledger.release(f"w{attempt}")
    assert ledger.aside() == [(0, "it broke")]
    assert ledger.counts() == Counts(open=39, taken=0, done=0, aside=1)
    assert ledger.claim("w", 0.0, 10.0).images == (1,), "its neighbour is made all the same"


def test_what_is_acknowledged_is_there_for_the_next_to_open_it(ledger):
    claim = ledger.claim("a", 0.0, 10.0)
    ledger.done("a", [(number, f"hash{number}", f'{{"n":{number}}}') for number in claim.images])
    again = Ledger(ledger.path)
    again.open_for("digest", "00000-of-00001", UNITS)
    assert list(again.records()) == [(0, 0, '{"n":0}'), (1, 0, '{"n":1}')]
    again.close()


def test_after_a_kill_what_was_taken_is_open_and_nothing_has_failed(ledger):
    ledger.claim("a", 0.0, 10.0)
    ledger.free_all()
    assert ledger.counts() == Counts(open=40, taken=0, done=0, aside=0)
    assert ledger._file.execute("SELECT max(attempt) FROM image").fetchone() == (0,)


@pytest.mark.parametrize(
    ("digest", "part"), [("other", "00000-of-00001"), ("digest", "00001-of-00002")]
)
def test_the_ledger_of_another_set_is_refused(ledger, digest, part):
    with pytest.raises(InvalidInputError, match="found the ledger of another"):
        Ledger(ledger.path).open_for(digest, part, UNITS)


def test_a_full_database_is_a_full_disk(ledger):
    pages = ledger._file.execute("PRAGMA page_count").fetchone()[0]
    ledger._file.execute(f"PRAGMA max_page_count = {pages}")
    claim = ledger.claim("a", 0.0, 10.0)
    with pytest.raises(DiskFullError):
        ledger.done("a", [(claim.images[0], "x", "".join(map(str, range(100_000))))])
    assert ledger.counts().taken == 2, "the change that had no room never was"


@pytest.mark.parametrize("number", [errno.EACCES, errno.EROFS, errno.EIO, errno.ESTALE])
def test_a_fault_of_the_drive_is_no_images_fault(number):
    with pytest.raises(HaltedError) as halt, room():
        raise OSError(number, os.strerror(number))
    assert not isinstance(halt.value, DiskFullError)


def test_what_is_no_database_is_no_ledger(tmp_path):
    (tmp_path / "letter").write_text("dear reader, " * 100)
    with pytest.raises(HaltedError, match="not a database"):
        Ledger(tmp_path / "letter")


def test_another_fault_of_the_database_is_itself():
    with pytest.raises(sqlite3.OperationalError), room():
        sqlite3.connect(":memory:").execute("SELECT * FROM nothing")
