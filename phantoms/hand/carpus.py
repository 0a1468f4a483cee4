"""The eight carpal bones: outlines as seen from the front, swept from the palm to the back.

Outlines and depths are estimates for a person of mean size, drawn to the arrangement that a
postero-anterior radiograph shows: the capitate in the middle with the lunate under its head, the
scaphoid slanting across both rows, joints 1 to 2 mm wide.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from phantom.document import (
    GeneralizedCylinder,
    KnotProfile,
    LinearSweep,
    LineAxis,
    Solid,
    SplineContour,
    UpFrame,
)
from phantoms.hand.frames import FloatArray
from phantoms.hand.tubular import CORTEX, SPONGIOSA
from phantoms.parts import layered, named

Outline = tuple[tuple[float, float], ...]
SHELL_MM: Final = 0.5
"""Thickness of the carpal bones' cortex; an estimate."""


class Carpal(NamedTuple):
    """A carpal bone: its outline (x, z), where its palmar and back faces are, and its slant.

    ``slant`` is how far the outline moves along x and z in each mm from y = 0 toward the back.
    """

    outline: Outline
    palm_mm: float
    back_mm: float
    slant: tuple[float, float] = (0.0, 0.0)


CARPALS: Final[dict[str, Carpal]] = {
    "capitate": Carpal(
        (
            (5.8, -1.6), (6.8, -5.0), (6.1, -9.5), (5.6, -13.5), (6.2, -17.8),
            (4.8, -21.9), (0.8, -24.0), (-3.4, -22.8), (-6.0, -18.6), (-5.8, -13.5),
            (-6.8, -8.0), (-6.8, -3.2), (-4.8, -1.3), (0.8, -1.3),
        ),
        -9.0, 10.5, (0.06, 0.0),
    ),
    "hamate": Carpal(
        (
            (-8.8, -3.3), (-12.0, -3.4), (-16.0, -4.6), (-18.4, -6.9), (-21.8, -8.4),
            (-25.0, -10.4), (-24.4, -13.0), (-20.4, -16.2), (-15.6, -19.6), (-10.4, -22.3),
            (-7.9, -21.6), (-7.6, -17.0), (-7.8, -12.0), (-8.3, -7.0),
        ),
        -7.5, 9.0, (0.06, 0.0),
    ),
    "trapezoid": Carpal(
        (
            (8.6, -5.9), (12.6, -5.9), (17.2, -6.3), (18.4, -9.6), (17.4, -14.2),
            (13.8, -17.6), (9.2, -17.3), (7.6, -13.6), (8.2, -9.0),
        ),
        -4.5, 10.0, (0.3, 0.0),
    ),
    "trapezium": Carpal(
        (
            (20.6, -6.8), (24.4, -8.2), (28.9, -11.2), (32.4, -14.8), (32.0, -18.6),
            (28.2, -21.0), (23.2, -21.6), (19.2, -19.4), (18.6, -15.0), (19.5, -10.0),
        ),
        -14.6, 0.5, (0.3, 0.0),
    ),
    "scaphoid": Carpal(
        (
            (6.2, -30.2), (6.4, -26.2), (7.6, -22.0), (10.6, -19.1), (15.4, -19.3),
            (18.8, -22.4), (23.0, -24.2), (26.0, -25.2), (25.4, -27.8), (21.4, -29.4),
            (17.4, -31.2), (13.8, -33.8), (9.6, -35.4), (6.8, -33.8),
        ),
        -8.0, 6.5, (-0.12, -0.06),
    ),
    "lunate": Carpal(
        (
            (4.9, -31.6), (5.1, -28.4), (4.7, -26.0), (2.8, -25.7), (-0.4, -26.0),
            (-3.8, -25.0), (-6.8, -23.4), (-8.8, -25.0), (-9.6, -28.2), (-9.2, -32.2),
            (-6.6, -35.4), (-2.4, -36.6), (1.8, -36.0), (4.2, -34.4),
        ),
        -9.0, 9.0, (-0.04, -0.06),
    ),
    "triquetrum": Carpal(
        (
            (-11.2, -23.9), (-15.8, -21.0), (-20.6, -17.6), (-24.4, -15.6), (-26.4, -18.0),
            (-25.0, -23.0), (-21.8, -28.0), (-17.6, -31.6), (-13.0, -32.8), (-11.0, -29.4),
        ),
        -4.5, 8.0, (0.06, 0.0),
    ),
    "pisiform": Carpal(
        (
            (-16.6, -25.6), (-17.8, -22.2), (-20.8, -20.8), (-23.8, -22.2), (-25.0, -26.0),
            (-23.4, -29.2), (-20.0, -30.2), (-17.2, -28.8),
        ),
        -14.8, -5.6,
    ),
    "hook": Carpal(
        (
            (-12.8, -10.4), (-13.8, -8.0), (-16.0, -7.2), (-18.2, -8.2), (-18.8, -10.6),
            (-17.8, -13.0), (-15.4, -13.8), (-13.4, -12.6),
        ),
        -15.2, -4.5, (0.16, 0.0),
    ),
}  # fmt: skip
_EDGE: Final = 0.42
"""Size of a bone's palmar and back face over that of its middle."""


def _rounding() -> tuple[tuple[float, float], ...]:
    """Return the outline's share of its size at shares of the depth: a superellipse."""
    reach = (1 - _EDGE**2.6) ** (1 / 2.6)
    angles = np.linspace(-1.0, 1.0, 11)
    places = reach * np.sin(angles * np.pi / 2)
    sizes = (1 - np.abs(places) ** 2.6) ** (1 / 2.6)
    return tuple(
        (float(0.5 + 0.5 * place / reach), float(size))
        for place, size in zip(places, sizes, strict=True)
    )


def carpus(scale: float) -> list[Solid]:
    """Return the carpal bones in the hand's frame, each named."""
    hook = _block("hook", CORTEX, scale, 0.0)
    bones: list[Solid] = []
    for name in CARPALS:
        if name == "hook":
            continue
        parts: list[Solid] = [_block(name, CORTEX, scale, 0.0)]
        if name == "hamate":
            parts.append(hook)
        parts.append(_block(name, SPONGIOSA, scale, SHELL_MM))
        if name == "hamate":
            parts.append(_block("hook", SPONGIOSA, scale, SHELL_MM))
        bones.append(named(name, layered(*parts)))
    return bones


def _block(name: str, material: str, scale: float, inset_mm: float) -> GeneralizedCylinder:
    """Sweep a bone's outline, or what lies within its cortex, from palm to back."""
    carpal = CARPALS[name]
    points = _inset(scale * np.array(carpal.outline), inset_mm)
    middle = points.mean(axis=0)
    start, end = scale * carpal.palm_mm + inset_mm, scale * carpal.back_mm - inset_mm
    leaf = "cortex" if material == CORTEX else "spongiosa"
    knots = _rounding()

    def slid(slope: float) -> KnotProfile | float:
        return KnotProfile(knots=((0.0, slope * start), (1.0, slope * end))) if slope else 0.0

    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=f"hook {leaf}" if name == "hook" else leaf,
        material=material,
        axis=LineAxis(
            type="line",
            start=(float(middle[0]), start, float(middle[1])),
            end=(float(middle[0]), end, float(middle[1])),
        ),
        contour=SplineContour(
            type="spline",
            points=tuple((float(x - middle[0]), float(middle[1] - z)) for x, z in points),
        ),
        sweep=LinearSweep(
            type="linear",
            scale=KnotProfile(knots=knots),
            offset=(slid(carpal.slant[0]), slid(-carpal.slant[1])),
        ),
        frame=UpFrame(up=(1.0, 0.0, 0.0)),
    )


def _inset(points: FloatArray, by_mm: float) -> FloatArray:
    """Move the corners of a closed outline inward along the mean normals of their edges."""
    if by_mm == 0.0:
        return points
    after = np.roll(points, -1, axis=0)
    edges = after - points
    normals = np.column_stack([edges[:, 1], -edges[:, 0]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    turn = np.sign(np.sum(points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]))
    outward = normals + np.roll(normals, 1, axis=0)
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    inside: FloatArray = points - turn * by_mm * outward
    return inside
