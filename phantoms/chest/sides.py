"""How the right half of a skeleton differs from the mirror image of the left.

Each right rib is turned a little about its head, up or down in front, and the right shoulder hangs
a little lower. How much is an estimate: by a third of a degree a rib, a degree the shoulder; never
so far that a rib comes to a lung.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.document import Point, Rotation, Solid, Transformed

FloatArray = NDArray[np.float64]
SIDES: Final = ("right", "left")
_MIRROR: Final = ((-1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
_MOST: Final = 2.0
"""Standard deviations at which a draw is cut."""


@dataclass(frozen=True)
class Sides:
    """What turns the left half into the right one.

    Attributes
    ----------
    ribs_deg
        By how much each right rib, first to twelfth, is turned forward end up.
    shoulder_deg
        By how much the right shoulder hangs lower, about the inner end of the collar bone.
    """

    ribs_deg: tuple[float, ...]
    shoulder_deg: float

    @classmethod
    def drawn(cls, share: float, seed: int) -> Sides:
        """Draw the differences; ``share`` 0 is none, 1 the usual ones."""
        numbers = np.random.default_rng((seed, 3)).standard_normal(14)
        all_ribs, shoulder, *each = np.clip(numbers, -_MOST, _MOST).tolist()
        ribs = tuple(share * (0.2 * all_ribs + 0.12 * own) for own in each)
        return cls(ribs, share * (0.8 + 0.3 * shoulder))

    def rib(self, number: int, head: Point) -> Rotation:
        """Return what turns the mirror image of a left rib into the right one."""
        turn = -self.ribs_deg[number - 1]
        return Rotation(axis=(1.0, 0.0, 0.0), angle_deg=turn, about=(0.0, head[1], head[2]))

    def shoulder(self, joint: Point) -> Rotation:
        """Return what turns the mirror image of the left shoulder into the right one."""
        x, y, z = joint
        return Rotation(axis=(0.0, 1.0, 0.0), angle_deg=-self.shoulder_deg, about=(-x, y, z))


def on_side(solid: Solid, side: str, turn: Rotation, name: str | None = None) -> Transformed:
    """Return a solid that is drawn on the left on its own or the other side."""
    if side == "left":
        return Transformed(type="transformed", name=name, solid=solid)
    image = Transformed(type="transformed", solid=solid, matrix=_MIRROR)
    return Transformed(type="transformed", name=name, solid=image, rotate=turn)


def point_on_side(point: FloatArray, side: str, turn: Rotation) -> FloatArray:
    """Return where a point of the left is on a side, the turn about an axis along x."""
    if side == "left":
        return point
    c, s = math.cos(math.radians(turn.angle_deg)), math.sin(math.radians(turn.angle_deg))
    _, y0, z0 = turn.about
    y, z = point[1] - y0, point[2] - z0
    return np.array([-point[0], y0 + c * y - s * z, z0 + s * y + c * z])
