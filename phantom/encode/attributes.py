"""The metadata as text inside a file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

METADATA_KEY = "phantom:metadata"
"""Name under which a PNG and an EXR hold the whole metadata as JSON."""


def json_text(metadata: Mapping[str, Any]) -> str:
    """Return the metadata as JSON in ASCII, without spaces."""
    return json.dumps(metadata, ensure_ascii=True, allow_nan=False, separators=(",", ":"))


def attributes(metadata: Mapping[str, Any], key: str) -> dict[str, str]:
    """Return what OpenImageIO is to put into a file; nothing where there is no metadata.

    ``Software`` names the version, ``DocumentName`` the phantom, and ``key`` holds everything.
    """
    if not metadata:
        return {}
    found = {key: json_text(metadata)}
    software = metadata.get("software")
    if software is not None:
        found["Software"] = f"{software['name']} {software['version']}"
    named = metadata.get("phantom")
    if named is not None:
        found["DocumentName"] = str(named["name"]).encode("ascii", "replace").decode()
    return found
