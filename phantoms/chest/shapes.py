"""Shapes of soft parts and long bones: tubes along a curve, and columns of sections along z."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from phantom.document import (
    CircleContour,
    Cone,
    Cut,
    Cylinder,
    EllipseContour,
    GeneralizedCylinder,
    KnotProfile,
    LinearSweep,
    Point,
    Solid,
    SplineAxis,
    SplineContour,
    SuperellipseContour,
    UpFrame,
)
from phantoms.parts import chord_lengths, knots

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    from phantoms.chest.frame import Frame

Row = tuple[float, float, float, float, float]
"""A section of a column: z, its reach in x (right, left) and in y (front, back)."""

Shape = SplineContour | SuperellipseContour | EllipseContour | CircleContour
OVAL: Final = EllipseContour(type="ellipse", semi_axes=(1.0, 1.0))
_UP: Final = UpFrame(up=(1.0, 0.0, 0.0))


def rounded(exponent: float) -> SuperellipseContour:
    """Return the outline between an ellipse and the square [-1, 1]²."""
    return SuperellipseContour(type="superellipse", semi_axes=(1.0, 1.0), exponent=exponent)


def tube(
    name: str | None, points: Sequence[Point], radii: Sequence[float], material: str | None
) -> GeneralizedCylinder:
    """Return a round tube along a curve through points, with these radii there (mm)."""
    at = chord_lengths(points)
    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material=material,
        axis=SplineAxis(type="spline", points=tuple(points)),
        contour=CircleContour(type="circle", radius=1.0),
        sweep=LinearSweep(type="linear", scale=knots(at, radii)),
    )


def cone(
    name: str | None, start: Point, end: Point, radii: tuple[float, float], material: str
) -> Cone:
    """Return a piece of a tube between two points."""
    return Cone(
        type="cone",
        name=name,
        material=material,
        start=start,
        end=end,
        start_radius=radii[0],
        end_radius=radii[1],
    )


def chain(name: str, points: Sequence[Point], radii: Sequence[float], material: str) -> list[Solid]:
    """Return a tube drawn as cones end to end, which build faster than one curve."""
    ends = list(zip(points, radii, strict=True))
    return [
        cone(f"{name} {number}", a, b, (ra, rb), material)
        for number, ((a, ra), (b, rb)) in enumerate(pairwise(ends), 1)
    ]


def bar(
    name: str,
    start: Point,
    end: Point,
    semi_axes: tuple[float, float],
    up: tuple[float, float, float],
    material: str,
) -> Cylinder:
    """Return an elliptic cylinder, the first semi-axis along ``up``."""
    return Cylinder(
        type="cylinder",
        name=name,
        material=material,
        start=start,
        end=end,
        semi_axes=semi_axes,
        up=up,
    )


def sampled(rows: Sequence[Row], count: int) -> list[Row]:
    """Return ``count`` rows along a table, without overshoot between its rows."""
    import numpy as np
    from scipy.interpolate import PchipInterpolator

    table = np.array(sorted(rows))
    z = np.linspace(table[0, 0], table[-1, 0], count)
    others = PchipInterpolator(table[:, 0], table[:, 1:])(z)
    return [(float(h), *map(float, row)) for h, row in zip(z, others, strict=True)]  # type: ignore[misc]


def column(
    name: str | None,
    rows: Sequence[Row],
    material: str | None,
    shape: Shape = OVAL,
    *,
    turn_deg: float = 0.0,
    cuts: Sequence[Cut] = (),
) -> GeneralizedCylinder:
    """Return a solid whose sections along z fill these rows (mm, in the body)."""
    rows = sorted(rows)
    points = [(0.0, 0.0, row[0]) for row in rows]
    at = chord_lengths(points)

    def profile(values: list[float]) -> KnotProfile:
        return knots(at, values)

    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material=material,
        axis=SplineAxis(type="spline", points=tuple(points)),
        contour=shape,
        sweep=LinearSweep(
            type="linear",
            scale=(
                profile([(row[2] - row[1]) / 2 for row in rows]),
                profile([(row[4] - row[3]) / 2 for row in rows]),
            ),
            offset=(
                profile([(row[2] + row[1]) / 2 for row in rows]),
                profile([(row[4] + row[3]) / 2 for row in rows]),
            ),
        ),
        frame=_UP,
        cuts=tuple(cuts),
    )


def fitted(frame: Frame, rows: Sequence[Row]) -> list[Row]:
    """Return drawn rows as this person has them."""
    result: list[Row] = []
    for z, right, left, front, back in rows:
        height = z * frame.z
        lean = frame.lean(height)
        result.append(
            (height, right * frame.x, left * frame.x, front * frame.y + lean, back * frame.y + lean)
        )
    return result


def grown(rows: Sequence[Row], by_mm: float) -> list[Row]:
    """Return rows that reach farther on each side."""
    return [(z, r - by_mm, lt + by_mm, f - by_mm, b + by_mm) for z, r, lt, f, b in rows]
