"""Making a unit: the files of an image, or a shard of samples, and the record of each."""

from __future__ import annotations

import hashlib
import io
import json
import tarfile
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any, Final, NamedTuple

from phantom.datasets.ledger import HaltedError, room
from phantom.datasets.making import Made, Maker, text
from phantom.datasets.names import file_name, is_open, shard_name
from phantom.datasets.places import Unit
from phantom.datasets.rows import seen
from phantom.datasets.storage import Hashed, Storage
from phantom.errors import CancelledError

LONGEST_ERROR: Final = 500


class Record(NamedTuple):
    """What the ledger keeps of an image that is made.

    Attributes
    ----------
    number
        Of the image.
    sha256
        Of its picture's file, or of its shard.
    text
        JSON: ``row``, ``files`` (name, hash, bytes), ``coco``, ``thumbnail``, ``shard``.
    """

    number: int
    sha256: str
    text: str


def make_image(maker: Maker, where: Storage, number: int) -> Record:
    """Make an image and write its files; those of a blind set's truth among them.

    Raises
    ------
    HaltedError
        It cannot be written.
    """
    made = maker.make(number)
    files = []
    with room():
        for ending, data in made.files.items():
            name = file_name(maker.design, made.place, ending)
            where.put(name, data)
            files.append([name, hashlib.sha256(data).hexdigest(), len(data)])
    return _record(made, files, None)


def make_shard(
    maker: Maker,
    where: Storage,
    unit: Unit,
    first_of_split: int,
    numbers: Sequence[int],
    begin: Callable[[int], None],
    failed: Callable[[int, Exception], bool],
) -> list[Record]:
    """Make a WebDataset shard, in TAR (ustar) at fixed times, and return its images' records.

    Parameters
    ----------
    maker, where
        What makes, and where to.
    unit, first_of_split
        The shard, and the number of its split's first.
    numbers
        Of the images that are wanted of it.
    begin
        Told before each image.
    failed
        Told of an image that could not be made; returns whether to leave it out. It is tried again
        otherwise.
    """
    design = maker.design
    names = [shard_name(unit.split, unit.number - first_of_split)]
    apart = design.blind or bool(design.truth)
    if apart:
        names.append(shard_name(unit.split, unit.number - first_of_split, truth=True))
    records: list[Made] = []
    with room(), ExitStack() as stack:
        streams = [Hashed(stack.enter_context(where.writing(name))) for name in names]
        tars: list[Any] = [
            stack.enter_context(tarfile.open(fileobj=s, mode="w|", format=tarfile.USTAR_FORMAT))  # type: ignore[call-overload]
            for s in streams
        ]
        for number in numbers:
            made = _tried(maker, number, begin, failed)
            if made is None:
                continue
            row = seen(design, made.row)
            for ending, data in {**made.files, "json": f"{text(row)}\n".encode()}.items():
                _add(tars[0 if is_open(design, ending) else 1], made.place.key, ending, data)
            records.append(made)
    files = [[n, s.sha256(), s.bytes] for n, s in zip(names, streams, strict=True)]
    own = streams[0].sha256()
    return [_record(made, files if k == 0 else [], names[0], own) for k, made in enumerate(records)]


def _tried(
    maker: Maker,
    number: int,
    begin: Callable[[int], None],
    failed: Callable[[int, Exception], bool],
) -> Made | None:
    while True:
        begin(number)
        try:
            return maker.make(number)
        except (HaltedError, CancelledError):
            raise
        except Exception as error:
            if failed(number, error):
                return None


def _add(tar: Any, key: str, ending: str, data: bytes) -> None:
    entry = tarfile.TarInfo(f"{key}.{ending}")
    entry.size, entry.mode = len(data), 0o644
    tar.addfile(entry, io.BytesIO(data))


def _record(
    made: Made, files: list[list[Any]], shard: str | None, sha256: str | None = None
) -> Record:
    told: dict[str, Any] = {"row": made.row, "files": files, "endings": list(made.files)}
    if made.annotations:
        told["coco"] = made.annotations
    if made.thumbnail is not None:
        told["thumbnail"] = made.thumbnail
    if shard is not None:
        told["shard"] = shard
    own = sha256 if sha256 is not None else files[0][1]
    return Record(made.place.number, own, json.dumps(told, separators=(",", ":"), allow_nan=False))


def worded(error: BaseException) -> str:
    """Return an error in one line, the same whoever met it."""
    first = (str(error).strip().splitlines() or [""])[0]
    return f"{type(error).__name__}: {first}"[:LONGEST_ERROR]
