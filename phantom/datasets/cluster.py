"""Making a set with the workers of a dask.distributed scheduler; needs the extra ``cluster``.

The ledger stays here: a scheduler that dies loses its futures, and nothing that is finished.
Chunks of images are sent, since a task costs milliseconds of its own. A chunk whose worker died is
sent again image by image, so that the one to blame is found.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from typing import Any, Final

from phantom.datasets.design import Design
from phantom.datasets.ledger import Counts, HaltedError, Ledger, room
from phantom.datasets.making import Maker
from phantom.datasets.opening import of_tree
from phantom.datasets.places import units
from phantom.datasets.running import WorkersLostError
from phantom.datasets.storage import Storage, check_shared, storage
from phantom.datasets.units import Record, make_image, make_shard, worded
from phantom.errors import InvalidInputError, Problem

CHUNK_IMAGES: Final = 8
"""Images of a task."""

AHEAD: Final = 2
"""Tasks for each thread of the cluster that are sent before any is done."""

LOOK_S: Final = 0.05
"""How often the futures are looked at."""

CONNECT_S: Final = 20.0

Outcome = list[Record | tuple[int, str]]
"""Of each image its record, or its number and what was wrong."""


def make_chunk(tree: dict[str, Any], address: str, unit: int | None, numbers: list[int]) -> Outcome:
    """Make images on a worker of the cluster, which can reach the set's address."""
    design = of_tree(tree)
    maker, where = Maker(design, threads=1), storage(address, f"cluster-{secrets.token_hex(4)}")
    found: Outcome = []
    with room():
        check_shared(where)
    if unit is not None:
        everything = units(design)
        own = everything[unit]
        first = next(u.number for u in everything if u.split == own.split)

        def failed(number: int, error: Exception) -> bool:
            found.append((number, worded(error)))
            return True

        records = make_shard(maker, where, own, first, numbers, lambda _: None, failed)
        return [*found, *records]
    for number in numbers:
        try:
            found.append(make_image(maker, where, number))
        except HaltedError:
            raise
        except Exception as error:
            found.append((number, worded(error)))
    where.forget_unfinished()
    return found


def run_on(
    address: str,
    design: Design,
    where: Storage,
    ledger: Ledger,
    lease_s: float,
    progress: Callable[[Counts], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> bool:
    """Make all that is open on a cluster; return whether it came to its end.

    Raises
    ------
    InvalidInputError
        The extra is missing, or no scheduler answers (``/scheduler``).
    WorkersLostError
        The scheduler went away; the same run goes on with it, or with another.
    """
    client = _connected(address)
    try:
        return _Dispatch(client, design, where, ledger, lease_s).run(progress, cancelled)
    except (OSError, TimeoutError) as error:
        raise WorkersLostError(f"the scheduler at {address} went away: {worded(error)}") from error
    finally:
        client.close(timeout=1)


def _connected(address: str) -> Any:
    try:
        from distributed import Client
        from distributed.comm.addressing import parse_address, parse_host_port
        from distributed.comm.registry import get_backend
    except ImportError:
        message = "found a scheduler, which needs the extra cluster; expected it to be installed"
        raise InvalidInputError([Problem("/scheduler", "missing_extra", message)]) from None
    try:
        # A client that never was would wait for its own end, so the address is judged first.
        scheme, place = parse_address(address)
        get_backend(scheme)
        parse_host_port(place)
        return Client(address, timeout=CONNECT_S, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, TimeoutError, ValueError) as error:
        said = worded(error)
        message = f"found {address[:80]!r}, where no scheduler answers ({said}); expected one"
        raise InvalidInputError([Problem("/scheduler", "unreachable", message)]) from None


class _Dispatch:
    """Sends chunks, and enters what comes back."""

    def __init__(
        self, client: Any, design: Design, where: Storage, ledger: Ledger, lease_s: float
    ) -> None:
        self._client = client
        self._design, self._where, self._ledger, self._lease_s = design, where, ledger, lease_s
        self._sent: dict[Any, tuple[str, int | None, list[int]]] = {}
        self._alone: list[tuple[str, int]] = []

    def run(
        self,
        progress: Callable[[Counts], None] | None,
        cancelled: Callable[[], bool] | None,
    ) -> bool:
        try:
            while True:
                if cancelled is not None and cancelled():
                    return False
                self._send()
                if not self._sent:
                    return True
                self._receive()
                if progress is not None:
                    progress(self._ledger.counts())
        finally:
            for future, (owner, _, _) in self._sent.items():
                future.cancel()
                self._ledger.release(owner)

    def _send(self) -> None:
        """Send single images that are under suspicion, then chunks, as many as are worked at."""
        threads = sum(self._client.nthreads().values())
        wanted = AHEAD * max(1, threads) - len(self._sent)
        while self._alone and wanted > 0:
            owner, number = self._alone.pop()
            self._submit(owner, None, [number])
            wanted -= 1
        for _ in range(wanted):
            owner, numbers, unit = secrets.token_hex(8), list[int](), None
            while len(numbers) < CHUNK_IMAGES:
                claim = self._ledger.claim(owner, time.time(), self._lease_s * CHUNK_IMAGES)
                if claim is None:
                    break
                numbers += claim.images
                if self._design.sharded:
                    unit = claim.unit
                    break
            if not numbers:
                return
            self._submit(owner, unit, numbers)

    def _submit(self, owner: str, unit: int | None, numbers: list[int]) -> None:
        future = self._client.submit(
            make_chunk, self._design.tree(), self._where.address, unit, numbers, pure=False
        )
        self._sent[future] = (owner, unit, numbers)

    def _receive(self) -> None:
        """Enter what has come back; a scheduler that is gone has lost every future."""
        if self._client.status != "running":
            raise OSError(f"its client is {self._client.status}")
        if not any(future.done() for future in self._sent):
            time.sleep(LOOK_S)
            return
        for future in [f for f in self._sent if f.done()]:
            owner, unit, numbers = self._sent.pop(future)
            if future.status == "finished":
                self._entered(owner, future.result())
            elif future.status == "error":
                self._gone_wrong(owner, unit, numbers, future.exception())
            else:
                self._ledger.release(owner)
                raise OSError("it lost what it was to do")

    def _entered(self, owner: str, outcome: Outcome) -> None:
        records = [found for found in outcome if isinstance(found, Record)]
        self._ledger.done(owner, records)
        for found in outcome:
            if not isinstance(found, Record):
                self._ledger.failed(*found)
        self._ledger.release(owner)

    def _gone_wrong(
        self, owner: str, unit: int | None, numbers: list[int], error: BaseException | None
    ) -> None:
        if isinstance(error, HaltedError | InvalidInputError):
            raise error
        if unit is None and len(numbers) > 1:
            self._alone += [(owner, number) for number in numbers]
            return
        for number in numbers:
            self._ledger.failed(number, "its worker of the cluster was lost")
        self._ledger.release(owner)
