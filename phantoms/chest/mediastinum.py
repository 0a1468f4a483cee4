"""Heart, great vessels, airways and the soft tissue between the lungs.

The heart is one column of sections along z whose left and right reach are the borders that a PA
view shows; the aorta is one generalized cylinder from its root over the arch to the diaphragm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from phantom.document import Solid, SplineContour
from phantoms.chest.cage import Cage
from phantoms.chest.courses import AORTA, ARTERIES, BRONCHI, TRACHEA, VEINS, Course
from phantoms.chest.frame import MODEL_HEART_MM, Frame
from phantoms.chest.shapes import Row, chain, column, fitted, sampled, tube
from phantoms.chest.spine import spine_y
from phantoms.parts import union

# z, right and left border, front and back of the heart, drawn.
HEART: Final = (
    (-112.0, 22.0, 44.0, -62.0, -38.0),
    (-108.0, 4.0, 64.0, -72.0, -26.0),
    (-100.0, -17.0, 76.0, -79.0, -12.0),
    (-90.0, -29.0, 82.0, -82.0, 0.0),
    (-76.0, -36.5, 83.3, -82.0, 11.0),
    (-58.0, -39.5, 78.0, -80.0, 20.0),
    (-38.0, -39.5, 66.0, -75.0, 25.0),
    (-20.0, -37.0, 53.5, -68.0, 25.0),
    (-4.0, -33.0, 45.5, -60.0, 21.0),
    (12.0, -27.0, 41.0, -52.0, 13.0),
    (24.0, -22.0, 38.0, -46.0, 4.0),
    (34.0, -15.0, 30.0, -40.0, -6.0),
    (40.0, -6.0, 20.0, -34.0, -14.0),
)
# The section: its left end, the apex, lies in front.
_HEART_SHAPE: Final = SplineContour(
    type="spline",
    points=(
        (1.0, -0.30), (0.90, -0.66), (0.62, -0.91), (0.25, -1.0), (-0.2, -0.95), (-0.62, -0.74),
        (-0.92, -0.36), (-1.0, 0.06), (-0.90, 0.46), (-0.62, 0.80), (-0.20, 0.99), (0.22, 0.96),
        (0.58, 0.70), (0.86, 0.24),
    ),
)  # fmt: skip
# z, right, left, front and back of the soft tissue between the lungs, above the heart.
_MIDDLE: Final = (
    (234.0, -34.0, 34.0, -44.0, 18.0),
    (150.0, -34.0, 34.0, -34.0, 24.0),
    (128.0, -24.0, 25.0, -36.0, 30.0),
    (112.0, -21.0, 20.0, -40.0, 34.0),
    (95.0, -21.0, 17.0, -40.0, 36.0),
    (75.0, -22.0, 16.0, -42.0, 38.0),
    (50.0, -24.0, 22.0, -44.0, 40.0),
    (25.0, -24.0, 29.0, -44.0, 40.0),
    (0.0, -20.0, 33.0, -42.0, 40.0),
    (-40.0, -16.0, 34.0, -40.0, 42.0),
    (-90.0, -14.0, 32.0, -40.0, 42.0),
    (-230.0, -18.0, 26.0, -40.0, 40.0),
)


# The section of what lies about the ribs' necks: thin toward its sides, so that they cast no edge.
_NECKS_SHAPE: Final = SplineContour(
    type="spline",
    points=(
        (0.0, -1.0), (0.32, -0.93), (0.46, -0.80), (0.58, -0.58), (0.70, -0.12), (0.85, 0.24),
        (1.0, 0.55), (0.84, 0.78), (0.5, 0.95), (0.0, 1.0), (-0.5, 0.95), (-0.84, 0.78),
        (-1.0, 0.55), (-0.85, 0.24), (-0.70, -0.12), (-0.58, -0.58), (-0.46, -0.80),
        (-0.32, -0.93),
    ),
)  # fmt: skip


def heart_rows(frame: Frame) -> list[Row]:
    """Return the sections of a person's heart, as wide as it is to be."""
    wide = frame.sizes.heart_width_mm / MODEL_HEART_MM
    across = wide / frame.x  # the chest's own stretch is undone
    rows: list[Row] = []
    for z, right, left, front, back in sampled(HEART, 12):
        middle = 0.5 * (front + back)
        half = 0.5 * (back - front) * min(max(wide / frame.y, 0.85), 1.15)
        # The heart rides on the diaphragm.
        lower = frame.deeper_mm * min(max((30.0 - z) / 130.0, 0.0), 1.0)
        rows.append((z - lower, right * across, left * across, middle - half, middle + half))
    return fitted(frame, rows)


def heart(frame: Frame) -> Solid:
    """Return the heart with the blood in it."""
    return column("heart", heart_rows(frame), "blood", _HEART_SHAPE)


def _tubes(frame: Frame, tables: Mapping[str, Course], scale: float, material: str) -> list[Solid]:
    return [
        tube(name, frame.path([p for p, _ in table]), [r * scale for _, r in table], material)
        for name, table in tables.items()
    ]


def aorta(frame: Frame) -> Solid:
    """Return the aorta, root to diaphragm, as one generalized cylinder."""
    radius = frame.sizes.aorta_mm / 2
    points = frame.path([p for p, _ in AORTA])
    return tube("aorta", points, [share * radius for _, share in AORTA], "blood")


def great_vessels(frame: Frame) -> Solid:
    """Return the aorta, its branches, the great veins and the pulmonary arteries."""
    scale = frame.bone
    return union(
        aorta(frame),
        *_tubes(frame, ARTERIES, scale, "blood"),
        *_chains(frame, VEINS, 0.0, "", "blood"),
    )


def airways(frame: Frame) -> Solid:
    """Return the air in the trachea and the first bronchi."""
    return union(
        *_tubes(frame, {"trachea": TRACHEA}, frame.bone, "air"),
        *_chains(frame, BRONCHI, 0.0, "", "air"),
    )


def bronchial_walls(frame: Frame) -> Solid:
    """Return the walls of the bronchi where they run through lung."""
    return union(*_chains(frame, BRONCHI, 1.2, "wall of ", "soft_tissue"))


def _chains(
    frame: Frame, tables: Mapping[str, Course], more_mm: float, before: str, material: str
) -> list[Solid]:
    """Return tubes drawn as chains of cones, so much wider."""
    return [
        part
        for name, table in tables.items()
        for part in chain(
            before + name,
            frame.path([p for p, _ in table]),
            [r * frame.bone + more_mm for _, r in table],
            material,
        )
    ]


def middle(cage: Cage) -> Solid:
    """Return the soft tissue between the lungs and that beside the spine."""
    f = cage.frame
    core = column("mediastinum", sampled(fitted(f, _MIDDLE), 10), "soft_tissue")
    rows: list[Row] = []
    behind: list[Row] = []
    for z in range(-230, 235, 45):
        y = spine_y(float(z))
        half = 19.5 + 3.0 * math.exp(-(((z + 60.0) / 90.0) ** 2))
        back = 46.0 if z < 130 else 32.0
        rows.append((float(z), -half, half, y - 15.0, y + back))
    for z in range(-240, 121, 40):
        y = spine_y(float(z))
        behind.append((float(z), -66.0, 66.0, y + 1.0, y + 47.0))
    beside = column("tissue beside the spine", fitted(f, rows), "muscle")
    necks = column("muscle about the ribs' necks", fitted(f, behind), "muscle", _NECKS_SHAPE)
    return union(core, beside, necks)
