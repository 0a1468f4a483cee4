"""A picture in visible light: intensities of red, green and blue, and what made them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from phantom.errors import InvalidInputError, Problem
from phantom.visible.camera import Camera
from phantom.visible.tone import Levels, Tone, toned

Floats = NDArray[np.float64]

Style = Literal["shaded", "preview", "wireframe"]

COLOR = "color"
"""The one quantity of a picture, as formats and requests call it."""


@dataclass(frozen=True, eq=False)
class Picture:
    """What a camera sees.

    Attributes
    ----------
    rgb
        (rows, columns, 3) linear intensities, background included.
    coverage
        (rows, columns) share of each pixel that shows the phantom, 0 to 1.
    camera
        What looked.
    style
        How it was drawn.
    told
        What else is known of it, as plain JSON values: lighting, background, samples.
    """

    rgb: Floats
    coverage: Floats
    camera: Camera
    style: Style
    told: Mapping[str, Any] = field(default_factory=dict)

    def quantity(self, name: str = COLOR) -> Floats:
        """Return the (rows, columns, 3) intensities.

        Raises
        ------
        InvalidInputError
            Another name than ``color`` (``/quantity``).
        """
        if name != COLOR:
            message = f"found {name!r}, but a picture in visible light has {COLOR!r}"
            raise InvalidInputError([Problem("/quantity", "unknown_quantity", message)])
        return self.rgb

    def levels(self, tone: Tone | None = None) -> Levels:
        """Return (rows, columns, 3) levels, uint8 or uint16; by default sRGB of 8 bits."""
        return toned(self.rgb, tone or Tone())

    def presented(self, name: str = COLOR, presentation: Tone | None = None) -> Levels:
        """Return the levels of a quantity, as an encoder asks for them."""
        return toned(self.quantity(name), presentation or Tone())

    def shown(self, name: str = COLOR, presentation: Tone | None = None) -> dict[str, Any]:
        """Return what the presentation came to for this picture, as plain JSON values."""
        values, tone = self.quantity(name), presentation or Tone()
        said: dict[str, Any] = tone.model_dump()
        if tone.mode == "stretch":
            said["from"] = [float(values.min()), float(values.max())]
        return said

    def geometry(self) -> dict[str, Any]:
        """Return the camera, as plain JSON values."""
        return self.camera.model_dump(mode="json", exclude_none=True)

    def metadata(self) -> dict[str, Any]:
        """Return what made the picture, as plain JSON values."""
        return {
            "style": self.style,
            "camera": self.geometry(),
            "units": {COLOR: "1"},
            **self.told,
        }
