"""Where a camera stands for the left and for the right eye.

``shift``: the camera moves by half the baseline against its own right, and with it; it looks the
same way, and its window slides in its plane so that what is in the screen keeps its column.
``rotate``: the camera goes round the target, about the picture's vertical.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.stereo import Stereo, ZeroPlane
from phantom.visible.camera import Camera, Floats
from phantom.visible.lights import DirectionalLight, Lighting, PointLight, placed

LEFT: Final = -1.0
RIGHT: Final = 1.0


@dataclass(frozen=True)
class CameraPair:
    """The cameras of both eyes.

    Attributes
    ----------
    left, right
        One and the same for a mono arm.
    baseline_mm, angle_deg, zero_depth_mm
        Between the eyes; between their lines to the target; depth of what is seen in the screen
        from the camera between them. None for a mono arm, and the first and last for parallel ones.
    """

    left: Camera
    right: Camera
    baseline_mm: float | None
    angle_deg: float | None
    zero_depth_mm: float | None


def check_cameras(camera: Camera, stereo: Stereo) -> None:
    """Refuse what a pair in visible light does not have.

    Raises
    ------
    InvalidInputError
        A dose (``/stereo/dose``), a detector or a depth for parallel lines of sight
        (``/stereo/zero_parallax``), a shift of those (``/stereo/method``).
    """
    problems = []
    if "dose" in stereo.model_fields_set:
        message = f"found {stereo.dose!r}, but visible light has no dose; expected none"
        problems.append(Problem("/stereo/dose", "no_effect", message))
    if stereo.zero_parallax == "detector":
        message = "found 'detector', but a camera has none; expected 'isocentre' or a plane_mm"
        problems.append(Problem("/stereo/zero_parallax", "no_detector", message))
    if camera.parallel_width_mm is not None and stereo.mono is None:
        if stereo.method == "shift":
            message = "found 'shift' with parallel lines of sight; expected 'rotate'"
            problems.append(Problem("/stereo/method", "no_source", message))
        if isinstance(stereo.zero_parallax, ZeroPlane):
            message = "found a depth from the eye, but parallel lines of sight have none"
            problems.append(Problem("/stereo/zero_parallax/plane_mm", "no_source", message))
    if problems:
        raise InvalidInputError(problems)


def cameras(camera: Camera, stereo: Stereo, separation: float) -> CameraPair:
    """Return the cameras of both eyes.

    Parameters
    ----------
    camera
        The one between them; the isocentre of a pair is its target.
    stereo
        Method, plane of zero parallax, and whether there is depth at all.
    separation
        The baseline in mm, or the angle in degrees, as the method has it.

    Raises
    ------
    InvalidInputError
        As :func:`check_cameras`; or an eye that is beyond the world (``/stereo``).
    """
    check_cameras(camera, stereo)
    if stereo.mono is not None:
        return CameraPair(camera, camera, None, None, None)
    eye, forward = np.asarray(camera.eye, dtype=np.float64), camera.axes[2]
    target = np.asarray(camera.target, dtype=np.float64)
    anchor = target
    if isinstance(stereo.zero_parallax, ZeroPlane):
        anchor = eye + stereo.zero_parallax.plane_mm * forward
    try:
        left, right = (
            _slid(_moved(camera, stereo, side * separation / 2), camera, anchor)
            for side in (LEFT, RIGHT)
        )
    except InvalidInputError as error:
        message = f"these values put an eye where it cannot be: {error}"
        raise InvalidInputError([Problem("/stereo", "out_of_range", message)]) from None
    ways = [target - np.asarray(one.eye) for one in (left, right)]
    sine = float(np.linalg.norm(np.cross(ways[0], ways[1])))
    angle_deg = math.degrees(math.atan2(sine, float(ways[0] @ ways[1])))
    if camera.parallel_width_mm is not None:
        return CameraPair(left, right, None, angle_deg, None)
    depth_mm = float((anchor - eye) @ forward)
    return CameraPair(left, right, math.dist(left.eye, right.eye), angle_deg, depth_mm)


def _moved(camera: Camera, stereo: Stereo, by: float) -> Camera:
    """Return the camera moved by so many mm to its right, or turned by so many degrees."""
    right, down, forward = camera.axes
    eye, target = np.asarray(camera.eye), np.asarray(camera.target)
    if stereo.method == "shift":
        return _with(camera, eye=eye + by * right, target=target + by * right)
    distance = float(np.linalg.norm(target - eye))
    turn = math.radians(by)
    eye = target + distance * (math.sin(turn) * right - math.cos(turn) * forward)
    return _with(camera, eye=eye, up=-down)


def _slid(eye: Camera, camera: Camera, anchor: Floats) -> Camera:
    """Return an eye with its window slid: the anchor's column is that of the camera between."""
    wanted, found = (float(one.project(anchor)[0][0]) for one in (camera, eye))
    if not math.isfinite(found):
        message = "the plane of zero parallax lies beside or behind an eye"
        raise InvalidInputError([Problem("/stereo/zero_parallax", "behind_source", message)])
    return _with(eye, shift_px=eye.shift_px + found - wanted)


def _with(camera: Camera, **fields: object) -> Camera:
    return Camera(**{**camera.model_dump(exclude_none=True), **fields})


def fixed(lighting: Lighting, camera: Camera) -> Lighting:
    """Return the light with every lamp where the camera has it: the same for both eyes."""
    found: list[DirectionalLight | PointLight] = []
    for light in lighting.lights:
        at = tuple(placed(light, camera)[0].tolist())
        where = {"to_light" if isinstance(light, DirectionalLight) else "position": at}
        found.append(light.model_copy(update={**where, "fixed_to": "world"}))
    return lighting.model_copy(update={"lights": tuple(found)})
