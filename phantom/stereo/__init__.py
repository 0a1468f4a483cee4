"""Two pictures for two eyes: what is asked, what it gives to see, and whether eyes can bear it.

Nothing here knows what makes the pictures; a view's projection matrices are all that is needed.
"""

from phantom.stereo.comfort import Comfort, comfort
from phantom.stereo.disparity import Disparity, disparities, disparity_of_all, structures
from phantom.stereo.epipolar import fundamental_matrix
from phantom.stereo.screen import Screen
from phantom.stereo.settings import Stereo, ZeroPlane
from phantom.stereo.spacing import largest, separation
from phantom.stereo.telling import stereo_told

__all__ = [
    "Comfort",
    "Disparity",
    "Screen",
    "Stereo",
    "ZeroPlane",
    "comfort",
    "disparities",
    "disparity_of_all",
    "fundamental_matrix",
    "largest",
    "separation",
    "stereo_told",
    "structures",
]
