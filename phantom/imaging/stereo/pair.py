"""A pair of radiographs: two pictures, what they share, and what they give to see."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from phantom.imaging.presentation import GreyArray, Presentation, present
from phantom.imaging.presentation_stage import presentation_stage
from phantom.imaging.result import Radiograph
from phantom.imaging.stereo.eyes import Eyes
from phantom.imaging.view import FloatArray, View
from phantom.stereo import Comfort, Disparity, Stereo, comfort, fundamental_matrix

if TYPE_CHECKING:
    from phantom.scene import Phantom

EyeName = Literal["left", "right", "mono"]


@dataclass(frozen=True, eq=False)
class StereoPair:
    """What an X-ray of a phantom for two eyes gives.

    Attributes
    ----------
    phantom, view
        What was X-rayed, and the view between the eyes.
    stereo
        How the pair was asked for.
    eyes
        Where tube and detector stood.
    left, right
        The radiographs; one and the same for a mono arm.
    disparities
        Those of the named leaves, the findings and the landmarks.
    whole
        That of everything that can be seen.
    warnings
        What was asked for and had no effect, or is likely to surprise.
    """

    phantom: Phantom
    view: View
    stereo: Stereo
    eyes: Eyes
    left: Radiograph
    right: Radiograph
    disparities: tuple[Disparity, ...]
    whole: Disparity
    warnings: tuple[str, ...]

    @property
    def images(self) -> Mapping[EyeName, Radiograph]:
        """The images that there are to give: left and right, or one for the arm of one image."""
        if self.stereo.mono == "single":
            return {"mono": self.left}
        return {"left": self.left, "right": self.right}

    @property
    def pictures(self) -> Mapping[str, EyePicture]:
        """The same, as :func:`phantom.encode.encode` takes them."""
        return {name: EyePicture(self, name, image) for name, image in self.images.items()}

    @cached_property
    def epipolar_matrix(self) -> FloatArray | None:
        """(3, 3) F with ``(x, y, 1)_right · F · (x, y, 1)_left = 0``; None for a mono arm."""
        return fundamental_matrix(self.left.projection_matrix, self.right.projection_matrix)

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

    def presented(
        self, name: str = "signal", presentation: Presentation | None = None
    ) -> dict[str, GreyArray]:
        """Return the grey levels of each image, by one mapping for both unless asked otherwise."""
        asked = (presentation if presentation is not None else Presentation()).of_pair
        if asked.scope != "pair":
            return {eye: image.presented(name, asked) for eye, image in self.images.items()}
        stacked = self._stacked(name)
        levels = np.split(present(stacked, asked, **self.left.scale(name)), len(self.images))
        return dict(zip(self.images, levels, strict=True))

    def shown(self, name: str, presentation: Presentation | None, eye: str) -> dict[str, Any]:
        """Return what the presentation came to for an eye's image, as plain JSON values."""
        asked = (presentation if presentation is not None else Presentation()).of_pair
        if asked.scope != "pair":
            return next(i for e, i in self.images.items() if e == eye).shown(name, asked)
        return presentation_stage(self._stacked(name), asked, **self.left.scale(name))

    def _stacked(self, name: str) -> FloatArray:
        """Return the images one below the other, as one image for the mapping to depend on.

        The open field of the right eye is brought to that of the left, should they differ.
        """
        scale = self.left.scale(name)["open_field"]
        return np.concatenate(
            [
                image.image(name) * (scale / image.scale(name)["open_field"])
                for image in self.images.values()
            ]
        )

    def metadata(self) -> dict[str, Any]:
        """Return what a file should say of the pair, as plain JSON values."""
        from phantom.imaging.stereo.metadata import pair_metadata

        return pair_metadata(self)


@dataclass(frozen=True, eq=False)
class EyePicture:
    """One image of a pair, with the mapping that both share; for :mod:`phantom.encode`."""

    pair: StereoPair
    eye: EyeName
    radiograph: Radiograph

    def quantity(self, name: str) -> FloatArray:
        """Return a quantity by its name."""
        return self.radiograph.quantity(name)

    def presented(self, name: str, presentation: Presentation | None) -> GreyArray:
        """Return the grey levels of a quantity."""
        return self.pair.presented(name, presentation)[self.eye]

    def shown(self, name: str, presentation: Presentation | None) -> dict[str, Any]:
        """Return what the presentation came to."""
        return self.pair.shown(name, presentation, self.eye)

    def metadata(self) -> dict[str, Any]:
        """Return what is known of the radiograph, and of the pair it is one of."""
        from phantom.imaging.stereo.metadata import eye_metadata

        return eye_metadata(self.pair, self.eye, self.radiograph)
