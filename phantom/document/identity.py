"""What a file says of where it comes from: the program, and the document."""

from __future__ import annotations

import hashlib
import json
from importlib.metadata import version
from typing import Any

from phantom.document.documents import Document


def document_sha256(document: Document) -> str:
    """Return the SHA-256 of a document written as JSON with every default filled in.

    The order of materials counts, since it is the order of the path lengths.
    """
    return content_sha256(document.model_dump(mode="json"))


def content_sha256(content: Any) -> str:
    """Return the SHA-256 of plain JSON values, written without spaces and in their own order."""
    text = json.dumps(content, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def identity(document: Document) -> dict[str, Any]:
    """Return the software and the phantom that made a file, as plain JSON values."""
    anatomy = document.anatomy
    return {
        "software": {"name": "phantom-xray", "version": version("phantom-xray")},
        "phantom": {
            "name": document.name,
            "title": document.title,
            "document_sha256": document_sha256(document),
            "material_names": list(document.materials),
            "anatomy": None if anatomy is None else anatomy.model_dump(mode="json"),
        },
    }
