"""From where the phantom is seen: a clinical word, or a source and a detector in full."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import ValidationError

from phantom.document import Model, Point, Vector, told, validate_model
from phantom.document.base import Choice
from phantom.errors import InvalidInputError, Problem
from phantom.imaging import DetectorGrid, Preset, PresetName, View, covering, place

if TYPE_CHECKING:
    from phantom.library import Technique
    from phantom.scene import Phantom


class PresetView(Preset):
    """A view by its clinical word; without one, the first that the phantom recommends."""

    preset: Annotated[PresetName, told("Preset", "none", "The clinical word for the pose.")] = "ap"


class DetectorPose(Model):
    """Where the detector is; its grid stands in the request's own ``detector``."""

    center: Annotated[Point, told("Centre", "mm", "World point at the middle of the grid.")]
    right: Annotated[Vector, told("Right", "none", "Direction along a row, columns rising.")]
    down: Annotated[Vector, told("Down", "none", "Direction down a column, rows rising.")]


class PlacedView(Model):
    """A view by its source and its detector."""

    source: Annotated[
        Point | None, told("Source", "mm", "The focal spot; null for a parallel beam.")
    ]
    direction: Annotated[Vector | None, told("Direction", "none", "Of a parallel beam.")] = None
    detector: Annotated[DetectorPose, told("Detector", "none", "Where the detector is.")]


def _kind(value: Any) -> str | None:
    if isinstance(value, Mapping):
        placed = {"source", "direction", "detector"} & set(value)
        return "placed" if placed and "preset" not in value else "preset"
    return {"PlacedView": "placed", "PresetView": "preset"}.get(type(value).__name__)


Viewpoint = Annotated[
    PresetView | PlacedView,
    Choice(
        _kind,
        ("preset", "placed"),
        "wrong_shape",
        "an object with a preset, or with a source and a detector",
    ),
]
"""Either of them, told apart by the field ``preset``."""


def view_of(
    phantom: Phantom,
    wanted: PresetView | PlacedView,
    grid: DetectorGrid,
    technique: Technique,
    recommended: str,
) -> View:
    """Return the view a request means around this phantom.

    Without a pitch the detector covers the phantom.

    Raises
    ------
    InvalidInputError
        With paths under ``/view`` and ``/detector``.
    """
    if isinstance(wanted, PlacedView):
        return _placed(phantom, wanted, grid)
    preset = _with_technique(wanted, technique, recommended)
    if grid.pitch_mm is None and technique.field_mm is not None:
        pitch_mm = technique.field_mm / max(grid.columns, grid.rows)
        grid = grid.model_copy(update={"pitch_mm": pitch_mm})
    try:
        return place(phantom, preset, grid)
    except ValidationError as error:  # distances that put the tube out of the world
        told = (Problem("/view", "out_of_range", e["msg"]) for e in error.errors())
        raise InvalidInputError(dict.fromkeys(told)) from None


def _with_technique(wanted: PresetView, technique: Technique, recommended: str) -> Preset:
    """Return the preset with what was left out set as a radiographer would."""
    chosen = wanted.model_dump(include=wanted.model_fields_set)
    chosen.setdefault("preset", recommended)
    chosen.setdefault("source_detector_mm", technique.source_detector_mm)
    distances = (chosen.get("source_object_mm"), chosen.get("object_detector_mm"))
    if distances == (None, None) and technique.object_detector_mm is not None:
        chosen["object_detector_mm"] = technique.object_detector_mm
    try:
        return validate_model(Preset, chosen)
    except InvalidInputError as error:
        raise InvalidInputError(_moved(error.problems, {"": "/view"})) from None


def _placed(phantom: Phantom, wanted: PlacedView, grid: DetectorGrid) -> View:
    """Return the view with its source and detector where the request puts them."""
    pose = wanted.detector.model_dump()
    size = {"columns": grid.columns, "rows": grid.rows, "pitch_mm": grid.pitch_mm or 1.0}
    tree = {"source": wanted.source, "direction": wanted.direction, "detector": {**pose, **size}}
    try:
        view = validate_model(View, tree)
    except InvalidInputError as error:
        homes = {f"/detector/{name}": f"/detector/{name}" for name in size}
        raise InvalidInputError(_moved(error.problems, {**homes, "": "/view"})) from None
    return view if grid.pitch_mm is not None else covering(phantom, view)


def _moved(problems: tuple[Problem, ...], homes: Mapping[str, str]) -> list[Problem]:
    """Return the problems with the first prefix that fits replaced by the request's own."""
    moved = []
    for problem in problems:
        prefix = next(prefix for prefix in homes if problem.path.startswith(prefix))
        path = homes[prefix] + problem.path.removeprefix(prefix)
        moved.append(Problem(path, problem.kind, problem.message))
    return moved
