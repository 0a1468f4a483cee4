"""Rigid motions of a knee's bones: a turn in the frontal plane, then a shift."""

from __future__ import annotations

import math
from dataclasses import dataclass

from phantom.document import Cut, Point, Solid, Transformed, Vector

ORIGIN: Point = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Pose:
    """A turn by ``angle_deg`` about the y axis through ``about``, then a shift, in mm.

    A positive angle lifts what lies at +x.
    """

    shift: Vector = ORIGIN
    angle_deg: float = 0.0
    about: Point = ORIGIN

    def point(self, at: Point) -> Point:
        """Return where a point goes."""
        turned = _turned(at, self.about, self.angle_deg)
        return (turned[0] + self.shift[0], turned[1] + self.shift[1], turned[2] + self.shift[2])

    def solid(self, name: str, solid: Solid) -> Transformed:
        """Return a solid moved, its name before the labels of its leaves."""
        x, y, z = (self.vector(axis) for axis in ((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)))
        at = self.point(ORIGIN)
        rows = tuple((x[i], y[i], z[i], at[i]) for i in range(3))
        return Transformed(type="transformed", name=name, solid=solid, matrix=rows)

    def vector(self, along: Vector) -> Vector:
        """Return where a direction turns."""
        return _turned(along, ORIGIN, self.angle_deg)

    def back(self, cut: Cut) -> Cut:
        """Return the plane that this motion brings to ``cut``."""
        x, y, z = (p - s for p, s in zip(cut.point, self.shift, strict=True))
        return Cut(
            point=_turned((x, y, z), self.about, -self.angle_deg),
            normal=_turned(cut.normal, ORIGIN, -self.angle_deg),
        )

    def then(self, shift: Vector) -> Pose:
        """Return this motion followed by a shift."""
        x, y, z = (a + b for a, b in zip(self.shift, shift, strict=True))
        return Pose((x, y, z), self.angle_deg, self.about)


def _turned(at: Point, about: Point, angle_deg: float) -> Point:
    angle = math.radians(angle_deg)
    cos, sin = math.cos(angle), math.sin(angle)
    x, z = at[0] - about[0], at[2] - about[2]
    return (about[0] + cos * x - sin * z, at[1], about[2] + sin * x + cos * z)
