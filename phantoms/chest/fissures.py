"""The fissures between the lobes: thin curved sheets of pleura, each a shell of a large ball.

The oblique fissure of each lung runs from the back at the fifth rib down to the diaphragm in front;
the horizontal one of the right lung from there forward at the height of the hilum. All lie so that
they are seen on edge where a radiograph shows them: the oblique ones in a lateral, the horizontal
one in both views. Their courses and thickness are estimates.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from phantom.document import Difference, Instance, Intersection, Solid, Sphere
from phantoms.chest.frame import Frame
from phantoms.parts import union

SHEET_MM: Final = 0.6
"""Two layers of pleura and the lung that the detector cannot tell from them."""
# Drawn: the middle of a lung, and y and z of the fissure's upper and lower end.
_OBLIQUE: Final = {
    "right": (-76.0, (84.0, 44.0), (-64.0, -116.0)),
    "left": (78.0, (86.0, 54.0), (-58.0, -122.0)),
}
_OBLIQUE_RADIUS_MM: Final = 420.0
_HORIZONTAL: Final = (-78.0, -30.0, 4.0)
_HORIZONTAL_RADIUS_MM: Final = 170.0


def _ball(name: str, centre: np.ndarray, radius: float, material: str | None = None) -> Sphere:
    x, y, z = map(float, centre)
    return Sphere(type="sphere", name=name, material=material, center=(x, y, z), radius=radius)


def _oblique(frame: Frame, side: str) -> tuple[np.ndarray, float]:
    """Return middle and radius of the ball whose shell is the fissure; it holds the lower lobe."""
    x, (y_up, z_up), (y_down, z_down) = _OBLIQUE[side]
    up = np.array(frame.at(x, y_up, z_up))
    down = np.array(frame.at(x, y_down, z_down - frame.deeper_mm))
    along = (up - down) / np.linalg.norm(up - down)
    below = np.array([0.0, along[2], -along[1]])
    half = float(np.linalg.norm(up - down)) / 2
    radius = _OBLIQUE_RADIUS_MM * frame.y
    return (up + down) / 2 + np.sqrt(radius**2 - half**2) * below, radius


def _sheet(name: str, side: str, centre: np.ndarray, radius: float, *less: Solid) -> Solid:
    """Return the part of a ball's shell that lies in a lung."""
    outer = _ball(name, centre, radius, "pleura")
    inner = _ball(f"inside of {name}", centre, radius - SHEET_MM)
    bounds = Instance(type="instance", of=f"{side} lung", name=f"bounds of {name}")
    shell = Difference(type="difference", solids=(outer, inner, *less))
    return Intersection(type="intersection", solids=(shell, bounds))


def fissures(frame: Frame) -> Solid:
    """Return the oblique fissures of both lungs and the horizontal one of the right."""
    sheets = [_sheet(f"{side} oblique fissure", side, *_oblique(frame, side)) for side in _OBLIQUE]
    x, y, z = frame.at(*_HORIZONTAL)
    radius = _HORIZONTAL_RADIUS_MM * frame.x
    lower_lobe = _ball("right lower lobe behind the fissure", *_oblique(frame, "right"))
    centre = np.array([x, y, z - radius])
    return union(*sheets, _sheet("horizontal fissure", "right", centre, radius, lower_lobe))
