"""Making a set: the whole run, from a design to a finished folder."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from phantom.datasets.checks import check, check_room
from phantom.datasets.design import Design
from phantom.datasets.finishing import Finished, finish
from phantom.datasets.ledger import Counts, DiskFullError, HaltedError, Ledger, room
from phantom.datasets.making import text
from phantom.datasets.names import DESIGN, MANIFEST, SET_ASIDE, STATE, apart
from phantom.datasets.opening import of_tree, read_design
from phantom.datasets.parts import Part, check_division, write_part
from phantom.datasets.places import units
from phantom.datasets.running import LEASE_S, Supervisor, lock
from phantom.datasets.storage import LocalFolder, Storage, storage, unusable
from phantom.document import decode_json
from phantom.errors import CancelledError, InvalidInputError, Problem
from phantom.requests.limits import Limits

Progress = Callable[[Counts], None]


class Run(NamedTuple):
    """How a set is made; its bytes depend on none of it.

    Attributes
    ----------
    part
        Which part of the set; the whole by default.
    workers
        Processes; None for one a processor.
    scheduler
        Address of a dask.distributed scheduler, in place of processes of our own.
    ledger
        File of the ledger, on a local disk; by default in the set's folder.
    lease_s
        Longest that one image may take.
    """

    part: Part = Part()
    workers: int | None = None
    scheduler: str | None = None
    ledger: Path | None = None
    lease_s: float = LEASE_S


def make(
    design: Design | Mapping[str, Any] | Path | str,
    output: str | Path,
    run: Run | None = None,
    *,
    limits: Limits | None = None,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Finished | Counts:
    """Make a set, or go on with one that was cut short.

    Returns
    -------
    What the finished set came to; of one part of several the counts of its images.

    Raises
    ------
    InvalidInputError
        The design, the place, or what is there already does not do.
    DiskFullError
        No room is left; what is finished is kept, and the same call goes on.
    HaltedError
        The place or the ledger cannot be written any more; what is finished is kept.
    CancelledError
        ``cancelled`` turned true; what is finished is kept.
    """
    run = run if run is not None else Run()
    wanted = read_design(design)
    where = storage(output, run.part.name)
    with _usable("/output", where.address):
        if is_finished(wanted, where):
            return _as_it_is(wanted, where)
        check_division(where, run.part)
    planned = check(wanted, limits)
    path = ledger_path(where, run)
    new = not path.exists()
    if new:
        check_room(wanted, planned, where)
    _with_kernels()
    with ExitStack() as stack:
        named = ("/ledger", str(path)) if run.ledger else ("/output", where.address)
        with _usable(*named):
            path.parent.mkdir(parents=True, exist_ok=True)
            stack.callback(os.close, _locked(path))
            ledger = stack.enter_context(closing(_opened(path)))
        try:
            with _usable("/output", where.address):
                where.put(f"{STATE}/{DESIGN}", text(wanted.tree()).encode())
            return _made(wanted, where, ledger, run, progress, cancelled)
        except InvalidInputError:
            if new and not ledger.has_any():
                ledger.close()
                _forget_ledger(path)
                _forget_start(where)
            raise


def _made(
    design: Design,
    where: Storage,
    ledger: Ledger,
    run: Run,
    progress: Progress | None,
    cancelled: Callable[[], bool] | None,
) -> Finished | Counts:
    mine = [unit for unit in units(design) if unit.number % run.part.of == run.part.number]
    ledger.open_for(design.digest(), run.part.name, mine)
    ledger.free_all()
    where.forget_unfinished()
    reopen_lost(ledger, where)
    if run.scheduler is None:
        supervisor = Supervisor(
            design, where.address, run.part.name, ledger, run.workers, run.lease_s
        )
        through = supervisor.run(progress, cancelled)
    else:
        from phantom.datasets.cluster import run_on

        through = run_on(run.scheduler, design, where, ledger, run.lease_s, progress, cancelled)
    if not through:
        raise CancelledError("the run was cancelled; the same call goes on with it")
    counts = ledger.counts()
    with room():
        write_part(ledger, where, run.part, design.digest())
        if run.part.of > 1:
            return counts
        found = finish(design, where)
    if run.ledger is not None:
        ledger.close()
        _forget_ledger(run.ledger)
    return found


def _opened(path: Path) -> Ledger:
    """Open a ledger that is locked; leave no lock beside what is none."""
    try:
        return Ledger(path)
    except HaltedError:
        Path(f"{path}.lock").unlink(missing_ok=True)
        raise


def _forget_start(where: Storage) -> None:
    """Leave nothing of a run that was refused before it had made anything, unless others run."""
    with suppress(OSError):
        where.forget_unfinished()
        if where.names(STATE) in ([], [f"{STATE}/{DESIGN}"]):
            where.forget(STATE)


def _forget_ledger(path: Path) -> None:
    for ending in ("", "-wal", "-shm", ".lock"):
        Path(f"{path}{ending}").unlink(missing_ok=True)


@contextmanager
def _usable(path: str, place: str) -> Iterator[None]:
    """Refuse a place that cannot be used as bad input, while nothing is made yet."""
    try:
        with room():
            yield
    except DiskFullError:
        raise
    except HaltedError as error:
        raise unusable(path, place, error) from None


def merge(output: str | Path, design: Design | None = None) -> Finished:
    """Finish a set whose parts were made apart, once all of them are there.

    Raises
    ------
    InvalidInputError
        A part is missing, or the place has no parts (``/output``).
    """
    where = storage(output)
    with _usable("/output", where.address):
        wanted = design if design is not None else kept_design(where)
        if is_finished(wanted, where):
            return _as_it_is(wanted, where)
    with room():
        return finish(wanted, where)


def ledger_path(where: Storage, run: Run) -> Path:
    """Return where the ledger of a run is.

    Raises
    ------
    InvalidInputError
        The set is at an address, and no ledger is named (``/ledger``).
    """
    if run.ledger is not None:
        return run.ledger
    if isinstance(where, LocalFolder):
        return where.path / STATE / f"ledger-{run.part.name}.sqlite"
    message = f"missing; expected a file on a local disk, for the set goes to {where.address!r}"
    raise InvalidInputError([Problem("/ledger", "missing", message)])


def is_finished(design: Design, where: Storage) -> bool:
    """Tell whether the set is there already, whole; note whose an unfinished one is.

    Raises
    ------
    InvalidInputError
        Another set, or something else, is there (``/output``).
    """
    finished = where.size(MANIFEST) is not None
    own = apart(design, DESIGN) if finished else f"{STATE}/{DESIGN}"
    if where.size(own) is not None:
        with where.reading(own) as stream:
            known = decode_json(stream.read())
        if known != design.tree():
            message = (
                f"found a set of another design at {where.address!r};"
                " expected the same design, or another place"
            )
            raise InvalidInputError([Problem("/output", "other_design", message)])
        return finished
    there = [name for name in where.names("") if name != STATE]
    if there:
        message = f"found {there[0]!r} at {where.address!r}; expected an empty place"
        raise InvalidInputError([Problem("/output", "not_empty", message)])
    return False


def kept_design(where: Storage) -> Design:
    """Return the design of a set that is unfinished, or finished.

    Raises
    ------
    InvalidInputError
        There is no set (``/output``).
    """
    for name in (f"{STATE}/{DESIGN}", DESIGN, f"truth/{DESIGN}"):
        if where.size(name) is not None:
            with where.reading(name) as stream:
                return of_tree(decode_json(stream.read()))
    message = f"found no set at {where.address!r}; expected the parts of one"
    raise InvalidInputError([Problem("/output", "missing_part", message)])


def reopen_lost(ledger: Ledger, where: Storage) -> None:
    """Have made again what was acknowledged and is not there as it was."""
    lost = set()
    for _, unit, told in ledger.records():
        record = json.loads(told)
        if any(where.size(name) != size for name, _, size in record["files"]):
            lost.add(unit)
    for unit in lost:
        ledger.reopen(unit)


def _as_it_is(design: Design, where: Storage) -> Finished:
    """Return what a finished set came to."""
    found = Finished()
    name = apart(design, SET_ASIDE)
    if where.size(name) is not None:
        with where.reading(name) as stream:
            for line in stream.read().decode().splitlines():
                told = json.loads(line)
                found.aside.append((told["index"], told["error"]))
    found.images = design.images - len(found.aside)
    manifests = [("", MANIFEST), *([("truth/", f"truth/{MANIFEST}")] if design.blind else [])]
    for folder, manifest in manifests:
        with where.reading(manifest) as stream:
            for line in stream.read().decode().splitlines():
                found.bytes += where.size(folder + line.partition("  ")[2]) or 0
    return found


def _with_kernels() -> None:
    """Have the kernels compiled before workers load them: they would all compile them at once."""
    from phantom.kernels.compiling import complete
    from phantom.tracing import warm

    if not complete():
        warm()


def _locked(path: Path) -> int:
    try:
        return lock(path)
    except BlockingIOError:
        message = f"found another run at {str(path)!r}; expected to be the only one"
        raise InvalidInputError([Problem("/output", "busy", message)]) from None
