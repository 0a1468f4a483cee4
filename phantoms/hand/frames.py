"""Where each tubular bone of the hand stands: chains of frames from the wrist to the fingertips."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from phantom.document import Point, Solid, Transformed
from phantoms.hand.sizes import DIGITS, DISTAL, METACARPAL, MIDDLE, PROXIMAL

FloatArray = NDArray[np.float64]


class Frame(NamedTuple):
    """A bone's place: its base's middle, and its x, y and z axes as columns."""

    origin: FloatArray
    axes: FloatArray

    def point(self, local: tuple[float, float, float]) -> FloatArray:
        """Return a point of the bone's frame in the hand's."""
        placed: FloatArray = self.origin + self.axes @ np.array(local)
        return placed

    def local(self, point: FloatArray) -> Point:
        """Return a point of the hand's frame in the bone's."""
        x, y, z = self.axes.T @ (point - self.origin)
        return (float(x), float(y), float(z))

    def placed(self, name: str | None, solid: Solid) -> Transformed:
        """Return a solid drawn in the bone's frame where the bone is; None adds no name."""
        rows = np.column_stack([self.axes, self.origin])
        matrix = tuple(tuple(float(value) for value in row) for row in rows)
        return Transformed(type="transformed", name=name, solid=solid, matrix=matrix)


class Pose(NamedTuple):
    """A ray of the hand: the middle of its metacarpal's base, and how each bone leans, in degrees.

    ``lean`` is toward the thumb, ``rise`` toward the back of the hand, one for each bone; ``roll``
    turns the ray about itself, so that its back faces the thumb's side.
    """

    base: Point
    lean: tuple[float, ...]
    rise: tuple[float, ...]
    roll: float = 0.0


POSES: Final[dict[str, Pose]] = {
    "thumb": Pose((29.4, -8.8, -7.9), (37.0, 30.0, 26.0), (-14.0, -8.0, -2.0), 38.0),
    "index": Pose((15.4, 2.4, -4.1), (5.2, 8.5, 7.5, 6.5), (-1.5, -6.0, -6.0, -3.0)),
    "middle": Pose((0.6, 2.5, 0.0), (1.0, 1.5, 0.5, -0.5), (-1.5, -3.0, -3.0, 0.0)),
    "ring": Pose((-12.1, 1.8, -2.0), (-6.0, -6.0, -5.0, -4.0), (-2.0, -0.5, -1.0, 1.0)),
    "little": Pose((-22.9, 0.0, -3.9), (-12.0, -16.0, -13.0, -10.0), (-3.0, 2.0, 1.0, 3.0)),
}

KINDS: Final[dict[str, tuple[str, ...]]] = {
    digit: (METACARPAL, PROXIMAL, DISTAL)
    if digit == "thumb"
    else (METACARPAL, PROXIMAL, MIDDLE, DISTAL)
    for digit in DIGITS
}
"""The bones of each ray, from the wrist outward."""


def _axes(lean_deg: float, rise_deg: float, roll_deg: float) -> FloatArray:
    lean, rise, roll = (math.radians(angle) for angle in (lean_deg, rise_deg, roll_deg))
    along = np.array(
        [math.sin(lean) * math.cos(rise), math.sin(rise), math.cos(lean) * math.cos(rise)]
    )
    across = np.array([math.cos(lean), 0.0, -math.sin(lean)])
    back = np.cross(along, across)
    turned = math.cos(roll) * across - math.sin(roll) * back
    return np.column_stack([turned, np.cross(along, turned), along])


def chain(
    digit: str, scale: float, lengths_mm: tuple[float, ...], gaps_mm: tuple[float, ...]
) -> list[Frame]:
    """Return the frames of a ray's bones.

    Parameters
    ----------
    lengths_mm
        Of each bone, from the wrist outward.
    gaps_mm
        Between each bone and the next.
    """
    pose = POSES[digit]
    at = scale * np.array(pose.base)
    frames = []
    for index, length in enumerate(lengths_mm):
        axes = _axes(pose.lean[index], pose.rise[index], pose.roll)
        frames.append(Frame(at, axes))
        at = at + length * axes[:, 2]
        if index < len(gaps_mm):
            at = at + gaps_mm[index] * _axes(pose.lean[index + 1], pose.rise[index + 1], 0.0)[:, 2]
    return frames
