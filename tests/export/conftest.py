"""An asymmetric phantom: every axis, and every side of it, can be told from the others."""

import pytest

import phantom

BODY = {
    "type": "box",
    "name": "body",
    "material": "water",
    "center": [10, 20, 30],
    "size": [40, 30, 60],
}
HEAD = {"type": "sphere", "name": "head", "material": "bone", "center": [15, 25, 80], "radius": 10}
NOSE = {"type": "sphere", "name": "nose", "material": "metal", "center": [15, 13, 80], "radius": 4}
HEART = {
    "type": "sphere",
    "name": "left/heart",
    "material": "blood",
    "center": [20, 15, 40],
    "radius": 6,
}


@pytest.fixture(scope="session")
def figure():
    """A body, a head toward +z, a nose toward the front (-y), a heart on the left (+x)."""
    return phantom.load(
        {
            "format": "phantom/1",
            "name": "figure",
            "materials": {
                "water": {"reference": "water"},
                "bone": {"reference": "cortical_bone_icru44"},
                "metal": {"attenuation_per_mm": 0.5},
                "blood": {"composition": {"H": 0.1, "O": 0.9}, "density_g_cm3": 1.06},
            },
            "solid": {
                "type": "overlap",
                "solids": [{"type": "union", "solids": [BODY, HEAD, NOSE]}, HEART],
            },
        }
    )
