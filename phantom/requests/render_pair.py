"""A pair in visible light as it is asked for, from the request to the two pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from phantom.document import told
from phantom.document.identity import content_sha256
from phantom.encode import Format
from phantom.encode.content import COLOR
from phantom.errors import Problem
from phantom.requests.limits import Limits
from phantom.requests.render import RenderPlan, RenderRequest, plan_of_render
from phantom.requests.stereo import StereoWish, eye_words
from phantom.requests.subject import read_request
from phantom.tracing.shown import shown_leaves
from phantom.visible import PicturePair, Tone
from phantom.visible.eyes import CameraPair
from phantom.visible.pairing import pictures_of, placed_cameras


class RenderPairRequest(RenderRequest):
    """What is looked at with two eyes; all but the phantom has a default."""

    stereo: Annotated[StereoWish, told("Stereo", "none", "The two eyes.")] = Field(
        default_factory=StereoWish
    )


@dataclass(frozen=True, slots=True)
class RenderPairPlan:
    """A pair with every default filled in and every limit checked, not yet traced."""

    middle: RenderPlan
    """The picture of the camera between the eyes."""
    wish: StereoWish
    eyes: CameraPair
    chosen: dict[str, object]
    """The value of every flat word (`phantom.requests.words`) that has one."""

    @property
    def single(self) -> bool:
        """Whether there is one picture alone."""
        return self.wish.mono == "single"

    @property
    def name(self) -> str:
        """Of the phantom."""
        return self.middle.phantom.document.name

    @property
    def quantity(self) -> str:
        """What a pixel holds."""
        return COLOR

    @property
    def presentation(self) -> Tone:
        """How light becomes levels."""
        return self.middle.request.tone

    @property
    def truth(self) -> tuple[str, ...]:
        """None: ground truth is a radiograph's."""
        return ()

    @property
    def blind(self) -> bool:
        """False: what is seen is told."""
        return False

    def check_format(self, format: Format) -> None:
        """Refuse a file format that cannot hold colours, before anything is traced."""
        self.middle.check_format(format)

    def fingerprint(self) -> str:
        """Return a hash of all that the result depends on, the same for equal requests."""
        content = {
            "picture": self.middle.fingerprint(),
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
    ) -> PicturePair:
        """Trace both pictures.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        """
        asked = self.middle.request
        return pictures_of(
            self.middle.phantom,
            self.middle.camera,
            self.wish,
            lighting=asked.lighting,
            background=asked.background,
            samples_per_pixel=asked.samples_per_pixel,
            hide=asked.hide,
            workers=workers,
            cancelled=cancelled,
            progress=progress,
        )

    def tell(self, pair: PicturePair, **run: Any) -> Mapping[str, Any]:
        """Return the ground truth: none."""
        return {}


def plan_render_pair(
    tree: object, known: Iterable[Problem] = (), limits: Limits | None = None
) -> RenderPairPlan:
    """Return what a request for a pair in visible light, as decoded from JSON, asks for.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request.
    """
    request, phantom = read_request(RenderPairRequest, tree, known)
    wish = request.stereo
    middle = plan_of_render(request, phantom, limits, images=1 if wish.mono is not None else 2)
    shown = frozenset(np.flatnonzero(shown_leaves(phantom, request.hide)).tolist())
    eyes = placed_cameras(phantom, middle.camera, wish, shown)
    placing = eye_words(wish, eyes.baseline_mm, eyes.angle_deg)
    if wish.mono is not None:
        placing = {"mono": wish.mono}
    return RenderPairPlan(middle, wish, eyes, {**middle.chosen, **placing})
