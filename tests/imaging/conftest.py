"""Phantoms of a few spheres, whose every chord is known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom.scene import Phantom, load

BALLS: dict[str, Any] = {
    "format": "phantom/1",
    "name": "balls",
    "materials": {"water": {"reference": "water"}, "fixed": {"attenuation_per_mm": 0.03}},
    "solid": {
        "type": "overlap",
        "solids": [
            {
                "type": "sphere",
                "name": "large",
                "center": [0, 0, 0],
                "radius": 30,
                "material": "water",
            },
            {
                "type": "sphere",
                "name": "left",
                "center": [25, 0, 10],
                "radius": 8,
                "material": "fixed",
            },
        ],
    },
}


@pytest.fixture
def balls() -> Phantom:
    """A water ball of 30 mm about the origin, and a dense one of 8 mm at (25, 0, 10) over it."""
    return load(BALLS)


@pytest.fixture
def ball_at() -> Callable[..., Phantom]:
    """A single ball of a fixed 0.02/mm, with anything else put at the document's root."""

    def build(center: tuple[float, float, float], radius: float, **root: Any) -> Phantom:
        solid = {"type": "sphere", "center": center, "radius": radius, "material": "m"}
        tree = {"format": "phantom/1", "name": "ball", "solid": solid}
        return load({**tree, "materials": {"m": {"attenuation_per_mm": 0.02}}, **root})

    return build


@pytest.fixture
def chord() -> Callable[..., float]:
    """Length of a line's path through a ball, from the line's distance to its centre."""

    def through(start: Any, end: Any, center: Any, radius: float) -> float:
        start, end, center = (np.asarray(p, dtype=float) for p in (start, end, center))
        along = (end - start) / np.linalg.norm(end - start)
        offset = center - start
        squared = radius**2 - float(offset @ offset - (offset @ along) ** 2)
        return 2 * np.sqrt(max(squared, 0.0))

    return through
