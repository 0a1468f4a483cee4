"""A pair as it is asked for, from the request to the two images."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, field_validator

from phantom.document import told
from phantom.document.base import Name, refuse
from phantom.document.identity import content_sha256
from phantom.encode import FORMATS, Format, Layout
from phantom.errors import Problem
from phantom.imaging import Presentation, StereoPair, Truth, ground_truth
from phantom.imaging.refusals import check_exposure
from phantom.imaging.stereo import Eyes, check_eye, pair_of, placed
from phantom.imaging.truth import Kind
from phantom.requests.limits import Limits
from phantom.requests.radiograph import RadiographPlan, RadiographRequest, plan_of
from phantom.requests.subject import read_request
from phantom.requests.viewpoint import PresetView
from phantom.stereo import Stereo, ZeroPlane


class StereoWish(Stereo):
    """Two eyes, and how their pictures are laid out."""

    layout: Annotated[
        Layout | None,
        told(
            "Layout",
            "none",
            "files: one each; side_by_side, cross_eyed, anaglyph: one picture; two_view: one"
            " OpenEXR; all: an archive of every one. By default what the form can hold.",
        ),
    ] = None
    format: Annotated[
        Name | None,
        told("Format", "none", "Of the two files in an archive, such as dicom; png by default."),
    ] = None

    @field_validator("format")
    @classmethod
    def _is_known(cls, value: str | None) -> str | None:
        names = [known.name for known in FORMATS]
        if value is not None and value not in names:
            refuse("unknown_format", ((), f"found {value!r}; expected one of {', '.join(names)}"))
        return value


class StereoRequest(RadiographRequest):
    """What is X-rayed for two eyes, from where and how; all but the phantom has a default."""

    stereo: Annotated[StereoWish, told("Stereo", "none", "The two eyes.")] = Field(
        default_factory=StereoWish
    )


@dataclass(frozen=True, slots=True)
class StereoPlan:
    """A pair with every default filled in and every limit checked, not yet traced."""

    mono: RadiographPlan
    """The radiograph of the view between the eyes."""
    wish: StereoWish
    isocentre: NDArray[np.float64]
    eyes: Eyes
    chosen: dict[str, object]
    """The value of every flat word (`phantom.requests.words`) that has one."""

    @property
    def single(self) -> bool:
        """Whether there is one image alone."""
        return self.wish.mono == "single"

    @property
    def name(self) -> str:
        """Of the phantom."""
        return self.mono.phantom.document.name

    @property
    def quantity(self) -> str:
        """What a pixel holds."""
        return self.mono.quantity

    @property
    def presentation(self) -> Presentation:
        """How it is shown."""
        return self.mono.presentation

    @property
    def truth(self) -> tuple[Kind, ...]:
        """Kinds of ground truth; none for the images alone."""
        return self.mono.truth

    @property
    def blind(self) -> bool:
        """Whether the files leave out what they say of themselves."""
        return self.mono.blind

    def check_format(self, format: Format) -> None:
        """Refuse a file format that cannot hold an image, before anything is traced."""
        self.mono.check_format(format)

    def fingerprint(self) -> str:
        """Return a hash of all that the result depends on, the same for equal requests."""
        content = {
            "radiograph": self.mono.fingerprint(),
            "stereo": self.wish.model_dump(mode="json"),
            "eyes": [e.model_dump(mode="json") for e in (self.eyes.left, self.eyes.right)],
        }
        return content_sha256(content)

    def render(
        self,
        *,
        workers: int | None = None,
        cancelled: Callable[[], bool] | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> StereoPair:
        """Trace both images.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        """
        mono = self.mono
        return pair_of(
            mono.phantom,
            mono.view,
            mono.beam,
            self.wish,
            acquisition=mono.acquisition,
            noise=mono.noise,
            isocentre=self.isocentre,
            workers=workers,
            cancelled=cancelled,
            progress=progress,
        )

    def tell(self, pair: StereoPair, **run: Any) -> Mapping[str, Truth]:
        """Trace the ground truth of each image of a pair; none where none is asked for.

        Parameters
        ----------
        pair
            What :meth:`render` gave.
        **run
            ``workers``, ``cancelled`` and ``progress``, as there.
        """
        kinds = self.mono.truth
        if not kinds:
            return {}
        if pair.left is pair.right:
            truth = ground_truth(self.mono.phantom, pair.left.view, kinds, **run)
            return dict.fromkeys(pair.images, truth)
        return {
            eye: ground_truth(self.mono.phantom, image.view, kinds, **run)
            for eye, image in pair.images.items()
        }


def plan_pair(
    tree: object, known: Iterable[Problem] = (), limits: Limits | None = None
) -> StereoPlan:
    """Return what a request for a pair, as decoded from JSON, asks for.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request.
    """
    request, phantom = read_request(StereoRequest, tree, known)
    wish = request.stereo
    mono = plan_of(request, phantom, limits, images=1 if wish.mono is not None else 2)
    check_eye(request.noise)
    aim = phantom.isocentre
    if isinstance(request.view, PresetView) and request.view.isocentre is not None:
        aim = np.asarray(request.view.isocentre, dtype=np.float64)
    eyes = placed(phantom, mono.view, wish, aim)
    for eye in (eyes.left, eyes.right):
        check_exposure(phantom, eye, mono.beam, mono.acquisition)
    presentation = mono.presentation.of_pair
    placing = {"dose": wish.dose, **eye_words(wish, eyes.baseline_mm, eyes.angle_deg)}
    if wish.mono is not None:
        placing = {"mono": wish.mono}
    chosen = {**mono.chosen, "scope": presentation.scope, **placing}
    return StereoPlan(mono, wish, aim, eyes, chosen)


def eye_words(
    wish: StereoWish, baseline_mm: float | None, angle_deg: float | None
) -> dict[str, object]:
    """Return the words of two eyes as they came out."""
    plane, screen = wish.zero_parallax, wish.screen
    found: dict[str, object] = {"method": wish.method}
    if wish.method == "shift" and baseline_mm is not None:
        found["baseline_mm"] = round(baseline_mm, 6)
    if wish.method == "rotate" and angle_deg is not None:
        found["stereo_angle_deg"] = round(angle_deg, 6)
    return {
        **found,
        "zero_parallax": plane.plane_mm if isinstance(plane, ZeroPlane) else plane,
        "screen": f"{screen.pixel_pitch_mm:g},{screen.distance_mm:g},{screen.ipd_mm:g}",
    }
