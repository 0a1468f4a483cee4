"""The deformed object of the 1993 paper (section IV.A, figures 3, 4 and 8).

One generalized cylinder: its axis is a curve in space given by formulas over u from 0.5 to 3, and
its section, in the Frenet frame, goes from a star over a circle to a square with rounded corners,
each within the one before as in figure 3. All measures are estimates: the paper gives none.
"""

from __future__ import annotations

import math
from typing import Annotated, Final

from phantom.document import (
    CircleContour,
    Document,
    FixedMaterial,
    FormulaAxis,
    GeneralizedCylinder,
    Model,
    MorphSection,
    MorphSweep,
    PolygonContour,
    told,
)
from phantom.library import Entry

_SUMMARY: Final = (
    "The deformed object of the 1993 paper's figure 8: one generalized cylinder along a curve in"
    " space, from a star over a circle to a square with rounded corners."
)
FIRST_U: Final = 0.5
LAST_U: Final = 3.0
# All below over the object's size: the axis turns about z and climbs faster and faster.
_TURN_RADIUS: Final = 0.24
_CLIMB: Final = (0.18, 0.045)  # z = 0.18 u + 0.045 u^2
_STAR: Final = 0.19  # radius of the star's tips
_STAR_ROUNDING: Final = 0.012
_CIRCLE: Final = 0.092
_SQUARE: Final = 0.052  # half its side


class Parameters(Model):
    """What the deformed object may be."""

    size_mm: Annotated[
        float,
        told(
            "Size", "mm", "Of the whole object, roughly its height.", ge=20.0, le=500.0, strict=True
        ),
    ] = 240.0
    points: Annotated[
        int,
        told("Points", "none", "Of the star.", ge=3, le=9, strict=True),
    ] = 5
    star_depth: Annotated[
        float,
        told(
            "Star depth",
            "none",
            "How far the star's edge goes in between two points, over its radius.",
            ge=0.1,
            le=0.6,
            strict=True,
        ),
    ] = 0.45
    corner_share: Annotated[
        float,
        told(
            "Corner share",
            "none",
            "Radius of the square's corners over half its side.",
            ge=0.05,
            le=0.95,
            strict=True,
        ),
    ] = 0.4
    attenuation_per_mm: Annotated[
        float,
        told("Attenuation", "1/mm", "Of the object.", ge=0.001, le=1.0, strict=True),
    ] = 0.02


def _axis(size: float) -> FormulaAxis:
    radius, climb = _TURN_RADIUS * size, tuple(share * size for share in _CLIMB)
    return FormulaAxis(
        type="formula",
        x=f"{radius!r} * cos(u)",
        y=f"{radius!r} * sin(u)",
        z=f"{climb[0]!r} * u + {climb[1]!r} * u**2",
        range=(FIRST_U, LAST_U),
    )


def _star(size: float, points: int, depth: float) -> PolygonContour:
    """Return a star whose tips and hollows are a little rounded."""
    outer = _STAR * size
    corners = []
    for index in range(2 * points):
        radius = outer if index % 2 == 0 else outer * (1 - depth)
        angle = math.pi * index / points
        corners.append((radius * math.cos(angle), radius * math.sin(angle)))
    return PolygonContour(
        type="polygon", points=tuple(corners), corner_radius=_STAR_ROUNDING * size
    )


def _square(size: float, corner_share: float) -> PolygonContour:
    half = _SQUARE * size
    corners = ((half, half), (-half, half), (-half, -half), (half, -half))
    return PolygonContour(type="polygon", points=corners, corner_radius=corner_share * half)


def build(parameters: Parameters) -> Document:
    """Return the object; the axis turns about z, the star below."""
    size = parameters.size_mm
    middle = 0.5 * (FIRST_U + LAST_U)
    star = _star(size, parameters.points, parameters.star_depth)
    circle = CircleContour(type="circle", radius=_CIRCLE * size)
    square = _square(size, parameters.corner_share)
    return Document(
        format="phantom/1",
        name="deformed",
        title="Deformed object of 1993",
        description=_SUMMARY,
        materials={"object": FixedMaterial(attenuation_per_mm=parameters.attenuation_per_mm)},
        solid=GeneralizedCylinder(
            type="generalized_cylinder",
            name="deformed",
            material="object",
            axis=_axis(size),
            sweep=MorphSweep(
                type="morph",
                contours=(
                    MorphSection(at=FIRST_U, contour=star),
                    MorphSection(at=middle, contour=circle),
                    MorphSection(at=LAST_U, contour=square),
                ),
            ),
            frame="frenet",
        ),
        sources=("Hsu, Chelberg 1993, section IV.A and figures 3, 4 and 8.",),
        parameters=parameters.model_dump(mode="json"),
    )


entry = Entry(
    name="deformed",
    title="Deformed object of 1993",
    summary=_SUMMARY,
    parameters=Parameters,
    build=build,
    views=("ap", "left_lateral"),
)
