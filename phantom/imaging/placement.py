"""A clinical word and its distances, placed around a phantom.

The central ray runs from the source through the isocentre to the middle of the detector, and meets
it at a right angle. The default detector is a preview that covers what is X-rayed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.geometry.vectors import box_corners
from phantom.imaging.camera import projection
from phantom.imaging.poses import DEFAULT_ANGLE_DEG, DEFAULT_LATERALITY, Laterality, Pose, pose
from phantom.imaging.presets import PREVIEW_PIXELS, DetectorGrid, Preset
from phantom.imaging.view import MAX_PITCH_MM, MIN_PITCH_MM, Detector, View

if TYPE_CHECKING:
    from phantom.scene import Phantom

COVER_MARGIN: Final = 1.05
"""The default detector is this much larger than the shadow of the phantom's bounding box."""

OBJECT_DETECTOR_MM: Final = 100.0
CLEARANCE_MM: Final = 10.0
"""A default detector stands at least this far behind the phantom's bounding box."""

_SIDES: Final[dict[str, Laterality]] = {"left": "left", "l": "left", "right": "right", "r": "right"}
"""How a document may write its side; anything else (``bilateral``, nothing) gives the default."""


def place(phantom: Phantom, preset: Preset, grid: DetectorGrid | None = None) -> View:
    """Return the view of a preset around a phantom.

    Without distances the isocentre is 100 mm before the detector, or as far as it takes for the
    detector to stand 10 mm clear of the phantom.

    Raises
    ------
    InvalidInputError
        With paths under ``/view`` and ``/detector``.
    """
    grid = grid if grid is not None else DetectorGrid()
    aim = np.asarray(
        preset.isocentre if preset.isocentre is not None else phantom.isocentre, dtype=np.float64
    )
    at = _pose(phantom, preset)
    corners = box_corners(phantom.bounds) - aim
    behind = _object_detector_mm(preset, float(np.max(corners @ at.beam)))
    source = aim - (preset.source_detector_mm - behind) * at.beam
    try:
        detector = Detector(
            center=aim + behind * at.beam,
            right=at.right,
            down=at.down,
            columns=grid.columns,
            rows=grid.rows,
            pitch_mm=1.0 if grid.pitch_mm is None else grid.pitch_mm,
        )
        view = View(source=source, detector=detector)
    except InvalidInputError as error:
        # Only the distances can still be wrong, and the caller gave no source and no centre.
        message = f"these distances put tube or detector where they cannot be: {error}"
        raise InvalidInputError([Problem("/view", "out_of_range", message)]) from None
    return view if grid.pitch_mm is not None else covering(phantom, view)


def covering(phantom: Phantom, view: View) -> View:
    """Return the view with the square pitch at which the detector covers the phantom.

    The shadow of the phantom's bounding box fits with 5 % to spare about the detector's centre; the
    pitch is rounded up to three digits.

    Raises
    ------
    InvalidInputError
        The box reaches behind the source, or is too large (``/detector/pitch_mm``).
    """
    detector = view.detector
    pixels = np.array([detector.columns, detector.rows], dtype=np.float64)
    shadow = projection(view).project(box_corners(phantom.bounds)) - (pixels - 1) / 2
    if not np.isfinite(shadow).all():
        message = "the phantom reaches behind the source, so no detector covers it; give a pitch"
        raise InvalidInputError([Problem("/detector/pitch_mm", "missing", message)])
    widths_mm = 2 * np.abs(shadow).max(axis=0) * detector.pitch_xy_mm
    needed = max(float((widths_mm / pixels).max()) * COVER_MARGIN, MIN_PITCH_MM)
    if needed > MAX_PITCH_MM:
        message = f"the phantom needs a pitch of {needed:.4g} mm; expected {MAX_PITCH_MM:g} at most"
        raise InvalidInputError([Problem("/detector/pitch_mm", "out_of_range", message)])
    digits = 2 - math.floor(math.log10(needed))
    pitch_mm = math.ceil(round(needed * 10.0**digits, 6)) / 10.0**digits
    return View(
        source=view.source,
        direction=view.direction,
        detector=Detector(**{**detector.model_dump(), "pitch_mm": pitch_mm}),
    )


def _pose(phantom: Phantom, preset: Preset) -> Pose:
    anatomy = phantom.document.anatomy
    own = anatomy.laterality if anatomy is not None else None
    return pose(
        preset.preset,
        laterality=preset.laterality or _SIDES.get((own or "").lower(), DEFAULT_LATERALITY),
        angle_deg=DEFAULT_ANGLE_DEG if preset.angle_deg is None else preset.angle_deg,
        primary_angle_deg=preset.primary_angle_deg or 0.0,
        secondary_angle_deg=preset.secondary_angle_deg or 0.0,
    )


def _object_detector_mm(preset: Preset, depth_mm: float) -> float:
    """Return the distance from isocentre to detector; ``depth_mm`` of phantom lies behind it."""
    if preset.object_detector_mm is not None:
        return preset.object_detector_mm
    if preset.source_object_mm is not None:
        return preset.source_detector_mm - preset.source_object_mm
    behind = max(OBJECT_DETECTOR_MM, depth_mm + CLEARANCE_MM)
    if behind >= preset.source_detector_mm:
        message = (
            f"found {preset.source_detector_mm:g} mm, but the phantom needs {behind:g} mm between "
            "isocentre and detector; expected a longer distance"
        )
        raise InvalidInputError([Problem("/view/source_detector_mm", "too_near", message)])
    return behind


def preset_view(
    phantom: Phantom,
    preset: str,
    *,
    columns: int = PREVIEW_PIXELS,
    rows: int = PREVIEW_PIXELS,
    pitch_mm: float | tuple[float, float] | None = None,
    **placing: Any,
) -> View:
    """Return a view by its clinical word.

    Parameters
    ----------
    phantom
        What the view is placed around.
    preset
        ``ap pa left_lateral right_lateral mediolateral lateromedial cc mlo lao rao lpo rpo c_arm``.
    columns, rows, pitch_mm
        The detector's grid; without a pitch it covers the phantom with 5 % to spare.
    **placing
        Any other field of :class:`Preset`, such as ``source_detector_mm`` or ``angle_deg``.
    """
    problems: list[Problem] = []
    try:
        word = Preset(preset=preset, **placing)
    except InvalidInputError as error:
        problems += error.problems
    try:
        grid = DetectorGrid(columns=columns, rows=rows, pitch_mm=pitch_mm)
    except InvalidInputError as error:
        problems += error.problems
    if problems:
        raise InvalidInputError(problems)
    return place(phantom, word, grid)
