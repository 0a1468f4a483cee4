"""The metadata alone, as a JSON file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def sidecar(metadata: Mapping[str, Any]) -> bytes:
    """Return the metadata as JSON in UTF-8, one field a line for people."""
    text = json.dumps(metadata, ensure_ascii=False, allow_nan=False, indent=1)
    return f"{text}\n".encode()
