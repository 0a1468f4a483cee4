"""Where tube and detector stand for the left and for the right eye.

The left eye is where the tube is moved against the detector's ``right``. With the tube at x = S,
z = 0, the detector in the plane z = D, and e = -b/2 or +b/2, a point (X, z) falls on
x = S + e + (X - S - e) D/z. The window of each eye slides along its rows, by e (1 - D/z₀), so that
the plane z₀ falls on the same columns in both. What is left is

    disparity = left column - right column = b D (1/z - 1/z₀) / pitch,

above 0 (crossed) for what is nearer to the tube than z₀. Rows do not depend on e.

``rotate`` turns the whole view about the picture's vertical through the isocentre, by -a/2 and
+a/2: the object turns the other way before a tube that stands still.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.camera import projection
from phantom.imaging.view import Detector, FloatArray, View
from phantom.stereo import Stereo, ZeroPlane

LEFT: Final = -1.0
RIGHT: Final = 1.0


@dataclass(frozen=True, eq=False)
class Eyes:
    """The views of both eyes.

    Attributes
    ----------
    left, right
        Views; one and the same for a mono arm.
    baseline_mm
        Between the two sources; None for parallel beams and for a mono arm.
    angle_deg
        Between the two rays through the isocentre; None for a mono arm.
    zero_depth_mm
        Depth of what is seen in the screen, from the source along the detector's normal in the view
        between the eyes; None for parallel beams and for a mono arm.
    """

    left: View
    right: View
    baseline_mm: float | None
    angle_deg: float | None
    zero_depth_mm: float | None


def eyes(view: View, stereo: Stereo, separation: float, isocentre: FloatArray) -> Eyes:
    """Return the views of the two eyes.

    Parameters
    ----------
    view
        The one between them.
    stereo
        Method, plane of zero parallax, and whether there is depth at all.
    separation
        The baseline in mm, or the angle in degrees, as the method has it.
    isocentre
        (3,) world point: the default of zero parallax, and what a rotation is about.

    Raises
    ------
    InvalidInputError
        See :func:`check_stereo`; or an eye that is beyond the world (``/stereo``).
    """
    check_stereo(view, stereo, isocentre)
    if stereo.mono is not None:
        return Eyes(view, view, None, None, None)
    anchor = _anchor(view, stereo, isocentre)
    try:
        left, right = (
            _slid(_placed(view, stereo, separation, isocentre, side), view, anchor)
            for side in (LEFT, RIGHT)
        )
    except InvalidInputError as error:
        if error.problems[0].path.startswith("/stereo"):
            raise
        message = f"these values put tube or detector where they cannot be: {error}"
        raise InvalidInputError([Problem("/stereo", "out_of_range", message)]) from None
    angle_deg = _angle_deg(left, right, isocentre)
    if view.source is None or left.source is None or right.source is None:
        return Eyes(left, right, None, angle_deg, None)
    depth_mm = float(projection(view).depth_mm(anchor[np.newaxis])[0])
    return Eyes(left, right, math.dist(left.source, right.source), angle_deg, depth_mm)


def check_stereo(view: View, stereo: Stereo, isocentre: FloatArray) -> None:
    """Refuse a pair that has no geometry.

    Raises
    ------
    InvalidInputError
        A parallel beam that is to be shifted (``/stereo/method``) or whose plane of zero parallax
        is given from a source (``/stereo/zero_parallax/plane_mm``); an isocentre beside or behind
        the source (``/stereo/zero_parallax``, or ``/stereo/method`` of a rotation about it).
    """
    if stereo.mono is not None:
        return
    if view.source is None:
        problems = []
        if stereo.method == "shift":
            message = "found 'shift' with a parallel beam, which has no source; expected 'rotate'"
            problems.append(Problem("/stereo/method", "no_source", message))
        if isinstance(stereo.zero_parallax, ZeroPlane):
            message = "found a depth from the source, but a parallel beam has none"
            problems.append(Problem("/stereo/zero_parallax/plane_mm", "no_source", message))
        if problems:
            raise InvalidInputError(problems)
        return
    depth = float(projection(view).depth_mm(isocentre[None])[0])
    if depth > 0.0:
        return
    message = f"found the isocentre {-depth:g} mm beside or behind the source; expected it before"
    if stereo.method == "rotate":
        raise InvalidInputError([Problem("/stereo/method", "behind_source", message)])
    if stereo.zero_parallax == "isocentre":
        raise InvalidInputError([Problem("/stereo/zero_parallax", "behind_source", message)])


def _anchor(view: View, stereo: Stereo, isocentre: FloatArray) -> FloatArray:
    """Return the world point that both eyes see on the column of the view between them."""
    if stereo.zero_parallax == "isocentre":
        return np.asarray(isocentre, dtype=np.float64)
    center = np.asarray(view.detector.center, dtype=np.float64)
    if not isinstance(stereo.zero_parallax, ZeroPlane) or view.source is None:
        return center
    # On the central ray, at that depth.
    source = np.asarray(view.source, dtype=np.float64)
    distance = projection(view).distance_mm
    assert distance is not None
    return source + (center - source) * (stereo.zero_parallax.plane_mm / distance)


def _placed(view: View, stereo: Stereo, separation: float, pivot: FloatArray, side: float) -> View:
    """Return the view of an eye before its window slides."""
    right, down = view.detector.axes
    if stereo.method == "shift":
        assert view.source is not None
        source = np.asarray(view.source) + (0.5 * side * separation) * right
        return View(source=source, detector=view.detector)
    # Seen from the tube, a turn about ``down`` moves it to the right where the normal of the
    # detector points away from it.
    mirror = 1.0 if projection(view).rotation[2] @ view.detector.normal > 0 else -1.0
    turn = _rotation(down, -mirror * 0.5 * side * math.radians(separation))
    detector = Detector(
        **{
            **view.detector.model_dump(),
            "center": pivot + turn @ (np.asarray(view.detector.center) - pivot),
            "right": turn @ right,
            "down": turn @ down,
        }
    )
    if view.source is None:
        return View(source=None, direction=turn @ np.asarray(view.direction), detector=detector)
    return View(source=pivot + turn @ (np.asarray(view.source) - pivot), detector=detector)


def _rotation(axis: FloatArray, angle_rad: float) -> FloatArray:
    """Return the (3, 3) right-handed rotation about a unit vector (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(
        np.eye(3) + math.sin(angle_rad) * cross + (1.0 - math.cos(angle_rad)) * cross @ cross
    )


def _slid(eye: View, view: View, anchor: FloatArray) -> View:
    """Return an eye with its window moved along its rows: the anchor's column is the view's."""
    wanted, found = (projection(v).project(anchor[None])[0, 0] for v in (view, eye))
    if not math.isfinite(found):
        message = "the plane of zero parallax lies at or behind the tube"
        raise InvalidInputError([Problem("/stereo/zero_parallax", "behind_source", message)])
    right, _ = eye.detector.axes
    moved = (found - wanted) * eye.detector.pitch_xy_mm[0] * right
    center = np.asarray(eye.detector.center) + moved
    detector = Detector(**{**eye.detector.model_dump(), "center": center})
    return View(source=eye.source, direction=eye.direction, detector=detector)


def _angle_deg(left: View, right: View, point: FloatArray) -> float:
    """Return the angle between the rays of both eyes through a point."""
    one, other = (
        np.asarray(eye.direction) if eye.source is None else point - np.asarray(eye.source)
        for eye in (left, right)
    )
    sine = float(np.linalg.norm(np.cross(one, other)))
    return math.degrees(math.atan2(sine, float(one @ other)))
