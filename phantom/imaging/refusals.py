"""What cannot be exposed, told before anything is traced."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.geometry.vectors import box_corners
from phantom.imaging.beam import Beam
from phantom.imaging.camera import projection
from phantom.imaging.detection import Acquisition, Window, traced_window
from phantom.imaging.detection.falloff import source_detector_mm
from phantom.imaging.detection.kerma import photons_per_mm2
from phantom.imaging.view import View

if TYPE_CHECKING:
    from phantom.scene import Phantom


def check_exposure(
    phantom: Phantom, view: View, beam: Beam, acquisition: Acquisition | None
) -> None:
    """Refuse what has no image.

    Raises
    ------
    InvalidInputError
        A detector behind the source: none of the phantom's bounding box lies on the detector's side
        of it (``/view/source``); a tube load without a tube, or with a parallel beam
        (``/acquisition/mas``); a blur that reaches too far (``/acquisition/detector/blur``).
    """
    depth_mm = projection(view).depth_mm(box_corners(phantom.bounds))
    if view.source is not None and float(np.max(depth_mm)) <= 0.0:
        message = (
            f"found the phantom {-float(np.max(depth_mm)):g} mm or more behind the source; "
            "expected it on the detector's side"
        )
        raise InvalidInputError([Problem("/view/source", "detector_behind_source", message)])
    if acquisition is None:
        return
    photons_per_mm2(beam.spectrum(), acquisition, source_detector_mm(view))
    traced_window(view, acquisition, Window.whole(view.detector))
