"""Make the pictures of docs/imaging.md: one knee, many exposures.

Run from the project's root: ``uv run python docs/make_imaging_page.py``. The knee is that of 1993
with bones of two reference tissues, cortical outside and spongiosa inside, in a leg of muscle and
fat, so that the tube voltage counts. Every picture is a crop of the same view.
"""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

import phantom
from phantom import library
from phantom.encode.png import png

IMAGES: Final = Path("docs/images")
COLUMNS, ROWS, PITCH_MM = 300, 375, 0.6
KVP, DOSE_UGY = 70.0, 12.5
SEED: Final = 1993

SPONGIOSA: Final = 0.86
"""Reach of the spongiosa over that of the bone, along every ray from the axis of a bone."""

CORTEX_MM: Final = 1.5
"""Cortex of the bones that are ellipsoids, and about the notch."""

USUAL: Final = phantom.Presentation(mode="window", window_center=2.9, window_width=4.2)
"""The range of line integrals that is shown of a knee at 70 kV."""

WIDE: Final = phantom.Presentation(mode="window", window_center=3.3, window_width=5.4)
"""One range for all three voltages."""

BONE: Final = np.s_[290:311, 140:161]
MUSCLE: Final = np.s_[290:311, 208:217]
"""Where contrast and noise are taken: in the tibia, and beside it."""

DETECTOR: Final = {
    "absorber": {"material": "cesium_iodide", "thickness_mg_cm2": 200},
    "swank_factor": 0.9,
    "blur": {"shape": "lorentzian", "half_frequency_per_mm": 1.2},
    "electronic_noise": 200.0,
}
"""A flat panel of caesium iodide."""

GRID: Final = {"primary_transmission": 0.72, "scatter_transmission": 0.12}


def knee() -> phantom.Phantom:
    """Return the knee of 1993 in reference tissues, inside a leg."""
    tree = library.document("knee-1993").model_dump(mode="json", exclude_none=True)
    outside, inside = copy.deepcopy(tree["solid"]), copy.deepcopy(tree["solid"])
    _paint(outside, "cortex", "cortical", 0.0, 1.0)
    _paint(inside, "inside", "spongiosa", CORTEX_MM, SPONGIOSA)
    ends = {"start": [0, 2, -135], "end": [0, 2, 135], "up": [1, 0, 0], "type": "cylinder"}
    leg = [
        {**ends, "name": "fat", "material": "fat", "semi_axes": [66, 64]},
        {**ends, "name": "muscle", "material": "muscle", "semi_axes": [59, 57]},
    ]
    tissues = {
        "fat": "adipose_icru44",
        "muscle": "muscle_icru44",
        "cortical": "cortical_bone_icru44",
        "spongiosa": "spongiosa_icru44",
    }
    return phantom.load(
        {
            "format": "phantom/1",
            "name": "knee-of-tissues",
            "anatomy": tree["anatomy"],
            "materials": {name: {"reference": of} for name, of in tissues.items()},
            "solid": {"type": "replace", "solids": [*leg, outside, inside]},
        }
    )


def _paint(solid: dict[str, Any], word: str, material: str, less_mm: float, share: float) -> None:
    """Give every leaf a material and, further in, a smaller section."""
    for part in solid.get("solids", [solid["solid"]] if "solid" in solid else []):
        _paint(part, word, material, less_mm, share)
    if "name" in solid:
        solid["name"] = f"{solid['name']} {word}"
    if "material" in solid:
        solid["material"] = material
    if solid["type"] == "ellipsoid":
        inward = less_mm if "material" in solid else -less_mm
        solid["semi_axes"] = [axis - inward for axis in solid["semi_axes"]]
    if solid["type"] == "generalized_cylinder":
        contour = solid["contour"]
        if contour["type"] == "circle":
            contour["radius"] *= share
        else:
            contour["points"] = [[x * share, y * share] for x, y in contour["points"]]


def exposure(**fields: Any) -> phantom.Acquisition:
    """Return the page's usual exposure with some of its fields changed."""
    usual: dict[str, Any] = {
        "detector_air_kerma_ugy": DOSE_UGY,
        "focal_spot": {"size_mm": [0.6, 0.6], "points": [2, 2]},
        "samples_per_pixel": [2, 2],
        "detector": DETECTOR,
    }
    return phantom.Acquisition(**{**usual, **fields})


def row(pictures: list[NDArray[Any]]) -> NDArray[Any]:
    """Return pictures side by side with a white line between."""
    line = np.full((pictures[0].shape[0], 4), 255, dtype=np.uint8)
    parts = [part for picture in pictures for part in (line, picture)][1:]
    return np.concatenate(parts, axis=1)


class Room:
    """The knee in its view; what was exposed once is not exposed again."""

    def __init__(self) -> None:
        """Place the knee as a radiographer would."""
        self.body = knee()
        self.view = phantom.preset_view(
            self.body,
            "ap",
            columns=COLUMNS,
            rows=ROWS,
            pitch_mm=PITCH_MM,
            source_detector_mm=1150.0,
            object_detector_mm=100.0,
        )
        self._made: dict[str, phantom.Radiograph] = {}

    def ideal(self, kvp: float = KVP) -> phantom.Radiograph:
        """Return the knee without a detector."""
        return self._made.setdefault(
            f"{kvp}", phantom.radiograph(self.body, self.view, phantom.Beam(kvp=kvp))
        )

    def exposed(self, kvp: float = KVP, **fields: Any) -> phantom.Radiograph:
        """Return an exposure of the knee; tell its dose, its contrast and its noise."""
        key = f"{kvp} {fields}"
        if key not in self._made:
            asked = exposure(**fields)
            noise = phantom.NoiseKey(seed=SEED)
            made = phantom.radiograph(
                self.body, self.view, phantom.Beam(kvp=kvp), acquisition=asked, noise=noise
            )
            self._made[key] = made
            self._tell(key, made, self.ideal(kvp))
        return self._made[key]

    def _tell(self, key: str, made: phantom.Radiograph, ideal: phantom.Radiograph) -> None:
        bone, muscle = (float(made.signal[patch].mean()) for patch in (BONE, MUSCLE))
        even = made.signal[BONE] / ideal.transmission[BONE]
        contrast, noise = 1 - bone / muscle, float(even.std() / even.mean())
        bucky = made.metadata()["exposure"]["bucky_factor"]
        print(f"{key}: bone / open {bone / made.open_field:.4f}, contrast {contrast:.3f}, ", end="")
        print(f"noise {noise:.3f}, contrast to noise {contrast / noise:.1f}, Bucky {bucky}")


def main() -> None:
    """Make every picture, and print what the page tells of them."""
    room = Room()
    scatter: dict[str, Any] = {"scatter": {}}
    rows = {
        "kvp": [room.exposed(kvp).presented("signal", WIDE) for kvp in (50.0, 70.0, 90.0)],
        "dose": [
            room.exposed(**({} if dose == DOSE_UGY else {"detector_air_kerma_ugy": dose}))
            .presented("signal", USUAL)
            for dose in (0.5, 2.5, 12.5)
        ],
        "scatter": [
            room.exposed(**more).presented("signal", USUAL)
            for more in ({}, scatter, {**scatter, "grid": GRID})
        ],
        "stretch": [
            room.exposed().presented("signal", USUAL),
            room.ideal().presented("signal", USUAL),
            room.ideal().presented("signal", phantom.Presentation()),
        ],
    }  # fmt: skip
    for name, pictures in rows.items():
        path = IMAGES / f"imaging-{name}.png"
        path.write_bytes(png(row(pictures), {}))
        print(path, path.stat().st_size)


if __name__ == "__main__":
    main()
