"""A pair of pictures in visible light, for the left and the right eye."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from phantom.scene import Phantom
from phantom.stereo import (
    Comfort,
    Disparity,
    Stereo,
    comfort,
    fundamental_matrix,
    stereo_told,
)
from phantom.visible.camera import Camera, Floats
from phantom.visible.eyes import CameraPair
from phantom.visible.picture import Picture
from phantom.visible.tone import Levels, Tone, toned


@dataclass(frozen=True, eq=False)
class PicturePair:
    """What two eyes see of a phantom.

    Attributes
    ----------
    phantom, camera
        What was looked at, and from between the eyes.
    stereo
        How the pair was asked for.
    eyes
        Where the cameras stood.
    left, right
        The pictures; one and the same for a mono arm.
    disparities
        Those of the named leaves that are shown, the findings and the landmarks.
    whole
        That of everything that is shown.
    """

    phantom: Phantom
    camera: Camera
    stereo: Stereo
    eyes: CameraPair
    left: Picture
    right: Picture
    disparities: tuple[Disparity, ...]
    whole: Disparity

    @property
    def images(self) -> Mapping[str, Picture]:
        """The pictures that there are to give: left and right, or one for the arm of one."""
        if self.stereo.mono == "single":
            return {"mono": self.left}
        return {"left": self.left, "right": self.right}

    @property
    def pictures(self) -> Mapping[str, EyeView]:
        """The same, as :func:`phantom.encode.encode_pair` takes them."""
        return {name: EyeView(self, name, image) for name, image in self.images.items()}

    @cached_property
    def epipolar_matrix(self) -> Floats | None:
        """(3, 3) F with ``(x, y, 1)_right · F · (x, y, 1)_left = 0``; None for a mono arm."""
        return fundamental_matrix(self.eyes.left.matrix, self.eyes.right.matrix)

    @cached_property
    def comfort(self) -> Comfort:
        """Whether eyes can bear it."""
        return comfort(self.whole, self.disparities, self.stereo.screen)

    def disparity(self, name: str) -> Disparity:
        """Return the first structure of that name; KeyError where there is none."""
        for found in self.disparities:
            if found.name == name:
                return found
        raise KeyError(name)

    @property
    def stacked(self) -> Floats:
        """The pictures one below the other: what a stretch takes the ends of its range from."""
        return np.concatenate([image.rgb for image in self.images.values()])

    def levels(self, tone: Tone | None = None) -> dict[str, Levels]:
        """Return the (rows, columns, 3) levels of each picture, by one mapping for both."""
        both = toned(self.stacked, tone or Tone())
        rows = self.camera.rows
        return {eye: both[i * rows : (i + 1) * rows] for i, eye in enumerate(self.images)}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is likely to surprise."""
        found = (*self.left.told.get("warnings", ()), *self.right.told.get("warnings", ()))
        return tuple(dict.fromkeys(found))

    def metadata(self) -> dict[str, Any]:
        """Return what a file should say of the pair, as plain JSON values."""
        return {
            **self.left.metadata(),
            "camera": self.camera.model_dump(mode="json", exclude_none=True),
            "stereo": self.stereo_metadata(),
            "disparities": [found.told() for found in self.disparities],
            "images": {eye: {"camera": image.geometry()} for eye, image in self.images.items()},
            "warnings": list(self.warnings),
        }

    def stereo_metadata(self) -> dict[str, Any]:
        """Return the geometry of the pair, and what it asks of the eyes."""
        told = stereo_told(
            self.stereo,
            baseline_mm=self.eyes.baseline_mm,
            angle_deg=self.eyes.angle_deg,
            zero_depth_mm=self.eyes.zero_depth_mm,
            whole=self.whole,
            comfort=self.comfort,
            matrix=self.epipolar_matrix,
        )
        return {name: value for name, value in told.items() if name != "dose"}


@dataclass(frozen=True, eq=False)
class EyeView:
    """One picture of a pair, with the mapping that both share."""

    pair: PicturePair
    eye: str
    picture: Picture

    def quantity(self, name: str) -> Floats:
        """Return the (rows, columns, 3) intensities."""
        return self.picture.quantity(name)

    def presented(self, name: str, presentation: Tone | None) -> Levels:
        """Return the levels."""
        self.picture.quantity(name)
        return self.pair.levels(presentation)[self.eye]

    def shown(self, name: str, presentation: Tone | None) -> dict[str, Any]:
        """Return what the presentation came to, for both."""
        both = Picture(self.pair.stacked, self.picture.coverage, self.picture.camera, "shaded")
        return both.shown(name, presentation)

    def metadata(self) -> dict[str, Any]:
        """Return what is known of the picture, and of the pair it is one of."""
        stereo = {"eye": self.eye, **self.pair.stereo_metadata()}
        return {**self.picture.metadata(), "stereo": stereo}
