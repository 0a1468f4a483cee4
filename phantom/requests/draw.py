"""A picture in visible light in any style: shaded, a preview, or a wireframe."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Final, Literal, cast

from pydantic import Field

from phantom.document import told
from phantom.document.base import Boolean, Integer, Length, Number
from phantom.encode import Format
from phantom.encode.content import COLOR
from phantom.encode.formats import DRAWING
from phantom.errors import InvalidInputError, Problem
from phantom.requests.limits import Limits
from phantom.requests.render import RenderPlan, RenderRequest, plan_of_render
from phantom.requests.subject import read_request
from phantom.requests.words import RENDER_WORDS
from phantom.visible import Picture
from phantom.visible.drawing import (
    DEFAULT_LINES,
    DEFAULT_RINGS,
    MAX_LINES,
    PAPER,
    WIDTH,
    wireframe,
)
from phantom.visible.previewing import preview, preview_tolerance_mm

Style = Literal["shaded", "preview", "wireframe"]
Count = Annotated[Integer, Field(ge=2, le=MAX_LINES)]

ONLY_OF: Final[Mapping[str, tuple[Style, ...]]] = {
    "lighting": ("shaded", "preview"),
    "samples_per_pixel": ("shaded", "preview"),
    "tolerance_mm": ("preview",),
    "rings": ("wireframe",),
    "lines": ("wireframe",),
    "hidden_lines": ("wireframe",),
    "line_width_px": ("wireframe",),
}
"""Fields that change nothing in other styles, where they are refused."""

_OWN: Final = ("tolerance_mm", "rings", "lines", "hidden_lines", "line_width_px")

DRAW_WORDS: Final[Mapping[str, tuple[str, ...]]] = {
    **RENDER_WORDS,
    **{name: (name,) for name in ("style", *_OWN)},
}
"""Where each flat word stands in a request for a picture in any style."""


class DrawRequest(RenderRequest):
    """What is looked at, from where, and in which style; all but the phantom has a default."""

    style: Annotated[
        Style,
        told(
            "Style",
            "none",
            "shaded: exact, lit by Phong's model; preview: triangles on a z-buffer, fast and"
            " coarse; wireframe: the (u, v) net.",
        ),
    ] = "shaded"
    tolerance_mm: Annotated[
        Length | None,
        told(
            "Tolerance",
            "mm",
            "How far a preview's triangle may lie from the surface; by default a thousandth of the"
            " phantom's diagonal.",
        ),
    ] = None
    rings: Annotated[Count, told("Rings", "none", "Sections of each leaf that are drawn.")] = (
        DEFAULT_RINGS
    )
    lines: Annotated[Count, told("Lines", "none", "Lines along each leaf that are drawn.")] = (
        DEFAULT_LINES
    )
    hidden_lines: Annotated[
        Boolean, told("Hidden lines", "none", "False leaves out lines behind a surface.")
    ] = True
    line_width_px: Annotated[
        Annotated[Number, Field(ge=0.1, le=100)], told("Line width", "pixels", "Of the lines.")
    ] = WIDTH


@dataclass(frozen=True, slots=True)
class DrawPlan(RenderPlan):
    """A picture in any style, with every default filled in and every limit checked."""

    def check_format(self, format: Format) -> None:
        """Refuse a file format that cannot hold the picture, before anything is traced."""
        if not (self._asked.style == "wireframe" and DRAWING in format.quantities):
            # Not super(): a dataclass with slots is another class than the one it was made of.
            RenderPlan.check_format(self, format)

    @property
    def _asked(self) -> DrawRequest:
        return cast(DrawRequest, self.request)

    def render(
        self,
        *,
        workers: int | None = None,
        cancelled: Callable[[], bool] | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> Picture:
        """Make it, on so many threads; the result does not depend on their number.

        Raises
        ------
        CancelledError
            ``cancelled()`` turned true.
        """
        asked = self._asked
        if asked.style == "wireframe":
            return wireframe(
                self.phantom,
                self.camera,
                rings=asked.rings,
                lines=asked.lines,
                hidden_lines=asked.hidden_lines,
                background=asked.background,
                line_width_px=asked.line_width_px,
                hide=asked.hide,
                cancelled=cancelled,
                progress=progress,
            )
        if asked.style == "preview":
            return preview(
                self.phantom,
                self.camera,
                lighting=asked.lighting,
                background=asked.background,
                samples_per_pixel=asked.samples_per_pixel,
                tolerance_mm=asked.tolerance_mm,
                hide=asked.hide,
                workers=workers,
                cancelled=cancelled,
                progress=progress,
            )
        return RenderPlan.render(self, workers=workers, cancelled=cancelled, progress=progress)


def quantity_of(format: Format) -> str:
    """Return what a format takes of a picture: its colours, or its drawing."""
    return DRAWING if DRAWING in format.quantities else COLOR


def plan_draw(
    tree: object, known: Iterable[Problem] = (), limits: Limits | None = None
) -> DrawPlan:
    """Return what a request, as decoded from JSON, asks for.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request.
    """
    request, phantom = read_request(DrawRequest, tree, known)
    said, style = request.model_fields_set, request.style
    problems = [
        Problem(f"/{name}", "no_effect", f"found it with style {style}; expected none")
        for name, styles in ONLY_OF.items()
        if name in said and style not in styles
    ]
    if style == "preview" and request.lighting.shadows:
        message = "found true, but a preview has no shadows; expected false"
        problems.append(Problem("/lighting/shadows", "no_effect", message))
    if problems:
        raise InvalidInputError(problems)
    usual: dict[str, object] = {}
    if style == "preview":
        preview_tolerance_mm(phantom, request.tolerance_mm)
        usual = {"samples_per_pixel": 1}
    if style == "wireframe":
        usual = {"background": PAPER, "samples_per_pixel": 1}
    left = {name: value for name, value in usual.items() if name not in said}
    request = request.model_copy(update=left)
    plan = plan_of_render(request, phantom, limits)
    chosen = {
        word: value
        for word, value in plan.chosen.items()
        if style in ONLY_OF.get({"shadows": "lighting"}.get(word, word), (style,))
    }
    if style == "preview":
        chosen.pop("shadows")
        chosen["tolerance_mm"] = round(preview_tolerance_mm(phantom, request.tolerance_mm), 6)
    if style == "wireframe":
        chosen |= {
            name: getattr(request, name) for name, styles in ONLY_OF.items() if styles == (style,)
        }
    return DrawPlan(plan.phantom, plan.camera, request, chosen)
