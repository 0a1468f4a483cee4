"""X-raying a phantom for two eyes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from phantom.errors import InvalidInputError, Problem
from phantom.imaging.beam import Beam
from phantom.imaging.camera import projection
from phantom.imaging.detection import Acquisition, NoiseKey
from phantom.imaging.detection.acquisition import AIR_KERMA_UGY
from phantom.imaging.exposure import radiograph
from phantom.imaging.refusals import check_exposure
from phantom.imaging.stereo.eyes import Eyes, check_stereo, eyes
from phantom.imaging.stereo.pair import StereoPair
from phantom.imaging.view import FloatArray, View
from phantom.stereo import Stereo, disparities, disparity_of_all, separation, structures
from phantom.stereo.spacing import STEP

if TYPE_CHECKING:
    from phantom.scene import Phantom

MONO, LEFT, RIGHT = 0, 1, 2
"""The eye of a noise key: that of a radiograph by itself, and those of a pair."""


def stereo_pair(
    phantom: Phantom,
    view: View,
    beam: Beam | None = None,
    *,
    acquisition: Acquisition | None = None,
    noise: NoiseKey | None = None,
    isocentre: FloatArray | None = None,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
    **stereo: Any,
) -> StereoPair:
    """X-ray a phantom for the left and the right eye.

    Parameters
    ----------
    phantom, view, beam, acquisition, workers, cancelled, progress
        As for :func:`phantom.imaging.radiograph`; the view is the one between the eyes.
    noise
        Whose noise; each eye has its own, and ``eye`` of the key is not to be given.
    isocentre
        (3,) world point that is seen in the screen by default, and that a rotation is about; by
        default the phantom's own.
    **stereo
        Any field of :class:`phantom.stereo.Stereo`, such as ``baseline_mm`` or ``method``.

    Raises
    ------
    InvalidInputError
        What has no image, as for a radiograph, or no stereo geometry (under ``/stereo``).
    CancelledError
        ``cancelled`` turned true.
    """
    return pair_of(
        phantom,
        view,
        beam,
        Stereo(**stereo),
        acquisition=acquisition,
        noise=noise,
        isocentre=isocentre,
        workers=workers,
        cancelled=cancelled,
        progress=progress,
    )


def pair_of(
    phantom: Phantom,
    view: View,
    beam: Beam | None,
    asked: Stereo,
    *,
    acquisition: Acquisition | None = None,
    noise: NoiseKey | None = None,
    isocentre: FloatArray | None = None,
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> StereoPair:
    """X-ray a phantom for two eyes, as :func:`stereo_pair` does, from what was asked as a whole."""
    check_eye(noise)
    found = placed(phantom, view, asked, isocentre)
    beam = beam if beam is not None else Beam()

    def exposed(eye: View, name: int, before: int, of: int) -> Any:
        return radiograph(
            phantom,
            eye,
            beam,
            acquisition=_dosed(acquisition, asked),
            noise=_keyed(noise, acquisition, name),
            workers=workers,
            cancelled=cancelled,
            progress=None if progress is None else _part(progress, before, of),
        )

    if asked.mono is not None:
        left = right = exposed(view, MONO, 0, 1)
    else:
        for eye in (found.left, found.right):
            check_exposure(phantom, eye, beam, acquisition)
        left = exposed(found.left, LEFT, 0, 2)
        right = exposed(found.right, RIGHT, 1, 2)
    cameras = (left.projection_matrix, right.projection_matrix)
    return StereoPair(
        phantom=phantom,
        view=view,
        stereo=asked,
        eyes=found,
        left=left,
        right=right,
        disparities=disparities(structures(phantom), *cameras, asked.screen),
        whole=disparity_of_all(phantom, *cameras, asked.screen),
        warnings=tuple(dict.fromkeys((*left.warnings, *right.warnings))),
    )


def check_eye(noise: NoiseKey | None) -> None:
    """Refuse a noise key that names an eye: those of a pair have their own (``/noise/eye``)."""
    if noise is not None and noise.eye != 0:
        message = f"found {noise.eye}; expected none, for each eye of a pair has its own noise"
        raise InvalidInputError([Problem("/noise/eye", "no_effect", message)])


def placed(
    phantom: Phantom, view: View, stereo: Stereo, isocentre: FloatArray | None = None
) -> Eyes:
    """Return the views of both eyes around a phantom, with the largest separation for ``auto``.

    Raises
    ------
    InvalidInputError
        What has no stereo geometry (under ``/stereo``).
    """
    aim = np.asarray(phantom.isocentre if isocentre is None else isocentre, dtype=np.float64)
    check_stereo(view, stereo, aim)
    return eyes(view, stereo, _separation(phantom, view, stereo, aim), aim)


def _separation(phantom: Phantom, view: View, stereo: Stereo, isocentre: FloatArray) -> float:
    """Return the baseline in mm or the angle in degrees; 0 for a mono arm."""

    def worst_deg(apart: float) -> float:
        try:
            tried = eyes(view, stereo, apart, isocentre)
        except InvalidInputError:
            return math.inf
        left, right = (projection(eye).matrix for eye in (tried.left, tried.right))
        return disparity_of_all(phantom, left, right, stereo.screen).worst_deg

    depth_mm = eyes(view, stereo, STEP[stereo.method], isocentre).zero_depth_mm
    return separation(stereo, worst_deg, depth_mm)


def _dosed(acquisition: Acquisition | None, stereo: Stereo) -> Acquisition | None:
    """Return the exposure of one image: half the dose where a pair shares it."""
    if acquisition is None or stereo.dose == "per_image" or stereo.mono is not None:
        return acquisition
    if acquisition.mas is not None:
        return acquisition.model_copy(update={"mas": acquisition.mas / 2})
    kerma = acquisition.detector_air_kerma_ugy
    half = (AIR_KERMA_UGY if kerma is None else kerma) / 2
    return acquisition.model_copy(update={"detector_air_kerma_ugy": half})


def _keyed(noise: NoiseKey | None, acquisition: Acquisition | None, eye: int) -> NoiseKey | None:
    """Return the noise of an eye; None where nothing is said of it and nothing is drawn."""
    if noise is None and (acquisition is None or not acquisition.draws):
        return None
    return (noise if noise is not None else NoiseKey()).model_copy(update={"eye": eye})


def _part(progress: Callable[[int, int], None], before: int, of: int) -> Callable[[int, int], None]:
    """Return a progress that counts one image's rows among those of all."""

    def told(done: int, total: int) -> None:
        progress(before * total + done, of * total)

    return told
