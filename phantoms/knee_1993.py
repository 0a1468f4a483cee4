"""The knee joint of the 1993 paper (section IV.C, figure 10): six primitives that look like a knee.

The femur is a generalized cylinder less an ellipsoid, the notch between its condyles. Its axis
comes down the shaft and curls backward under the joint, so that one outline with two humps draws
the groove for the patella in front, the condyles below and their overhang behind. The tibia is a
generalized cylinder that shrinks over its plateau to the eminence between the condyles. The fibula
is a generalized cylinder with an ellipsoid as its head; the patella is an ellipsoid. All bones have
the paper's one density, a fixed linear attenuation coefficient.

The tables hold a right knee of a man, femur and tibia touching at z = 0. ``SOURCES`` says where
the sizes come from. Estimates: every outline between those sizes, the shafts, the plateau's slope,
the fibula's head, the patella's size and place, the default valgus and the default density.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Final, Literal, NamedTuple

from phantom.document import (
    Anatomy,
    CircleContour,
    Difference,
    Document,
    Ellipsoid,
    FixedMaterial,
    GeneralizedCylinder,
    KnotProfile,
    LinearSweep,
    Model,
    Point,
    Solid,
    SplineAxis,
    SplineContour,
    Transformed,
    Union,
    UpFrame,
    told,
)
from phantom.library import Entry, Technique

SOURCES: Final = (
    "Hsu, Chelberg 1993, section IV.C and figure 10: the six primitives.",
    "Anatomy Research International 2012, 679658: men's bicondylar width 88.6 mm,"
    " condylar depth 61.1 mm, intercondylar width 22.0 mm.",
    "Minimum joint space width in the knees of healthy individuals, BMC Musculoskeletal Disorders"
    " 2008, 9:119: men's medial joint space 5.7 mm.",
    "Karakaş 2008: men's femoral midshaft 26.5 mm across.",
    "Kwak et al., in table 5 of PMC9703208: men's tibial plateau 76.1 mm across, 48.2 mm deep.",
)

_SUMMARY: Final = (
    "The knee of the 1993 paper's figure 10: femur, tibia, fibula and patella as generalized"
    " cylinders and ellipsoids, six primitives in all, of one density."
)
_MODELLED_WIDTH_MM: Final = 88.6


class Parameters(Model):
    """What the knee may be."""

    side: Annotated[
        Literal["right", "left"],
        told("Side", "none", "Of the body; a left knee is the mirror image of a right one."),
    ] = "right"
    bicondylar_width_mm: Annotated[
        float,
        told(
            "Bicondylar width",
            "mm",
            "Across the femur's condyles; every bone grows with it.",
            ge=60.0,
            le=110.0,
            strict=True,
        ),
    ] = _MODELLED_WIDTH_MM
    joint_space_mm: Annotated[
        float,
        told(
            "Joint space",
            "mm",
            "The least distance, along z, from the medial condyle to the plateau.",
            ge=1.0,
            le=10.0,
            strict=True,
        ),
    ] = 5.7
    valgus_deg: Annotated[
        float,
        told(
            "Valgus",
            "degrees",
            "Lean of the femur's shaft toward the outer side.",
            ge=0.0,
            le=12.0,
            strict=True,
        ),
    ] = 6.0
    attenuation_per_mm: Annotated[
        float,
        told("Attenuation", "1/mm", "Of all bone, at every energy.", ge=0.001, le=1.0, strict=True),
    ] = 0.025


class Station(NamedTuple):
    """A section of a bone: a point of its axis, and how far the section reaches from it, in mm.

    ``x`` is the reach toward -x and +x; ``b`` that along b = t x n, against it and with it.
    """

    at: Point
    x: tuple[float, float]
    b: tuple[float, float]


# The femur's outline in the frame (x, outward): in front of the shaft, below the condyles and
# behind them the side of +b; its two humps are the condyles, the lateral one (x < 0) the lower.
_FEMUR_OUTLINE: Final = (
    (0.02, 0.74),
    (0.26, 0.88),
    (0.52, 1.0),
    (0.82, 0.80),
    (1.0, 0.2),
    (0.95, -0.4),
    (0.7, -0.82),
    (0.35, -0.97),
    (0.0, -1.0),
    (-0.35, -0.97),
    (-0.7, -0.82),
    (-0.95, -0.4),
    (-1.0, 0.2),
    (-0.86, 0.76),
    (-0.54, 0.965),
    (-0.24, 0.88),
)
# The centre (y, z) and the radius of the bend in which the femur's axis curls back.
_BEND_YZ: Final = (20.0, 43.0)
_BEND_RADIUS: Final = 21.0
# Shaft: y and z of the axis, half-width, depth behind and in front of the axis.
_FEMUR_SHAFT: Final = (
    (3.5, 140.0, 13.2, 13.5, 13.5),
    (1.5, 110.0, 13.3, 14.0, 13.5),
    (0.5, 87.0, 15.4, 15.5, 15.0),
    (0.0, 70.0, 20.4, 17.0, 16.8),
    (-0.6, 56.0, 29.9, 17.6, 18.4),
)
# Condyles: degrees round the bend from the front, half-width, inner and outer radius.
_FEMUR_CONDYLES: Final = (
    (0.0, 38.8, 3.0, 40.0),
    (30.0, 43.0, 3.0, 41.5),
    (60.0, 44.1, 2.2, 43.0),
    (90.0, 43.8, 1.5, 43.0),
    (115.0, 43.3, 1.5, 38.3),
    (130.0, 42.3, 1.5, 32.0),
    (140.0, 40.3, 1.5, 26.2),
    (147.0, 36.8, 1.5, 20.6),
    (152.0, 32.0, 1.5, 14.5),
    (155.0, 28.0, 1.5, 9.5),
)
# The shaft leans from here upward.
_LEAN_FROM_Z: Final = 60.0

# The tibia's outline in the frame (x, back): the crest in front, a hollow behind.
_TIBIA_OUTLINE: Final = (
    (0.0, -1.0),
    (0.42, -0.84),
    (0.84, -0.32),
    (1.0, 0.25),
    (0.87, 0.76),
    (0.5, 1.0),
    (0.0, 0.84),
    (-0.5, 1.0),
    (-0.87, 0.76),
    (-1.0, 0.25),
    (-0.84, -0.32),
    (-0.42, -0.84),
)
# z, then x of the lateral and medial border, y of the front and back border.
_TIBIA: Final = (
    (-135.0, -13.0, 13.0, -6.0, 22.0),
    (-105.0, -13.5, 13.5, -7.5, 22.0),
    (-80.0, -15.5, 15.5, -10.0, 22.5),
    (-60.0, -18.5, 19.0, -13.0, 24.0),
    (-44.0, -22.5, 23.5, -17.0, 24.5),
    (-30.0, -27.5, 29.5, -17.0, 26.5),
    (-18.0, -33.5, 35.2, -14.0, 30.5),
    (-9.0, -37.2, 37.2, -12.2, 34.0),
    (-4.0, -37.8, 37.8, -11.8, 35.3),
    (-1.2, -37.0, 37.0, -11.2, 34.8),
    (-0.2, -35.0, 35.0, -9.8, 33.5),
    (0.6, -29.0, 29.0, -5.0, 30.0),
    (1.1, -22.0, 22.0, 1.0, 27.0),
    (1.7, -14.0, 14.0, 6.5, 25.0),
    (2.6, -9.5, 9.5, 9.0, 24.0),
    (4.2, -6.8, 6.8, 11.0, 23.0),
    (6.2, -5.0, 5.0, 12.5, 22.0),
    (7.5, -3.5, 3.5, 14.0, 20.5),
    (8.2, -2.0, 2.0, 15.5, 18.5),
)
_PLATEAU_Y: Final = 12.0
_PLATEAU_Z: Final = -0.931  # where the plateau just touches the condyles
_PLATEAU_SLOPE_DEG: Final = 4.6

# A point of the fibula's axis and its radius there.
_FIBULA: Final = (
    ((-35.0, 31.5, -32.0), 7.0),
    ((-35.0, 30.0, -46.0), 5.2),
    ((-33.0, 27.5, -75.0), 5.8),
    ((-31.0, 26.0, -105.0), 6.5),
    ((-29.5, 26.0, -135.0), 6.8),
)
_FIBULAR_HEAD: Final = (-35.5, 31.5, -28.0)
_PATELLA: Final = (-2.0, -33.5, 37.0)


def _femur_stations(valgus_deg: float) -> list[Station]:
    """Return the femur's sections from the shaft's top round to the back of the condyles."""
    lean = math.tan(math.radians(valgus_deg))
    stations = [
        Station((-lean * max(0.0, z - _LEAN_FROM_Z), y, z), (-half, half), (-back, front))
        for y, z, half, back, front in _FEMUR_SHAFT
    ]
    for angle_deg, half, inner, outer in _FEMUR_CONDYLES:
        cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
        at = (0.0, _BEND_YZ[0] - _BEND_RADIUS * cos, _BEND_YZ[1] - _BEND_RADIUS * sin)
        reach = (inner - _BEND_RADIUS, outer - _BEND_RADIUS)
        stations.append(Station(at, (-half, half), reach))
    return stations


def _tibia_stations() -> list[Station]:
    """Return the tibia's sections from below; its axis stands square to the sloping plateau."""
    slope = math.tan(math.radians(_PLATEAU_SLOPE_DEG))
    stations = []
    for z, lateral, medial, front, back in _TIBIA:
        y = _PLATEAU_Y + z * slope
        at = (0.0, y, z + _PLATEAU_Z)
        stations.append(Station(at, (lateral, medial), (front - y, back - y)))
    return stations


def _chord_length(points: Sequence[Point]) -> list[float]:
    """Return u of the points of a spline axis: chord length scaled to [0, 1]."""
    lengths = [0.0]
    for start, end in pairwise(points):
        lengths.append(lengths[-1] + math.dist(start, end))
    return [length / lengths[-1] for length in lengths]


def _knots(at: Sequence[float], values: Sequence[float]) -> KnotProfile:
    return KnotProfile(knots=tuple(zip(at, values, strict=True)))


def _bone(
    name: str, stations: Sequence[Station], outline: tuple[tuple[float, float], ...]
) -> GeneralizedCylinder:
    """Sweep an outline that fills the square [-1, 1]^2 through the stations."""
    points = [station.at for station in stations]
    at = _chord_length(points)
    reaches = ([station.x for station in stations], [station.b for station in stations])
    half_x, half_b = ([(high - low) / 2 for low, high in reach] for reach in reaches)
    middle_x, middle_b = ([(high + low) / 2 for low, high in reach] for reach in reaches)
    return GeneralizedCylinder(
        type="generalized_cylinder",
        name=name,
        material="bone",
        axis=SplineAxis(type="spline", points=tuple(points)),
        contour=SplineContour(type="spline", points=outline),
        sweep=LinearSweep(
            type="linear",
            scale=(_knots(at, half_x), _knots(at, half_b)),
            offset=(_knots(at, middle_x), _knots(at, middle_b)),
        ),
        frame=UpFrame(up=(1.0, 0.0, 0.0)),
    )


def _ellipsoid(name: str, center: Point, semi_axes: Point, material: str | None) -> Ellipsoid:
    return Ellipsoid(
        type="ellipsoid", name=name, material=material, center=center, semi_axes=semi_axes
    )


def _femur(valgus_deg: float) -> Solid:
    notch = _ellipsoid("notch", (0.0, 34.0, 14.0), (11.0, 29.0, 26.0), None)
    body = _bone("femur", _femur_stations(valgus_deg), _FEMUR_OUTLINE)
    return Difference(type="difference", solids=(body, notch))


def _fibula() -> Solid:
    points = [point for point, _ in _FIBULA]
    radii = _knots(_chord_length(points), [radius for _, radius in _FIBULA])
    shaft = GeneralizedCylinder(
        type="generalized_cylinder",
        name="fibula",
        material="bone",
        axis=SplineAxis(type="spline", points=tuple(points)),
        contour=CircleContour(type="circle", radius=1.0),
        sweep=LinearSweep(type="linear", scale=radii),
    )
    head = _ellipsoid("fibular head", _FIBULAR_HEAD, (9.0, 10.0, 13.0), "bone")
    return Union(type="union", solids=(shaft, head))


def _sized(scale: float, rise: float, *solids: Solid) -> Transformed:
    """Scale bones about the joint, then lift them."""
    both = Union(type="union", solids=solids)
    return Transformed(type="transformed", solid=both, scale=scale, translate=(0.0, 0.0, rise))


def _mirrored(solid: Solid) -> Transformed:
    """Exchange left and right."""
    across = ((-1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    return Transformed(type="transformed", solid=solid, matrix=across)


def build(parameters: Parameters) -> Document:
    """Return the knee, fully extended, the middle of its joint space at the origin."""
    scale = parameters.bicondylar_width_mm / _MODELLED_WIDTH_MM
    rise = parameters.joint_space_mm / 2
    outward = -1.0 if parameters.side == "right" else 1.0
    patella = _ellipsoid("patella", _PATELLA, (22.4, 11.2, 17.2), "bone")
    tibia = _bone("tibia", _tibia_stations(), _TIBIA_OUTLINE)
    above = _sized(scale, rise, _femur(parameters.valgus_deg), patella)
    below = _sized(scale, -rise, tibia, _fibula())
    solid: Solid = Union(type="union", solids=(above, below))

    def landmark(point: Point, lift: float) -> Point:
        x, y, z = point
        return (-outward * scale * x, scale * y, scale * z + lift)

    return Document(
        format="phantom/1",
        name="knee-1993",
        title="Knee joint of 1993",
        description=_SUMMARY,
        materials={"bone": FixedMaterial(attenuation_per_mm=parameters.attenuation_per_mm)},
        solid=solid if parameters.side == "right" else _mirrored(solid),
        landmarks={
            "isocentre": (0.0, 0.0, 0.0),
            "patella": landmark(_PATELLA, rise),
            "fibular_head": landmark(_FIBULAR_HEAD, -rise),
        },
        anatomy=Anatomy(region="knee", laterality=parameters.side),
        sources=SOURCES,
        parameters=parameters.model_dump(mode="json"),
    )


entry = Entry(
    name="knee-1993",
    title="Knee joint of 1993",
    summary=_SUMMARY,
    parameters=Parameters,
    build=build,
    views=("ap", "mediolateral"),
    technique=Technique(source_detector_mm=1150.0, object_detector_mm=100.0),
)
