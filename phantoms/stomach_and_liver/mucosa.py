"""What a barium meal shows of the mucosa: the stomach's folds, and the duodenum beyond the bulb.

Numbers, places and sizes are estimates: folds of 4 to 5 mm along the body, that fade in the antrum;
a duodenum of which barium fills the room between circular folds.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.document import Cone, Ellipsoid, Point, Solid, Transformed
from phantoms.parts import layered, union
from phantoms.stomach_and_liver.organs import BARIUM, BULB, WALL, Stomach

FloatArray = NDArray[np.float64]

# Angle from the greater curvature toward the back, share of the axis where it starts and ends,
# half its height, and how far and in what phase it winds.
_FOLDS: Final = (
    (24.0, 0.10, 0.62, 2.4, 5.0, 0.4),
    (47.0, 0.07, 0.50, 2.1, 6.0, 2.9),
    (71.0, 0.09, 0.56, 2.3, 5.0, 4.2),
    (97.0, 0.07, 0.48, 2.0, 5.0, 1.1),
    (124.0, 0.08, 0.58, 2.3, 5.0, 5.5),
    (151.0, 0.12, 0.66, 2.2, 4.0, 0.9),
    (207.0, 0.12, 0.68, 2.2, 4.0, 3.8),
    (234.0, 0.08, 0.55, 2.4, 5.0, 2.2),
    (260.0, 0.07, 0.47, 2.1, 6.0, 0.1),
    (288.0, 0.09, 0.57, 2.3, 5.0, 4.9),
    (313.0, 0.07, 0.51, 2.2, 6.0, 3.3),
    (336.0, 0.10, 0.64, 2.4, 5.0, 1.7),
)
_FOLD_SECTIONS: Final = 20
_WAVES: Final = 2.3

# Folds across the greater curvature: share of the axis, angle, half the height.
_SCALLOPS: Final = (
    (0.235, 4.0, 2.4), (0.271, -6.0, 2.8), (0.355, 8.0, 2.6), (0.398, -3.0, 3.0), (0.437, 5.0, 2.6),
    (0.481, -7.0, 3.0), (0.520, 3.0, 2.5), (0.562, -4.0, 2.9), (0.601, 6.0, 2.5), (0.640, 0.0, 2.2),
)  # fmt: skip

# The duodenum's axis: from the bulb down on the right of the spine, then across before it; and how
# far each place goes with the bulb, where that lies elsewhere than in the mean adult.
_COURSE: Final = (
    ((-43.0, 4.5, 56.0), 1.0),
    ((-51.5, 8.0, 53.0), 0.95),
    ((-56.0, 10.5, 38.0), 0.8),
    ((-54.0, 11.0, 14.0), 0.6),
    ((-52.0, 12.0, -12.0), 0.3),
    ((-45.0, 8.0, -36.0), 0.1),
    ((-28.0, -2.0, -50.0), 0.0),
    ((-4.0, -8.0, -49.0), 0.0),
)
_GIRTH_MM: Final = 10.5
_APART_MM: Final = 3.6
"""From one circular fold to the next."""
_PIECES: Final = 24


def folds(stomach: Stomach, coating_mm: float) -> list[Solid]:
    """Return the folds and the barium on them, to replace what the lumen holds."""
    coats: list[Solid] = []
    ridges: list[Solid] = []
    for index, (angle, first, last, half, swing, phase) in enumerate(_FOLDS):
        places, heights = [], []
        for step in range(_FOLD_SECTIONS + 1):
            share = step / _FOLD_SECTIONS
            at = first + share * (last - first)
            turn = angle + swing * math.sin(2 * math.pi * _WAVES * share + phase)
            height = half * (0.35 + 0.65 * math.sin(math.pi * (0.08 + 0.84 * share)) ** 0.5)
            inset = 0.9 * height + coating_mm
            places.append(_point(stomach.on_wall(at, math.radians(turn), inset)))
            heights.append(height)
        ends = [*pairwise(zip(places, heights, strict=True))]
        for step, ((start, thick), (end, thin)) in enumerate(ends):
            label = f"{index + 1}-{step + 1}"
            coats.append(
                _cone(
                    f"coat {label}", BARIUM, (start, end), (thick + coating_mm, thin + coating_mm)
                )
            )
            ridges.append(_cone(f"fold {label}", WALL, (start, end), (thick, thin)))
    for index, (at, degrees, half) in enumerate(_SCALLOPS):
        place = stomach.on_wall(at, math.radians(degrees), half - 0.8)
        _, back, _ = stomach.frame(at)
        ridges.append(_piece(f"scallop {index + 1}", WALL, place, back, (2.8, half, 10.0)))
    return [union(*coats), union(*ridges)]


def _cone(name: str, material: str, ends: tuple[Point, Point], radii: tuple[float, float]) -> Cone:
    return Cone(
        type="cone",
        name=name,
        material=material,
        start=ends[0],
        end=ends[1],
        start_radius=radii[0],
        end_radius=radii[1],
    )


def duodenum(stomach: Stomach, scale: float) -> Solid:
    """Return the duodenum from the bulb to the left of the spine."""
    from scipy.interpolate import CubicSpline

    end = np.array(stomach.lumen[-1].at) + scale * np.array(BULB[-1][0])
    drawn = scale * np.array([place for place, _ in _COURSE])
    follow = np.array([[share] for _, share in _COURSE])
    course = drawn + follow * (end - drawn[0])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(course, axis=0), axis=1))])
    line = CubicSpline(along, course)
    steps = np.linspace(0.0, along[-1], _PIECES + 1)
    places = [_point(line(at)) for at in steps]
    wall = [
        _cone(f"wall {index + 1}", WALL, ends, (scale * _GIRTH_MM,) * 2)
        for index, ends in enumerate(pairwise(places))
    ]
    narrow = [scale * (5.6 + 1.4 * math.sin(1.1 * index)) for index in range(_PIECES + 1)]
    pools: list[Solid] = [
        _cone(f"core {index + 1}", BARIUM, ends, radii)
        for index, (ends, radii) in enumerate(zip(pairwise(places), pairwise(narrow), strict=True))
    ]
    number = int(along[-1] / (scale * _APART_MM))
    for index in range(1, number):
        at = along[-1] * (index + 0.3 * math.sin(2.7 * index)) / number
        # Barium between two circular folds: a flat piece across the axis, a little askew.
        wide = scale * _GIRTH_MM * (0.82 + 0.09 * math.sin(2.1 * index))
        deep = scale * _GIRTH_MM * (0.72 + 0.14 * math.sin(1.7 * index + 1.0))
        thin = scale * _APART_MM * (0.42 + 0.10 * math.sin(1.3 * index))
        lean = np.array([math.sin(3.1 * index), math.sin(1.9 * index), math.sin(2.3 * index)])
        way = _unit(_unit(np.asarray(line(at, 1), dtype=np.float64)) + 0.16 * lean)
        middle = np.asarray(line(at), dtype=np.float64)
        pools.append(_piece(f"barium {index}", BARIUM, middle, way, (wide, deep, thin)))
    return layered(union(*wall), union(*pools))


def _piece(
    name: str, material: str, middle: FloatArray, way: FloatArray, half: tuple[float, float, float]
) -> Solid:
    """Return an ellipsoid whose third axis points this way."""
    across = _unit(np.cross(way, (0.0, 1.0, 0.0)))
    axes = np.column_stack([across, np.cross(way, across), way, middle])
    rows = tuple((float(a), float(b), float(c), float(d)) for a, b, c, d in axes)
    solid = Ellipsoid(
        type="ellipsoid", name=name, material=material, center=(0.0, 0.0, 0.0), semi_axes=half
    )
    return Transformed(type="transformed", solid=solid, matrix=(rows[0], rows[1], rows[2]))


def _unit(vector: FloatArray) -> FloatArray:
    made: FloatArray = vector / np.linalg.norm(vector)
    return made


def _point(values: FloatArray) -> Point:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
