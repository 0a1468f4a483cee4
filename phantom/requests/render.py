"""A picture in visible light as it is asked for, from the request to the colours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Annotated, Any

from pydantic import Field

from phantom.document import Model, told
from phantom.document.base import Choice, Integer, Name
from phantom.document.identity import content_sha256, document_sha256
from phantom.encode import Format, check_held
from phantom.encode.content import COLOR
from phantom.errors import Problem
from phantom.requests.limits import Limits
from phantom.requests.subject import Subject, read_request
from phantom.scene import Phantom
from phantom.tracing.shown import shown_leaves
from phantom.visible import Camera, CameraPreset, Lighting, Picture, Tone
from phantom.visible.lights import Color
from phantom.visible.rendering import BLACK, MAX_SAMPLES, camera_of, render


def _kind(value: Any) -> str | None:
    if isinstance(value, Mapping):
        return "placed" if {"eye", "target"} & set(value) and "preset" not in value else "preset"
    return {"Camera": "placed", "CameraPreset": "preset"}.get(type(value).__name__)


Viewpoint = Annotated[
    Camera | CameraPreset,
    Choice(
        _kind,
        ("placed", "preset"),
        "wrong_shape",
        "an object with a preset, or an eye and a target",
    ),
]
"""A camera, or a word for one; told apart by the fields ``eye`` and ``target``."""


class RenderRequest(Model):
    """What is looked at, from where and in which light; all but the phantom has a default."""

    phantom: Annotated[Subject, told("Phantom", "none", "What is looked at.")]
    camera: Annotated[Viewpoint, told("Camera", "none", "From where.")] = Field(
        default_factory=CameraPreset
    )
    hide: Annotated[
        tuple[Name, ...],
        told("Hidden", "none", "Materials, and labels of leaves or groups, to look through."),
    ] = ()
    lighting: Annotated[Lighting, told("Lighting", "none", "What light falls on it.")] = Field(
        default_factory=Lighting
    )
    background: Annotated[
        Color, told("Background", "1", "Linear red, green and blue behind the phantom.")
    ] = BLACK
    samples_per_pixel: Annotated[
        Integer,
        Field(ge=1, le=MAX_SAMPLES),
        told("Samples", "none", "Rays along each side of a pixel."),
    ] = 2
    tone: Annotated[Tone, told("Tone", "none", "How light becomes levels.")] = Field(
        default_factory=Tone
    )


@dataclass(frozen=True, slots=True)
class RenderPlan:
    """A picture with every default filled in and every limit checked, not yet traced."""

    phantom: Phantom
    camera: Camera
    request: RenderRequest
    chosen: dict[str, object]
    """The value of every flat word (`phantom.requests.words`) that has one."""

    def fingerprint(self) -> str:
        """Return a hash of all that the result depends on, the same for equal requests."""
        request = self.request.model_dump(mode="json", exclude={"phantom", "camera", "stereo"})
        content = {
            "engine": version("phantom-xray"),
            "encoder": version("OpenImageIO"),
            "document": document_sha256(self.phantom.document),
            "camera": self.camera.model_dump(mode="json"),
            **request,
        }
        return content_sha256(content)

    def check_format(self, format: Format) -> None:
        """Refuse a file format that cannot hold colours, before anything is traced."""
        check_held(format, COLOR)

    def render(
        self,
        *,
        workers: int | None = None,
        cancelled: Callable[[], bool] | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> Picture:
        """Trace it, on so many threads; the result does not depend on their number.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        """
        asked = self.request
        return render(
            self.phantom,
            self.camera,
            lighting=asked.lighting,
            background=asked.background,
            samples_per_pixel=asked.samples_per_pixel,
            hide=asked.hide,
            workers=workers,
            cancelled=cancelled,
            progress=progress,
        )


def plan_render(
    tree: object, known: Iterable[Problem] = (), limits: Limits | None = None
) -> RenderPlan:
    """Return what a request, as decoded from JSON, asks for.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request.
    """
    request, phantom = read_request(RenderRequest, tree, known)
    return plan_of_render(request, phantom, limits)


def plan_of_render(
    request: RenderRequest, phantom: Phantom, limits: Limits | None = None, images: int = 1
) -> RenderPlan:
    """Return what a request asks for, of a phantom that is ready.

    Limits count so many ``images``, such as the two of a pair.

    Raises
    ------
    InvalidInputError
        As for :func:`plan_render`.
    """
    asked = request.camera
    # A picture is square where only its columns are given.
    if "rows" not in asked.model_fields_set:
        asked = asked.model_copy(update={"rows": asked.columns})
    samples = request.samples_per_pixel
    (limits or Limits()).check_render(asked.columns, asked.rows, samples, images)
    camera = camera_of(phantom, asked, shown_leaves(phantom, request.hide))
    chosen = {
        **_placing(asked),
        "columns": camera.columns,
        "rows": camera.rows,
        "samples_per_pixel": samples,
        "shadows": request.lighting.shadows,
        "background": ",".join(f"{c:g}" for c in request.background),
        **request.tone.model_dump(),
    }
    return RenderPlan(phantom, camera, request, chosen)


def _placing(asked: Camera | CameraPreset) -> dict[str, object]:
    """Return the words of a preset as it came out; a camera in full has none."""
    if isinstance(asked, Camera):
        return {}
    azimuth, elevation = asked.angles_deg
    word = asked.word
    place = {"view": word} if word else {"azimuth_deg": azimuth, "elevation_deg": elevation}
    return {**place, "parallel": asked.parallel, "zoom": asked.zoom}
