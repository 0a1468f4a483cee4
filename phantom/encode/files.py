"""Files that are whole or not there: written beside their place, then renamed into it."""

from __future__ import annotations

import os
import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from phantom.encode.archive import archive
from phantom.errors import InvalidInputError, Problem

ZIP_SUFFIX: Final = ".zip"


def write_atomically(path: Path | str, data: bytes) -> None:
    """Write a file that a reader, or a crash, never sees half-written.

    An existing file is replaced. The temporary file lies in the same folder, so that the rename
    stays within one file system, and is gone whatever happens.

    Raises
    ------
    InvalidInputError
        The folder is not there, or the path is a folder (``/output``).
    """
    path = Path(path)
    check_place(path)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(8)}")
    try:
        with temporary.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
        sync_folder(path.parent)
    finally:
        temporary.unlink(missing_ok=True)


def sync_folder(folder: Path) -> None:
    """Have a folder's list of names on disk, where the system can: a rename is then kept."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def check_place(path: Path) -> None:
    """Refuse a place where no file can be (``/output``): no folder is there, or one is it."""
    if not path.parent.is_dir():
        raise _refused("missing_folder", f"found no folder {str(path.parent)!r} to write into")
    if path.is_dir():
        raise _refused("is_a_folder", f"found a folder at {str(path)!r}, expected a file's name")


def write_files(files: Mapping[str, bytes], path: Path) -> None:
    """Write files to a folder, which is made where there is none, or to an archive (``.zip``).

    Every file is whole or not there.
    """
    if path.suffix.lower() == ZIP_SUFFIX:
        write_atomically(path, archive(files))
        return
    for name, data in files.items():
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path / name, data)


def _refused(kind: str, message: str) -> InvalidInputError:
    return InvalidInputError([Problem("/output", kind, message)])
