"""Parameter types that several phantoms share."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, WithJsonSchema
from pydantic.fields import FieldInfo

from phantom.document.base import Name, refuse, told
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


def millimetres(title: str, meaning: str, least: float, most: float) -> FieldInfo:
    """Describe a field that holds a length."""
    return told(title, "mm", meaning, ge=least, le=most, strict=True)


def count(title: str, meaning: str, least: int, most: int) -> FieldInfo:
    """Describe a field that holds a whole number."""
    return told(title, "none", meaning, ge=least, le=most, strict=True)
