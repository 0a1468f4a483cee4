"""Pairs of radiographs: where the tube stands for each eye, and what the two pictures share."""

from phantom.imaging.stereo.exposure import check_eye, pair_of, placed, stereo_pair
from phantom.imaging.stereo.eyes import Eyes, eyes
from phantom.imaging.stereo.pair import EyePicture, StereoPair

__all__ = [
    "EyePicture",
    "Eyes",
    "StereoPair",
    "check_eye",
    "eyes",
    "pair_of",
    "placed",
    "stereo_pair",
]
