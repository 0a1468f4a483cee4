"""What can be encoded: anything that gives its quantities, its grey levels and its metadata."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

PresentationT_contra = TypeVar("PresentationT_contra", contravariant=True)


class Picture(Protocol[PresentationT_contra]):
    """A result as an encoder sees it; ``phantom.imaging.Radiograph`` is one."""

    def quantity(self, name: str) -> NDArray[np.float64]:
        """Return (rows, columns) or (rows, columns, M) values."""

    def presented(
        self, name: str, presentation: PresentationT_contra | None
    ) -> NDArray[np.uint8] | NDArray[np.uint16]:
        """Return (rows, columns) grey levels."""

    def shown(self, name: str, presentation: PresentationT_contra | None) -> dict[str, Any]:
        """Return what the presentation came to for this image, as plain JSON values."""

    def metadata(self) -> dict[str, Any]:
        """Return plain JSON values."""
