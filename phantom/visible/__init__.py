"""Visible light: the same solids as a camera sees them."""

from phantom.visible.camera import Camera
from phantom.visible.drawing import Wireframe, wireframe
from phantom.visible.lights import DirectionalLight, Lighting, PointLight
from phantom.visible.pair import PicturePair
from phantom.visible.pairing import render_pair
from phantom.visible.picture import Picture
from phantom.visible.presets import CAMERA_NAMES, CameraPreset, preset_camera
from phantom.visible.previewing import preview
from phantom.visible.rendering import render
from phantom.visible.tone import Tone

__all__ = [
    "CAMERA_NAMES",
    "Camera",
    "CameraPreset",
    "DirectionalLight",
    "Lighting",
    "Picture",
    "PicturePair",
    "PointLight",
    "Tone",
    "Wireframe",
    "preset_camera",
    "preview",
    "render",
    "render_pair",
    "wireframe",
]
