"""The generalized cylinder: an axis, a contour, a sweep and a frame that fit together."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from phantom.document.base import refuse, told
from phantom.document.contours import Contour
from phantom.document.curves import Axis
from phantom.document.leaf import LeafModel
from phantom.document.spans import span_problems
from phantom.document.sweeps import Frame, LinearSweep, MorphSweep, Sweep


class GeneralizedCylinder(LeafModel):
    """A contour swept along a curved axis."""

    type: Literal["generalized_cylinder"] = "generalized_cylinder"
    axis: Annotated[Axis, told("Axis", "mm", "The curve a(u), u from 0 to 1 or over its range.")]
    contour: Annotated[
        Contour | None,
        told("Contour", "mm", "The closed curve cs(v) that is swept; a morph has its own."),
    ] = None
    sweep: Annotated[
        Sweep,
        told("Sweep", "1", "How the contour changes with u; left out, it does not."),
        Field(validate_default=True),
    ] = LinearSweep()
    frame: Annotated[
        Frame,
        told("Frame", "none", "How the contour's axes n and b ride along the axis."),
        Field(validate_default=True),
    ] = "rotation_minimizing"

    @field_validator("sweep")
    @classmethod
    def _spans_the_axis(cls, sweep: Sweep, info: ValidationInfo) -> Sweep:
        if "axis" in info.data:
            problems = tuple(span_problems(sweep, info.data["axis"]))
            if problems:
                refuse("bad_knots", *problems)
        return sweep

    @field_validator("frame")
    @classmethod
    def _has_one_contour(cls, frame: Frame, info: ValidationInfo) -> Frame:
        if "sweep" in info.data and "contour" in info.data:
            morphs = isinstance(info.data["sweep"], MorphSweep)
            given = info.data["contour"] is not None
            if not morphs and not given:
                message = "missing; expected a contour, or a sweep that morphs"
                refuse("missing", (("contour",), message), whole=True)
            if morphs and given:
                message = "found a contour too; expected only those of the morph"
                refuse("conflict", (("contour",), message), whole=True)
        return frame
