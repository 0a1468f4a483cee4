"""Beads at known places, each of a material of its own, so that each has an image of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom.imaging import Detector, View
from phantom.scene import Phantom, load

BEADS: dict[str, tuple[float, float, float]] = {
    "middle": (0.0, 0.0, 0.0),
    "front": (1.0, -40.0, 1.5),
    "back": (-1.5, 35.0, -1.0),
    "side": (3.0, 12.0, 0.5),
}
"""World places in mm; -y is the patient's front, where the tube of AP is."""

RADIUS_MM = 0.4
SOURCE_DETECTOR_MM, SOURCE_ISOCENTRE_MM, PITCH_MM = 1000.0, 900.0, 0.02
COLUMNS, ROWS = 500, 340


@pytest.fixture(scope="session")
def beads() -> Phantom:
    """Four beads about the isocentre."""
    balls = [
        {"type": "sphere", "name": name, "center": list(at), "radius": RADIUS_MM, "material": name}
        for name, at in BEADS.items()
    ]
    return load(
        {
            "format": "phantom/1",
            "name": "beads",
            "materials": {name: {"attenuation_per_mm": 0.1} for name in BEADS},
            "solid": {"type": "overlap", "solids": balls},
            "landmarks": {"isocentre": [0, 0, 0], **{n: list(p) for n, p in BEADS.items()}},
        }
    )


@pytest.fixture(scope="session")
def bead_view() -> Callable[[str], View]:
    """AP or PA of the beads: the tube before or behind, right and down as on the light box."""

    def view(pose: str) -> View:
        toward = {"ap": 1.0, "pa": -1.0}[pose]
        return View(
            source=[0, -toward * SOURCE_ISOCENTRE_MM, 0],
            detector=Detector(
                center=[0, toward * (SOURCE_DETECTOR_MM - SOURCE_ISOCENTRE_MM), 0],
                right=[1, 0, 0],
                down=[0, 0, -1],
                columns=COLUMNS,
                rows=ROWS,
                pitch_mm=PITCH_MM,
            ),
        )

    return view


@pytest.fixture(scope="session")
def seen() -> Callable[[Any], dict[str, Any]]:
    """Where a radiograph shows each bead: the middle of its own path lengths.

    They count with their fourth power: a chord squared is r² less the ray's distance squared, and
    its square falls to 0 smoothly, so that pixels sample it well.
    """

    def centres(image: Any) -> dict[str, Any]:
        found = {}
        for index, name in enumerate(image.phantom.material_names):
            lengths = image.path_lengths[..., index] ** 4
            rows, columns = np.indices(lengths.shape)
            mass = lengths.sum()
            assert mass > 0, f"{name} is not in the picture"
            found[name] = np.array(
                [(lengths * columns).sum() / mass, (lengths * rows).sum() / mass]
            )
        return found

    return centres
