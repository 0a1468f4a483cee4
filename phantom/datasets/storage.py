"""Where a set is written: a folder, or any address that fsspec knows.

A file is whole or not there. In a folder it is written beside its place, synchronised, renamed
into it, and the folder synchronised; an object store puts objects whole.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any, Protocol

from phantom.datasets.names import DESIGN, STATE
from phantom.encode.files import sync_folder
from phantom.errors import InvalidInputError, PhantomError, Problem


class Storage(Protocol):
    """Where the files of a set are; names have slashes and are relative to the set."""

    @property
    def address(self) -> str:
        """What a worker opens it by."""

    def put(self, name: str, data: bytes) -> None:
        """Write a file, whole."""

    def writing(self, name: str) -> Any:
        """Return a context with a binary stream whose file is there when it ends well."""

    def reading(self, name: str) -> Any:
        """Return a context with a binary stream of a file."""

    def size(self, name: str) -> int | None:
        """Return how long a file is; None where there is none."""

    def names(self, folder: str) -> list[str]:
        """Return the names of the files right in a folder, in order."""

    def free_bytes(self) -> int | None:
        """Return how much may still be written; None where nobody knows."""

    def forget(self, name: str) -> None:
        """Remove a file, or a folder and all in it; nothing where there is none."""

    def forget_unfinished(self) -> None:
        """Remove what a writer that was killed has left half-written."""


class LocalFolder:
    """A folder of this machine, or of a drive that it mounts.

    Parameters
    ----------
    path
        The folder.
    part
        Whose unfinished files stand apart from those of others that write to the same folder.
    """

    def __init__(self, path: Path | str, part: str = "whole") -> None:
        self.path = Path(path).resolve()
        self._unfinished = self.path / STATE / f"unfinished-{part}"

    @property
    def address(self) -> str:
        """The folder."""
        return str(self.path)

    def put(self, name: str, data: bytes) -> None:
        """Write a file, whole."""
        with self.writing(name) as stream:
            stream.write(data)

    @contextmanager
    def writing(self, name: str) -> Iterator[IO[bytes]]:
        """Give a stream; its file gets its name when the block ends well, and is gone otherwise."""
        path = self.path / name
        self._unfinished.mkdir(parents=True, exist_ok=True)
        if not path.parent.is_dir():
            path.parent.mkdir(parents=True, exist_ok=True)
            sync_folder(path.parent.parent)
        temporary = self._unfinished / secrets.token_hex(12)
        try:
            with temporary.open("xb") as stream:
                yield stream
                stream.flush()
                os.fsync(stream.fileno())
            temporary.replace(path)
            sync_folder(path.parent)
        finally:
            temporary.unlink(missing_ok=True)

    @contextmanager
    def reading(self, name: str) -> Iterator[IO[bytes]]:
        """Give a stream of a file."""
        with (self.path / name).open("rb") as stream:
            yield stream

    def size(self, name: str) -> int | None:
        """Return how long a file is; None where there is none."""
        try:
            return (self.path / name).stat().st_size
        except FileNotFoundError:
            return None

    def names(self, folder: str) -> list[str]:
        """Return the names of the files right in a folder, in order."""
        at = self.path / folder
        if not at.is_dir():
            return []
        return sorted(f"{folder}/{p.name}" if folder else p.name for p in at.iterdir())

    def free_bytes(self) -> int | None:
        """Return what is free on the folder's drive."""
        at = self.path
        while not at.exists():
            at = at.parent
        return shutil.disk_usage(at).free

    def forget(self, name: str) -> None:
        """Remove a file, or a folder and all in it; nothing where there is none."""
        path = self.path / name
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)

    def forget_unfinished(self) -> None:
        """Remove what a writer that was killed has left half-written."""
        shutil.rmtree(self._unfinished, ignore_errors=True)


class Remote:
    """An address of fsspec, such as ``s3://bucket/set``; what goes wrong there is an OSError."""

    def __init__(self, address: str) -> None:
        import fsspec

        self.address = address
        self._files, self._root = fsspec.core.url_to_fs(address)
        self._folders = set[str]()

    def _at(self, name: str) -> str:
        return f"{self._root.rstrip('/')}/{name}"

    def _folder_of(self, name: str) -> None:
        folder = self._at(name).rpartition("/")[0]
        if folder not in self._folders:
            self._files.makedirs(folder, exist_ok=True)
            self._folders.add(folder)

    def put(self, name: str, data: bytes) -> None:
        """Write a file; stores of objects put it whole."""
        with _of_the_store():
            self._folder_of(name)
            self._files.pipe_file(self._at(name), data)

    @contextmanager
    def writing(self, name: str) -> Iterator[Any]:
        """Give a stream; what is written goes to the address when the block ends well."""
        with ExitStack() as stack:
            with _of_the_store():
                self._folder_of(name)
                stack.enter_context(self._files.transaction)
                stream = stack.enter_context(self._files.open(self._at(name), "wb"))
            yield _Sent(stream)
            with _of_the_store():
                stack.close()

    @contextmanager
    def reading(self, name: str) -> Iterator[Any]:
        """Give a stream of a file."""
        with _of_the_store():
            opened = self._files.open(self._at(name), "rb")
        with opened as stream:
            yield stream

    def size(self, name: str) -> int | None:
        """Return how long a file is; None where there is none."""
        with _of_the_store():
            self._files.invalidate_cache()  # others write there too
            try:
                return int(self._files.size(self._at(name)))
            except FileNotFoundError:
                return None

    def names(self, folder: str) -> list[str]:
        """Return the names of the files right in a folder, in order."""
        with _of_the_store():
            self._files.invalidate_cache()
            try:
                found = self._files.ls(self._at(folder).rstrip("/"), detail=False)
            except FileNotFoundError:
                return []
        tails = (str(name).rstrip("/").rpartition("/")[2] for name in found)
        return sorted(f"{folder}/{tail}" if folder else tail for tail in tails)

    def free_bytes(self) -> int | None:
        """Return None: such an address does not say."""
        return None

    def forget(self, name: str) -> None:
        """Remove a file, or a folder and all in it; nothing where there is none."""
        with _of_the_store():
            if self._files.exists(self._at(name)):
                self._files.rm(self._at(name), recursive=True)
        self._folders.clear()

    def forget_unfinished(self) -> None:
        """Do nothing: a put that was cut short has left no file."""


class _Sent:
    """A stream to a store."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def write(self, data: Any) -> int:
        with _of_the_store():
            return int(self._stream.write(data))


@contextmanager
def _of_the_store() -> Iterator[None]:
    """Tell errors of a store's own kind as the system tells those of a drive."""
    try:
        yield
    except (OSError, PhantomError):
        raise
    except Exception as error:
        raise OSError(f"{type(error).__name__}: {error}") from error


def storage(address: str | Path, part: str = "whole") -> Storage:
    """Return the place that a path or an address means, for a part of the set.

    Raises
    ------
    InvalidInputError
        The extra ``remote`` is missing, the address is of no kind that is known or leads nowhere,
        or a file stands where the folder would (``/output``).
    """
    if isinstance(address, Path) or "://" not in address:
        folder = LocalFolder(address, part)
        if folder.path.exists() and not folder.path.is_dir():
            message = f"found a file at {str(address)!r}; expected a folder, or a name for one"
            raise InvalidInputError([Problem("/output", "is_a_file", message)])
        return folder
    try:
        return Remote(address)
    except ImportError as error:
        message = (
            f"found {address[:80]!r}, which needs a package: {error};"
            " expected the extra remote, and what fsspec needs for this kind of address"
        )
        raise InvalidInputError([Problem("/output", "missing_extra", message)]) from None
    except ValueError as error:
        message = f"found {address[:80]!r}: {error}; expected an address that fsspec knows"
        raise InvalidInputError([Problem("/output", "unknown_address", message)]) from None
    except Exception as error:
        raise unusable("/output", address, error) from None


def unusable(path: str, place: str, error: Exception) -> InvalidInputError:
    """Return the refusal of a place that cannot be used."""
    said = (str(error).strip().splitlines() or [type(error).__name__])[0]
    message = f"found {place[:80]!r}, which cannot be used: {said[:200]}; expected another place"
    return InvalidInputError([Problem(path, "unusable", message)])


def check_shared(where: Storage) -> None:
    """Refuse a place of which a worker does not see what whoever started the run wrote there.

    Raises
    ------
    InvalidInputError
        Such as the memory of a process, or a folder of another machine (``/output``).
    """
    if where.size(f"{STATE}/{DESIGN}") is None:
        message = (
            f"found {where.address!r}, where workers do not see what was written for them;"
            " expected a place that all of them reach"
        )
        raise InvalidInputError([Problem("/output", "not_shared", message)])


def sized(count: float) -> str:
    """Return a number of bytes as people say it."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} TB"


class Hashed:
    """A stream that is written on to another, and what went through it."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream
        self._hash = hashlib.sha256()
        self.bytes = 0

    def write(self, data: Any) -> int:
        """Write on."""
        self._stream.write(data)
        self._hash.update(data)
        self.bytes += len(data)
        return len(data)

    def tell(self) -> int:
        """Return how much was written."""
        return self.bytes

    def sha256(self) -> str:
        """Return the hash of all that was written."""
        return self._hash.hexdigest()
