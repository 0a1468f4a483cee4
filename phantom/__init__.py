"""Exact X-ray images of phantoms made of generalized cylinders, quadrics and densities.

Public names are loaded when they are first used, so that ``import phantom`` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from phantom import datasets, library
    from phantom.errors import (
        CancelledError,
        InvalidDocumentError,
        InvalidInputError,
        PhantomError,
        Problem,
        UnknownPhantomError,
    )
    from phantom.export import export_mesh, export_volume, label_volume
    from phantom.imaging import (
        Absorber,
        Acquisition,
        Beam,
        Blur,
        Detector,
        DetectorModel,
        Digitizer,
        FocalSpot,
        Grid,
        NoiseKey,
        Presentation,
        Radiograph,
        Scatter,
        StereoPair,
        View,
        preset_view,
        radiograph,
        stereo_pair,
    )
    from phantom.scene import Phantom, load
    from phantom.stereo import Screen
    from phantom.tessellation import tessellate
    from phantom.tracing import (
        FirstHits,
        Intervals,
        first_hits,
        intervals,
        materials_at,
        path_lengths,
    )
    from phantom.visible import (
        Camera,
        CameraPreset,
        DirectionalLight,
        Lighting,
        Picture,
        PointLight,
        Tone,
        Wireframe,
        preset_camera,
        preview,
        render,
        render_pair,
        wireframe,
    )

    __version__: str

__all__ = [
    "Absorber",
    "Acquisition",
    "Beam",
    "Blur",
    "Camera",
    "CameraPreset",
    "CancelledError",
    "Detector",
    "DetectorModel",
    "Digitizer",
    "DirectionalLight",
    "FirstHits",
    "FocalSpot",
    "Grid",
    "Intervals",
    "InvalidDocumentError",
    "InvalidInputError",
    "Lighting",
    "NoiseKey",
    "Phantom",
    "PhantomError",
    "Picture",
    "PointLight",
    "Presentation",
    "Problem",
    "Radiograph",
    "Scatter",
    "Screen",
    "StereoPair",
    "Tone",
    "UnknownPhantomError",
    "View",
    "Wireframe",
    "__version__",
    "datasets",
    "export_mesh",
    "export_volume",
    "first_hits",
    "intervals",
    "label_volume",
    "library",
    "load",
    "materials_at",
    "path_lengths",
    "preset_camera",
    "preset_view",
    "preview",
    "radiograph",
    "render",
    "render_pair",
    "stereo_pair",
    "tessellate",
    "wireframe",
]

_HOMES = {
    "phantom.errors": (
        "CancelledError",
        "InvalidDocumentError",
        "InvalidInputError",
        "PhantomError",
        "Problem",
        "UnknownPhantomError",
    ),
    "phantom.export": ("export_mesh", "export_volume", "label_volume"),
    "phantom.imaging": (
        "Absorber",
        "Acquisition",
        "Beam",
        "Blur",
        "Detector",
        "DetectorModel",
        "Digitizer",
        "FocalSpot",
        "Grid",
        "NoiseKey",
        "Presentation",
        "Radiograph",
        "Scatter",
        "StereoPair",
        "View",
        "preset_view",
        "radiograph",
        "stereo_pair",
    ),
    "phantom.scene": ("Phantom", "load"),
    "phantom.stereo": ("Screen",),
    "phantom.tessellation": ("tessellate",),
    "phantom.tracing": (
        "FirstHits",
        "Intervals",
        "first_hits",
        "intervals",
        "materials_at",
        "path_lengths",
    ),
    "phantom.visible": (
        "Camera",
        "CameraPreset",
        "DirectionalLight",
        "Lighting",
        "Picture",
        "PointLight",
        "Tone",
        "Wireframe",
        "preset_camera",
        "preview",
        "render",
        "render_pair",
        "wireframe",
    ),
}
_HOME = {name: home for home, found in _HOMES.items() for name in found}


def __getattr__(name: str) -> object:
    """Load a public name when it is first asked for (PEP 562)."""
    if name in ("datasets", "library"):
        return import_module(f"phantom.{name}")
    if name == "__version__":
        from importlib.metadata import version

        value: object = version("phantom-xray")
    elif name in _HOME:
        value = getattr(import_module(_HOME[name]), name)
    else:
        raise AttributeError(f"module 'phantom' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
