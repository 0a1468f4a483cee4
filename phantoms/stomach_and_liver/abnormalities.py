"""What can be wrong with the stomach: a filling defect, and an ulcer's niche."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final, Literal, NamedTuple

import numpy as np

from phantom.document import Ellipsoid, Finding, Point, Solid, Transformed, told
from phantom.document.base import Number
from phantom.errors import InvalidInputError, Problem
from phantom.library import Abnormality
from phantoms.inside import FloatArray, inside
from phantoms.parts import named
from phantoms.stomach_and_liver.organs import AIR, BARIUM, WALL, Stomach

if TYPE_CHECKING:
    from collections.abc import Sequence

    from phantoms.parts import Station
    from phantoms.stomach_and_liver.trunk import Trunk

_At = Annotated[
    Number,
    told(
        "Place",
        "1",
        "Share of the axis, from the fundus to the pylorus; the body is 0.2 to 0.6.",
        ge=0.1,
        le=0.92,
    ),
]
_Curvature = Annotated[
    Literal["greater", "lesser", "front", "back"],
    told("Curvature", "none", "Which side of the stomach."),
]
_MOST_OF_THE_LUMEN: Final = 0.75


class FillingDefect(Abnormality):
    """A round polyp on the wall, where barium is missing."""

    type: Literal["filling_defect"] = "filling_defect"
    at: _At = 0.5
    curvature: _Curvature = "greater"
    diameter_mm: Annotated[Number, told("Diameter", "mm", "Of the polyp.", ge=4.0, le=50.0)] = 24.0


class UlcerNiche(Abnormality):
    """A crater in the wall that fills with what the lumen holds."""

    type: Literal["ulcer_niche"] = "ulcer_niche"
    at: _At = 0.55
    curvature: _Curvature = "lesser"
    width_mm: Annotated[Number, told("Width", "mm", "Of its mouth.", ge=3.0, le=25.0)] = 9.0
    depth_mm: Annotated[
        Number, told("Depth", "mm", "Beyond the lumen's edge.", ge=2.0, le=18.0)
    ] = 8.0


ABNORMALITIES: Final[dict[str, type[Abnormality]]] = {
    "filling_defect": FillingDefect,
    "ulcer_niche": UlcerNiche,
}


class Surroundings(NamedTuple):
    """What an ulcer may not reach."""

    trunk: Trunk
    liver: Sequence[Station]
    scale: float


def add(
    stomach: Stomach, level_mm: float, wrong: Sequence[Abnormality], around: Surroundings
) -> tuple[list[Solid], list[Finding]]:
    """Return what is wrong as solids that replace the stomach's, and the findings.

    Raises
    ------
    InvalidInputError
        What does not fit, with paths under ``/abnormalities``.
    """
    solids: list[Solid] = []
    findings: list[Finding] = []
    problems: list[Problem] = []
    counts: dict[str, int] = {}
    for index, one in enumerate(wrong):
        kind = type(one).model_fields["type"].default.replace("_", " ")
        counts[kind] = counts.get(kind, 0) + 1
        name = one.name or (kind if counts[kind] == 1 else f"{kind} {counts[kind]}")
        if isinstance(one, FillingDefect):
            solid, finding, problem = _polyp(stomach, one, name)
        elif isinstance(one, UlcerNiche):
            solid, finding, problem = _ulcer(stomach, level_mm, one, name, around)
        else:
            raise TypeError(f"no such abnormality of the stomach: {one!r}")
        if problem is not None:
            field, message = problem
            path = f"/abnormalities/{index}/{field}"
            problems.append(Problem(path, "does_not_fit", message))
        solids.append(named("stomach", solid))
        findings.append(finding)
    if problems:
        raise InvalidInputError(problems)
    return solids, findings


_Found = tuple[Solid, Finding, tuple[str, str] | None]


def _polyp(stomach: Stomach, wrong: FillingDefect, name: str) -> _Found:
    edge, outward, width = stomach.edge(wrong.at, wrong.curvature)
    radius = wrong.diameter_mm / 2
    # It sits in the wall by as much as the wall bears.
    center = edge - (radius - min(0.3 * radius, 0.8 * min(stomach.walls))) * outward
    solid = Ellipsoid(
        type="ellipsoid", name=name, material=WALL, center=_point(center), semi_axes=(radius,) * 3
    )
    finding = Finding(
        name=name,
        kind="filling defect",
        leaves=(f"stomach/{name}",),
        center=_point(center),
        size_mm=wrong.diameter_mm,
    )
    most = _MOST_OF_THE_LUMEN * width
    problem = None
    if wrong.diameter_mm > most:
        expected = f"expected at most {most:.3g} mm, three quarters of the lumen there"
        problem = ("diameter_mm", f"found {wrong.diameter_mm:g} mm; {expected}")
    return solid, finding, problem


def _ulcer(
    stomach: Stomach, level_mm: float, wrong: UlcerNiche, name: str, around: Surroundings
) -> _Found:
    edge, outward, width = stomach.edge(wrong.at, wrong.curvature)
    aside = np.cross(outward, (0.0, 1.0, 0.0) if abs(outward[1]) < 0.9 else (1.0, 0.0, 0.0))
    aside /= np.linalg.norm(aside)
    # The mouth is a little within the lumen, so that nothing is left between.
    deep = (wrong.depth_mm + 2.0) / 2
    center = edge + (wrong.depth_mm - deep) * outward
    axes = np.column_stack([aside, np.cross(outward, aside), outward, center])
    rows = tuple((float(a), float(b), float(c), float(d)) for a, b, c, d in axes)
    crater = Ellipsoid(
        type="ellipsoid",
        name=name,
        material=BARIUM if center[2] < level_mm else AIR,
        center=(0.0, 0.0, 0.0),
        semi_axes=(wrong.width_mm / 2, wrong.width_mm / 2, deep),
    )
    solid = Transformed(type="transformed", solid=crater, matrix=(rows[0], rows[1], rows[2]))
    finding = Finding(
        name=name,
        kind="ulcer niche",
        leaves=(f"stomach/{name}",),
        center=_point(edge + 0.5 * wrong.depth_mm * outward),
        size_mm=max(wrong.width_mm, wrong.depth_mm),
    )
    problem = None
    bottom = edge + (wrong.depth_mm + 1.0) * outward
    reached = _reached(bottom, around)
    if reached is not None:
        message = f"found {wrong.depth_mm:g} mm, through the wall into {reached}; expected less"
        problem = ("depth_mm", message)
    elif wrong.width_mm > 0.6 * width:
        message = f"found {wrong.width_mm:g} mm; expected at most {0.6 * width:.3g} mm there"
        problem = ("width_mm", message)
    return solid, finding, problem


def _reached(place: FloatArray, around: Surroundings) -> str | None:
    """Name what an ulcer's bottom would lie in, besides the space between organs."""
    x, y, _ = place
    trunk, scale = around.trunk, around.scale
    if np.hypot(x / (trunk.half_width - 2), y / (trunk.half_depth - 2)) > 0.95:
        return "the wall of the belly"
    if abs(x) < 27.0 * scale and y > 10.0 * scale:
        return "the spine"
    if inside(around.liver, place, -2.0, up=(0.0, 0.0, 1.0)):
        return "the liver"
    return None


def _point(values: FloatArray) -> Point:
    x, y, z = (round(float(value), 6) for value in values)
    return (x, y, z)
