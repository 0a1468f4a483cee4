"""What is thin in a breast: ducts, Cooper's ligaments, the septa between lobules of fat, vessels.

Each is a chain of short straight pieces: tubes taper along it; ligaments and septa are bands, thin
and some millimetres wide, which show where the beam runs along them, as in patients. Drawn in the
frame of :mod:`phantoms.breast.tissue`; sizes and numbers are estimates.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from phantom.document import Cone, Cylinder
from phantoms.breast.tissue import Body, Branch, curve, point

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

_OF_TEN: Final = "dlsldlsldl"
"""Kinds of ten strands one after the other: ducts, ligaments and septa."""
_TO_A_VESSEL: Final = 20


class Strands(NamedTuple):
    """Pieces of all strands.

    Attributes
    ----------
    solids
        The pieces.
    volume_mm3
        What they fill together.
    size
        How thick they are beside those of a breast of usual size.
    """

    solids: list[Cone | Cylinder]
    volume_mm3: float
    size: float


def strands(
    body: Body, branches: list[Branch], number: int, generator: np.random.Generator
) -> Strands:
    """Return this many ducts along the branches, ligaments, septa and vessels."""
    made = Strands([], 0.0, min(1.0, body.half_mm / 28.0, body.semi_axes[1] / 90.0))
    ducts = iter(branches)
    for index in range(number):
        label = f"{index + 1:03d}"
        if index % _TO_A_VESSEL == _TO_A_VESSEL - 1:
            points, radii = _vessel(body, generator)
            made = _tube(made, f"vessel-{label}", points, radii)
            continue
        kind = _OF_TEN[index % 10]
        branch = next(ducts, None) if kind == "d" else None
        if branch is not None:
            made = _tube(made, f"duct-{label}", branch.points, branch.radii_mm)
        elif kind == "s":
            made = _band(made, f"septum-{label}", _septum(body, generator), generator)
        else:
            made = _band(made, f"ligament-{label}", _ligament(body, generator), generator)
    return made


def _ligament(body: Body, generator: np.random.Generator) -> FloatArray:
    """Return an arch from the gland forward to the skin."""
    a, b, _ = body.semi_axes
    turn = generator.uniform(-1.35, 1.35)
    height = generator.uniform(-0.85, 0.85) * body.half_mm
    skin = np.array([a * math.sin(turn), -b * math.cos(turn), 0.0])
    skin *= math.sqrt(max(1.0 - (height / body.semi_axes[2]) ** 2, 0.1))
    reach = generator.uniform(0.12, 0.32) * b
    lean = turn + generator.normal(0.0, 0.6)
    start = skin * (1.0 - 0.2 / b)
    end = start - reach * np.array([math.sin(lean), -math.cos(lean), 0.0])
    start[2], end[2] = height, 0.75 * height
    end[1] = min(end[1], -2.0)
    across = np.array([math.cos(lean), math.sin(lean), 0.0])
    return curve(start, end, generator.normal(0.0, 0.2) * reach * across, 6)


def _septum(body: Body, generator: np.random.Generator) -> FloatArray:
    """Return part of a ring, as the wall of a lobule of fat is seen."""
    a, b, _ = body.semi_axes
    while True:
        turn, height, far = generator.random(3)
        turn = 3.0 * turn - 1.5
        far = 0.35 + 0.55 * math.sqrt(far)
        center = np.array(
            [far * a * math.sin(turn), -far * b * math.cos(turn), (1.7 * height - 0.85)]
        )
        center[2] *= body.half_mm
        radius = float(generator.uniform(4.0, 11.0))
        first, span = generator.uniform(0.0, 2 * math.pi), generator.uniform(1.2, 3.2)
        squeeze = generator.uniform(0.5, 1.0)
        if body.holds(center[None], 2.0)[0]:
            break
    at = first + np.linspace(0.0, span, 8)
    ring = np.stack([np.cos(at), squeeze * np.sin(at), 0.15 * np.sin(2 * at)], axis=1)
    return center + radius * ring


def _vessel(body: Body, generator: np.random.Generator) -> tuple[FloatArray, tuple[float, float]]:
    """Return a vessel that runs from the chest wall under the skin toward the nipple."""
    a, b, _ = body.semi_axes
    side = -1.0 if generator.random() < 0.65 else 1.0
    level = 0.72 * body.half_mm * (1.0 if generator.random() < 0.5 else -1.0)
    start = np.array([side * generator.uniform(0.35, 0.85) * a, -1.0, level])
    end = np.array(
        [side * generator.uniform(0.02, 0.35) * a, -generator.uniform(0.5, 0.8) * b, 0.0]
    )
    end[2] = 0.8 * level
    bow = np.array([side * generator.uniform(-0.02, 0.10) * a, 0.0, 0.0])
    points = curve(start, end, bow, 18)
    along = np.linspace(0.0, 1.0, len(points))
    phase, waves = generator.uniform(0.0, 2 * math.pi), generator.uniform(2.0, 3.5)
    swing = generator.uniform(0.6, 1.8)
    points[:, 0] += swing * np.sin(2 * math.pi * waves * along + phase)
    wide = float(generator.uniform(1.0, 1.9))
    return points, (wide, 0.5 * wide)


def _tube(made: Strands, name: str, points: FloatArray, radii_mm: tuple[float, float]) -> Strands:
    radii = made.size * np.linspace(*radii_mm, len(points))
    volume = made.volume_mm3
    for index, (start, end) in enumerate(pairwise(points)):
        thick, thin = float(radii[index]), float(radii[index + 1])
        volume += math.pi * thick * thin * float(np.linalg.norm(end - start))
        made.solids.append(
            Cone(
                type="cone",
                name=f"{name}-{index + 1:02d}",
                material="gland",
                start=point(start),
                end=point(end),
                start_radius=thick,
                end_radius=thin,
            )
        )
    return made._replace(volume_mm3=volume)


def _band(made: Strands, name: str, points: FloatArray, generator: np.random.Generator) -> Strands:
    """Add a band along the points, its width about along z."""
    thin = made.size * math.exp(generator.normal(-1.5, 0.3))
    wide = made.size * float(generator.uniform(1.0, 4.0))
    tilt = generator.normal(0.0, 0.25, 2)
    volume = made.volume_mm3
    steps = len(points) - 1
    for index, (start, end) in enumerate(pairwise(points)):
        share = (index + 0.5) / steps
        width = wide * (0.55 + 0.45 * math.sin(math.pi * share))
        volume += math.pi * thin * width * float(np.linalg.norm(end - start))
        made.solids.append(
            Cylinder(
                type="cylinder",
                name=f"{name}-{index + 1:02d}",
                material="gland",
                start=point(start),
                end=point(end),
                semi_axes=(width, thin),
                up=(float(tilt[0]), float(tilt[1]), 1.0),
            )
        )
    return made._replace(volume_mm3=volume)
