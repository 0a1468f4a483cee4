"""Several files in one: a ZIP archive, the same bytes for the same files."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from typing import Final

ZIP_MEDIA_TYPE: Final = "application/zip"

_EPOCH: Final = (1980, 1, 1, 0, 0, 0)
"""The earliest time a ZIP can tell; every file has it."""

_UNIX, _PLAIN_FILE = 3, 0o100644 << 16


def archive(files: Mapping[str, bytes]) -> bytes:
    """Return a ZIP of the files, by name, in their order, at a fixed time."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as whole:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = _UNIX
            entry.external_attr = _PLAIN_FILE
            whole.writestr(entry, data, zipfile.ZIP_DEFLATED, compresslevel=6)
    return stream.getvalue()
