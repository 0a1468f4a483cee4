"""From a phantom and a view to a radiograph: geometry, Beer's law, presentation."""

from phantom.document.identity import document_sha256
from phantom.imaging.beam import Beam, attenuations_per_mm
from phantom.imaging.camera import Projection, projection
from phantom.imaging.detection import (
    Absorber,
    Acquisition,
    Blur,
    DetectorModel,
    Digitizer,
    FocalSpot,
    Grid,
    NoiseKey,
    Scatter,
)
from phantom.imaging.exposure import radiograph
from phantom.imaging.gsdf import Gsdf
from phantom.imaging.placement import covering, place, preset_view
from phantom.imaging.poses import PRESETS, Pose, PresetName, pose
from phantom.imaging.presentation import Presentation, contrast_jnd, present
from phantom.imaging.presets import DetectorGrid, Preset
from phantom.imaging.result import IMAGES, QUANTITIES, Quantity, Radiograph
from phantom.imaging.spectrum import Spectrum
from phantom.imaging.stereo import StereoPair, stereo_pair
from phantom.imaging.truth import KINDS, LeafTruth, Truth
from phantom.imaging.truth_trace import ground_truth
from phantom.imaging.view import Detector, View
from phantom.imaging.visibility import Visibility, visibility

__all__ = [
    "IMAGES",
    "KINDS",
    "PRESETS",
    "QUANTITIES",
    "Absorber",
    "Acquisition",
    "Beam",
    "Blur",
    "Detector",
    "DetectorGrid",
    "DetectorModel",
    "Digitizer",
    "FocalSpot",
    "Grid",
    "Gsdf",
    "LeafTruth",
    "NoiseKey",
    "Pose",
    "Presentation",
    "Preset",
    "PresetName",
    "Projection",
    "Quantity",
    "Radiograph",
    "Scatter",
    "Spectrum",
    "StereoPair",
    "Truth",
    "View",
    "Visibility",
    "attenuations_per_mm",
    "contrast_jnd",
    "covering",
    "document_sha256",
    "ground_truth",
    "place",
    "pose",
    "present",
    "preset_view",
    "projection",
    "radiograph",
    "stereo_pair",
    "visibility",
]
