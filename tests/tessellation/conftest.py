"""Documents of one solid."""

import pytest

import phantom
from phantom.document import LEAVES


@pytest.fixture(scope="session")
def solid():
    """Return a function that loads a document of one solid of material ``m``."""

    def build(**leaf):
        if leaf.get("type") in LEAVES:
            leaf.setdefault("material", "m")
        return phantom.load(
            {
                "format": "phantom/1",
                "name": "test",
                "materials": {"m": {"attenuation_per_mm": 0.01}},
                "solid": leaf,
            }
        )

    return build
