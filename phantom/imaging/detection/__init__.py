"""Detector and tube: from path lengths and a spectrum to what a detector hands out."""

from phantom.imaging.detection.acquisition import Acquisition, FocalSpot, Grid, Scatter
from phantom.imaging.detection.chain import Exposed, expose, traced_window
from phantom.imaging.detection.draws import ELECTRONICS, QUANTA, NoiseKey
from phantom.imaging.detection.focal_spot import source_points
from phantom.imaging.detection.receptor import Absorber, Blur, DetectorModel, Digitizer
from phantom.imaging.detection.scatter import air_gap_mm, scatter_lattice
from phantom.imaging.detection.window import Lattice, Window, lattice

__all__ = [
    "ELECTRONICS",
    "QUANTA",
    "Absorber",
    "Acquisition",
    "Blur",
    "DetectorModel",
    "Digitizer",
    "Exposed",
    "FocalSpot",
    "Grid",
    "Lattice",
    "NoiseKey",
    "Scatter",
    "Window",
    "air_gap_mm",
    "expose",
    "lattice",
    "scatter_lattice",
    "source_points",
    "traced_window",
]
