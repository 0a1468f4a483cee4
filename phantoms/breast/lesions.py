"""What can be wrong with a breast: clusters of calcifications, and masses.

Sizes and numbers: Badano et al. 2018 (VICTRE), clusters of calcium oxalate at 1.78 g/cm3 and
spiculated masses; calcifications of 0.15 to 0.32 mm in clusters of 4 to 10 within 5 mm. How
calcifications are arranged can be told only in depth, so it is a task for stereo; how dense they
are, a task for one picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Final, Literal, NamedTuple

import numpy as np

from phantom.document import Cone, Finding, Point, ReferenceMaterial, Sphere, told
from phantom.document.base import Coordinate, Integer
from phantom.errors import InvalidInputError, Problem, pointer
from phantom.library import Abnormality
from phantoms.breast.tissue import Body
from phantoms.draws import generator_of
from phantoms.fields import count, millimetres

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

Site = Literal[
    "central", "upper_outer", "upper_inner", "lower_outer", "lower_inner", "retroareolar"
]

_SITES: Final[Mapping[str, tuple[float, float, float]]] = {
    "central": (0.0, -0.5, 0.0),
    "upper_outer": (-0.35, -0.4, 0.35),
    "upper_inner": (0.35, -0.4, 0.35),
    "lower_outer": (-0.35, -0.4, -0.35),
    "lower_inner": (0.35, -0.4, -0.35),
    "retroareolar": (0.0, -0.82, 0.0),
}
"""Shares of the half width, of the depth and of the half thickness."""


class _Placed(Abnormality):
    """Something at a place of the breast."""

    site: Annotated[Site, told("Site", "none", "A quadrant, the middle, or behind the nipple.")] = (
        "central"
    )
    offset_mm: Annotated[
        tuple[Coordinate, Coordinate, Coordinate],
        told("Offset", "mm", "From the site: inward, back, and up, as the breast lies."),
    ] = (0.0, 0.0, 0.0)
    seed: Annotated[Integer, told("Seed", "none", "Of its pattern.", ge=0, lt=2**64)] = 0


class CalcificationCluster(_Placed):
    """A cluster of calcifications."""

    type: Literal["calcification_cluster"] = "calcification_cluster"
    number: Annotated[int, count("Number", "Of calcifications.", 1, 60)] = 6
    diameter_mm: Annotated[float, millimetres("Diameter", "Of one, on average.", 0.05, 3.0)] = 0.3
    cluster_mm: Annotated[float, millimetres("Cluster", "Across all of them.", 0.5, 40.0)] = 5.0
    arrangement: Annotated[
        Literal["scattered", "line", "sheet", "shell"],
        told("Arrangement", "none", "In a ball, along a line, in a plane, or on a ball's surface."),
    ] = "scattered"
    density_g_cm3: Annotated[
        float, told("Density", "g/cm3", "Of the calcium oxalate.", ge=0.2, le=3.0, strict=True)
    ] = 1.78


class Mass(_Placed):
    """A mass, smooth or spiculated."""

    type: Literal["mass"] = "mass"
    diameter_mm: Annotated[float, millimetres("Diameter", "Of its core.", 1.0, 50.0)] = 8.0
    density_g_cm3: Annotated[
        float, told("Density", "g/cm3", "Gland has 1.02.", ge=0.9, le=1.3, strict=True)
    ] = 1.06
    spicules: Annotated[int, count("Spicules", "None for a smooth mass.", 0, 80)] = 24
    spicule_mm: Annotated[float, millimetres("Spicule", "Length beyond the core.", 0.5, 25.0)] = 6.0


KINDS: Final[Mapping[str, type[Abnormality]]] = {
    "calcification_cluster": CalcificationCluster,
    "mass": Mass,
}


class Lesion(NamedTuple):
    """What an abnormality adds to the breast."""

    material: str
    substance: ReferenceMaterial
    solids: tuple[Sphere | Cone, ...]
    finding: Finding


def lesions(body: Body, abnormalities: Sequence[Abnormality]) -> Iterator[Lesion]:
    """Yield what each abnormality adds, in the frame of :mod:`phantoms.breast.tissue`.

    Raises
    ------
    InvalidInputError
        One does not fit in the breast (``/abnormalities/i/offset_mm``).
    """
    for index, abnormality in enumerate(abnormalities):
        assert isinstance(abnormality, _Placed)
        name = abnormality.name or f"{abnormality.type}-{index + 1}"  # type: ignore[attr-defined]
        center = np.array(_SITES[abnormality.site]) * [
            body.semi_axes[0],
            body.semi_axes[1],
            body.half_mm,
        ] + np.array(abnormality.offset_mm)
        generator = generator_of(abnormality.seed)
        if isinstance(abnormality, CalcificationCluster):
            reach = (abnormality.cluster_mm + 1.5 * abnormality.diameter_mm) / 2
            solids = _calcifications(name, abnormality, center, generator)
            size, kind, reference = abnormality.cluster_mm, "calcifications", "calcium_oxalate"
        else:
            assert isinstance(abnormality, Mass)
            spread = abnormality.spicule_mm if abnormality.spicules else 0.0
            reach = abnormality.diameter_mm / 2 + spread
            solids = _mass(name, abnormality, center, generator)
            size, kind, reference = abnormality.diameter_mm, "mass", "breast_gland_icru44"
        if not _fits(body, center, reach):
            message = (
                f"found {_point(center)} mm with {reach:.4g} mm around it; expected it inside the"
                f" breast: x within {body.semi_axes[0]:.4g}, y from {-body.semi_axes[1]:.4g} to 0,"
                f" z within {body.half_mm:.4g} mm"
            )
            path = pointer(("abnormalities", index, "offset_mm"))
            raise InvalidInputError([Problem(path, "does_not_fit", message)])
        leaves = tuple(str(solid.name) for solid in solids)
        yield Lesion(
            name,
            ReferenceMaterial(reference=reference, density_g_cm3=abnormality.density_g_cm3),
            solids,
            Finding(name=name, kind=kind, leaves=leaves, center=_point(center), size_mm=size),
        )


def _fits(body: Body, center: FloatArray, reach_mm: float) -> bool:
    """Tell whether a ball lies inside the body."""
    shrunk = body.semi_axes[0] > reach_mm and body.half_mm > reach_mm
    return shrunk and bool(body.holds(center[None], reach_mm)[0])


def _calcifications(
    name: str, cluster: CalcificationCluster, center: FloatArray, generator: np.random.Generator
) -> tuple[Sphere | Cone, ...]:
    """Return the calcifications; no two touch unless they have no room."""
    places: list[FloatArray] = []
    axes = np.linalg.qr(generator.standard_normal((3, 3)))[0]
    half = (cluster.cluster_mm - cluster.diameter_mm) / 2
    for _ in range(cluster.number):
        for _attempt in range(200):
            place = max(half, 0.0) * _arranged(cluster.arrangement, generator) @ axes
            if all(np.linalg.norm(place - other) > 1.3 * cluster.diameter_mm for other in places):
                break
        places.append(place)
    sizes = cluster.diameter_mm * np.clip(generator.normal(1.0, 0.15, len(places)), 0.6, 1.4)
    return tuple(
        Sphere(
            type="sphere",
            name=f"{name}-{k + 1:02d}",
            material=name,
            center=_point(center + place),
            radius=float(size) / 2,
        )
        for k, (place, size) in enumerate(zip(places, sizes, strict=True))
    )


def _arranged(arrangement: str, generator: np.random.Generator) -> FloatArray:
    """Return a point of the unit ball, or of a line, disc or sphere in it."""
    unit = generator.standard_normal(3)
    unit /= np.linalg.norm(unit)
    share = generator.random()
    if arrangement == "line":
        return np.array([2 * share - 1, 0.0, 0.0])
    if arrangement == "sheet":
        turn = math.atan2(unit[1], unit[0])
        return math.sqrt(share) * np.array([math.cos(turn), math.sin(turn), 0.0])
    return np.asarray(unit if arrangement == "shell" else unit * share ** (1 / 3))


def _mass(
    name: str, mass: Mass, center: FloatArray, generator: np.random.Generator
) -> tuple[Sphere | Cone, ...]:
    radius = mass.diameter_mm / 2
    core = Sphere(type="sphere", name=name, material=name, center=_point(center), radius=radius)
    spicules = []
    for k in range(mass.spicules):
        way = generator.standard_normal(3)
        way /= np.linalg.norm(way)
        tip = radius + mass.spicule_mm * float(generator.uniform(0.5, 1.0))
        wide = 0.09 * mass.diameter_mm * float(generator.uniform(0.6, 1.4)) + 0.1
        spicules.append(
            Cone(
                type="cone",
                name=f"{name}-spicule-{k + 1:02d}",
                material=name,
                start=_point(center + 0.8 * radius * way),
                end=_point(center + tip * way),
                start_radius=wide,
                end_radius=0.05,
            )
        )
    return (core, *spicules)


def _point(p: FloatArray) -> Point:
    x, y, z = (round(float(c), 9) for c in p)
    return (x, y, z)
