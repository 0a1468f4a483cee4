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

from phantom.document import Point

Rows = tuple[tuple[float, float, float, float], ...]
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
        return cls(ribs, share * (0.9 + 0.5 * shoulder))

    def rib(self, number: int, head: Point) -> Rows:
        """Return the rows of the map from a left rib to the right one."""
        _, y, z = head
        turn = math.radians(self.ribs_deg[number - 1])
        c, s = math.cos(turn), math.sin(turn)
        # About the axis x through the head, whose front lies at lower y.
        return (
            (-1.0, 0.0, 0.0, 0.0),
            (0.0, c, s, y - c * y - s * z),
            (0.0, -s, c, z + s * y - c * z),
        )

    def shoulder(self, joint: Point) -> Rows:
        """Return the rows of the map from the left shoulder to the right one."""
        x, _, z = joint
        turn = math.radians(self.shoulder_deg)
        c, s = math.cos(turn), math.sin(turn)
        # Mirrored, then turned about the axis y through the right joint, at -x.
        return (
            (-c, 0.0, -s, c * x + s * z - x),
            (0.0, 1.0, 0.0, 0.0),
            (-s, 0.0, c, s * x - c * z + z),
        )
