"""Parameter types that several phantoms share."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, WithJsonSchema

from phantom.document.base import Name, refuse
from phantom.materials import REFERENCE_NAMES


def _known(name: str) -> str:
    if name not in REFERENCE_NAMES:
        known = ", ".join(REFERENCE_NAMES)
        refuse("unknown_reference", ((), f"found {name[:60]!r}; expected one of {known}"))
    return name


ReferenceName = Annotated[
    Name,
    AfterValidator(_known),
    WithJsonSchema({"type": "string", "enum": list(REFERENCE_NAMES)}),
]
"""The name of a reference material, refused where there is none of that name."""
