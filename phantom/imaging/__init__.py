"""From a phantom and a view to a radiograph: geometry, Beer's law, presentation."""

from phantom.imaging.beam import Beam, attenuations_per_mm
from phantom.imaging.camera import Projection, box_corners, projection
from phantom.imaging.exposure import radiograph
from phantom.imaging.metadata import document_sha256
from phantom.imaging.placement import covering, place, preset_view
from phantom.imaging.poses import PRESETS, Pose, PresetName, pose
from phantom.imaging.presentation import Presentation, present
from phantom.imaging.presets import DetectorGrid, Preset
from phantom.imaging.result import IMAGES, QUANTITIES, Quantity, Radiograph
from phantom.imaging.spectrum import Spectrum
from phantom.imaging.view import Detector, View

__all__ = [
    "IMAGES",
    "PRESETS",
    "QUANTITIES",
    "Beam",
    "Detector",
    "DetectorGrid",
    "Pose",
    "Presentation",
    "Preset",
    "PresetName",
    "Projection",
    "Quantity",
    "Radiograph",
    "Spectrum",
    "View",
    "attenuations_per_mm",
    "box_corners",
    "covering",
    "document_sha256",
    "place",
    "pose",
    "present",
    "preset_view",
    "projection",
    "radiograph",
]
