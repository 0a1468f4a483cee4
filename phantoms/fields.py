"""Parameter types that several phantoms share."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, WithJsonSchema

from phantom.materials import REFERENCE_NAMES


def _known(name: str) -> str:
    if name not in REFERENCE_NAMES:
        raise ValueError(f"expected one of {', '.join(REFERENCE_NAMES)}")
    return name


ReferenceName = Annotated[
    str,
    AfterValidator(_known),
    WithJsonSchema({"type": "string", "enum": list(REFERENCE_NAMES)}),
]
"""The name of a reference material, refused where there is none of that name."""
