"""What files say of a pair, as plain JSON values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from phantom.stereo.telling import stereo_told

if TYPE_CHECKING:
    from phantom.imaging.result import Radiograph
    from phantom.imaging.stereo.pair import StereoPair

SHARED: Final = ("software", "phantom", "units", "axes", "beam")
"""What is the same of both images."""


def pair_metadata(pair: StereoPair) -> dict[str, Any]:
    """Return the metadata of a pair: what is shared, the stereo part, and that of each image."""
    images = {eye: image.metadata() for eye, image in pair.images.items()}
    first = next(iter(images.values()))
    return {
        **{name: first[name] for name in SHARED},
        "view": pair.view.model_dump(mode="json"),
        "stereo": stereo_metadata(pair),
        "disparities": [found.told() for found in pair.disparities],
        "images": {
            eye: {name: value for name, value in told.items() if name not in SHARED}
            for eye, told in images.items()
        },
        "warnings": list(pair.warnings),
    }


def eye_metadata(pair: StereoPair, eye: str, radiograph: Radiograph) -> dict[str, Any]:
    """Return the metadata of one image of a pair: that of a radiograph, and the stereo part."""
    middle = {"view": pair.view.model_dump(mode="json")}
    return {**radiograph.metadata(), "stereo": {"eye": eye, **stereo_metadata(pair), **middle}}


def stereo_metadata(pair: StereoPair) -> dict[str, Any]:
    """Return the geometry of a pair, and what it asks of the eyes."""
    return stereo_told(
        pair.stereo,
        baseline_mm=pair.eyes.baseline_mm,
        angle_deg=pair.eyes.angle_deg,
        zero_depth_mm=pair.eyes.zero_depth_mm,
        whole=pair.whole,
        comfort=pair.comfort,
        matrix=pair.epipolar_matrix,
    )
