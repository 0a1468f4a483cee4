"""Two pictures for two eyes: what is asked, what it gives to see, and whether eyes can bear it.

Nothing here knows what makes the pictures; a view's projection matrices are all that is needed.
"""

from phantom.stereo.comfort import Comfort, comfort
from phantom.stereo.disparity import Disparity, disparities, structures
from phantom.stereo.epipolar import fundamental_matrix
from phantom.stereo.screen import Screen
from phantom.stereo.settings import Stereo, ZeroPlane
from phantom.stereo.spacing import largest

__all__ = [
    "Comfort",
    "Disparity",
    "Screen",
    "Stereo",
    "ZeroPlane",
    "comfort",
    "disparities",
    "fundamental_matrix",
    "largest",
    "structures",
]
