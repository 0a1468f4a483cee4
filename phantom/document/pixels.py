"""How many pixels a picture may have."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import Field, ValidationInfo

from phantom.document.base import Integer, refuse

MAX_SIDE_PIXELS: Final = 16384
"""Most columns, and most rows, of a picture."""

MAX_PIXELS: Final = 2**26
"""Most pixels of a picture (8192 × 8192); a chest detector has 7.6 million."""

Side = Annotated[Integer, Field(ge=1, le=MAX_SIDE_PIXELS)]


def within_pixels(rows: int, info: ValidationInfo) -> int:
    """Refuse ``rows`` that make, with the model's ``columns``, too many pixels."""
    columns = info.data.get("columns", 1)
    if columns * rows > MAX_PIXELS:
        message = f"found {columns} × {rows} pixels; expected {MAX_PIXELS} at most"
        refuse("too_large", ((), message))
    return rows
