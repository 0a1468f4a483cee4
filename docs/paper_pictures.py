"""Draw figures 8, 9 and 10 of the 1993 paper, side by side as it shows them.

Run from the project's root: ``uv run python docs/paper_pictures.py``. Figure 8 is the deformed
object, figure 9 the rotary fan beside one of its blades: on the left the (u, v) net, on the right
the exact surface in visible light. Figure 10 is the knee in X-rays from two views.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import phantom
from phantom.encode import write_atomically
from phantom.encode.png import png

IMAGES = Path("docs/images")
SIDE = 520
GAP = 12
WHITE = (1.0, 1.0, 1.0)
INK = (0.02, 0.05, 0.12)

LIGHTING = phantom.Lighting(
    lights=(
        phantom.DirectionalLight(to_light=(-0.7, 0.8, 0.9), intensity=1.1, fixed_to="camera"),
        phantom.DirectionalLight(to_light=(1.0, -0.3, 0.4), intensity=0.35, fixed_to="camera"),
    )
)

GLAZE = {"color": (0.62, 0.22, 0.12), "ambient": 0.12, "diffuse": 0.6, "specular": 0.28}
METAL = {"color": (0.42, 0.52, 0.62), "ambient": 0.12, "diffuse": 0.55, "specular": 0.33}
SHINE = 30.0


def seen_from(azimuth_deg: float, elevation_deg: float, zoom: float) -> phantom.CameraPreset:
    return phantom.CameraPreset(
        azimuth_deg=azimuth_deg, elevation_deg=elevation_deg, zoom=zoom, columns=SIDE, rows=SIDE
    )


def painted(name: str, look: dict[str, Any]) -> phantom.Phantom:
    """Return a phantom of the library, all of its leaves with one look."""

    def paint(solid: Any) -> Any:
        for inner in ("solids", "solid"):
            if inner in solid:
                parts = solid[inner]
                below = list(map(paint, parts)) if inner == "solids" else paint(parts)
                return {**solid, inner: below}
        is_leaf = solid["type"] != "instance"
        return {**solid, "appearance": {**look, "exponent": SHINE}} if is_leaf else solid

    tree = phantom.library.build(name).document.model_dump(mode="json", exclude_none=True)
    tree["definitions"] = {k: paint(v) for k, v in tree.get("definitions", {}).items()}
    return phantom.load({**tree, "solid": paint(tree["solid"])})


def drawn(shape: phantom.Phantom, camera: Any, rings: int, lines: int) -> NDArray[np.uint8]:
    net = phantom.wireframe(shape, camera, rings=rings, lines=lines, ink=INK)
    return np.asarray(net.levels(), dtype=np.uint8)


def traced(shape: phantom.Phantom, camera: Any) -> NDArray[np.uint8]:
    picture = phantom.render(
        shape, camera, lighting=LIGHTING, background=WHITE, samples_per_pixel=3
    )
    return np.asarray(picture.levels(), dtype=np.uint8)


def xrayed(shape: phantom.Phantom, name: Any) -> NDArray[np.uint8]:
    view = phantom.preset_view(shape, name, columns=SIDE, rows=SIDE)
    image = phantom.radiograph(shape, view, phantom.Beam(energy_kev=60))
    grey = image.presented("signal", phantom.Presentation(polarity="bones_white"))
    return np.asarray(np.repeat(grey[..., None], 3, axis=2), dtype=np.uint8)


def blade(fan: phantom.Phantom) -> phantom.Phantom:
    """Return one of the fan's blades as a phantom."""
    tree = fan.document.model_dump(mode="json", exclude_none=True)
    (solid,) = tree["definitions"].values()
    kept = {name: tree[name] for name in ("format", "name", "materials")}
    return phantom.load({**kept, "solid": solid})


def figure_8() -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    shape, camera = painted("deformed", GLAZE), seen_from(-10.0, -26.0, 1.12)
    return drawn(shape, camera, 34, 40), traced(shape, camera)


def figure_9() -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    fan = painted("fan", METAL)
    return (
        drawn(blade(fan), seen_from(50.0, 12.0, 0.98), 34, 30),
        traced(fan, seen_from(24.0, 14.0, 1.1)),
    )


def figure_10() -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    knee = phantom.library.build("knee-1993")
    return xrayed(knee, "ap"), xrayed(knee, "mediolateral")


FIGURES = {"figure-8.png": figure_8, "figure-9.png": figure_9, "figure-10.png": figure_10}


def main() -> None:
    IMAGES.mkdir(exist_ok=True)
    for name, draw in FIGURES.items():
        left, right = draw()
        gap = np.full((SIDE, GAP, 3), 255, dtype=np.uint8)
        write_atomically(IMAGES / name, png(np.hstack([left, gap, right]), {}))
        print(f"wrote {IMAGES / name}")


if __name__ == "__main__":
    main()
