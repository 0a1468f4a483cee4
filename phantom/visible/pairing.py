"""Looking at a phantom in visible light with two eyes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from phantom.errors import InvalidInputError
from phantom.scene import Phantom
from phantom.stereo import Stereo, disparities, disparity_of_all, separation, structures
from phantom.stereo.spacing import STEP
from phantom.tracing.shown import shown_leaves
from phantom.visible.camera import Camera
from phantom.visible.eyes import CameraPair, cameras, check_cameras, fixed
from phantom.visible.lights import Color, Lighting
from phantom.visible.pair import PicturePair
from phantom.visible.picture import Picture
from phantom.visible.presets import CameraPreset
from phantom.visible.rendering import BLACK, camera_of, render


def render_pair(
    phantom: Phantom,
    camera: Camera | CameraPreset | None = None,
    *,
    lighting: Lighting | None = None,
    background: Color = BLACK,
    samples_per_pixel: int = 2,
    hide: Sequence[str] = (),
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
    **stereo: Any,
) -> PicturePair:
    """Look at a phantom in visible light with two eyes.

    Parameters
    ----------
    phantom, camera, lighting, background, samples_per_pixel, hide, workers, cancelled, progress
        As for :func:`phantom.visible.render`; the camera is the one between the eyes, and its
        target is what is seen in the screen by default. Lamps that go with the camera stay where
        that one has them, so that both eyes see one light.
    **stereo
        Any field of :class:`phantom.stereo.Stereo` but ``dose``, such as ``baseline_mm``.

    Raises
    ------
    InvalidInputError
        As for a picture; what has no stereo geometry (under ``/stereo``).
    CancelledError
        ``cancelled`` turned true.
    """
    return pictures_of(
        phantom,
        camera,
        Stereo(**stereo),
        lighting=lighting,
        background=background,
        samples_per_pixel=samples_per_pixel,
        hide=hide,
        workers=workers,
        cancelled=cancelled,
        progress=progress,
    )


def pictures_of(
    phantom: Phantom,
    camera: Camera | CameraPreset | None,
    asked: Stereo,
    *,
    lighting: Lighting | None = None,
    hide: Sequence[str] = (),
    progress: Callable[[int, int], None] | None = None,
    **look: Any,
) -> PicturePair:
    """Look as :func:`render_pair` does, from what was asked of the eyes as a whole."""
    flags = shown_leaves(phantom, hide)
    shown = frozenset(np.flatnonzero(flags).tolist())
    middle = camera_of(phantom, camera, flags)
    eyes = placed_cameras(phantom, middle, asked, shown)
    light = fixed(lighting if lighting is not None else Lighting(), middle)

    def seen(one: Camera, before: int, of: int) -> Picture:
        def told(done: int, total: int) -> None:
            assert progress is not None
            progress(before * total + done, of * total)

        counted = None if progress is None else told
        return render(phantom, one, lighting=light, hide=hide, progress=counted, **look)

    if asked.mono is not None:
        left = right = seen(middle, 0, 1)
    else:
        left, right = seen(eyes.left, 0, 2), seen(eyes.right, 1, 2)
    matrices = (eyes.left.matrix, eyes.right.matrix)
    return PicturePair(
        phantom=phantom,
        camera=middle,
        stereo=asked,
        eyes=eyes,
        left=left,
        right=right,
        disparities=disparities(structures(phantom, shown), *matrices, asked.screen),
        whole=disparity_of_all(phantom, *matrices, asked.screen, shown),
    )


def placed_cameras(
    phantom: Phantom, camera: Camera, stereo: Stereo, shown: frozenset[int]
) -> CameraPair:
    """Return the cameras of both eyes, with the largest separation for ``auto``.

    Parameters
    ----------
    phantom, camera, stereo
        What is looked at, from between the eyes, and what is asked of them.
    shown
        Numbers of the leaves that are not looked through.

    Raises
    ------
    InvalidInputError
        What has no stereo geometry (under ``/stereo``).
    """
    check_cameras(camera, stereo)

    def worst_deg(apart: float) -> float:
        try:
            tried = cameras(camera, stereo, apart)
        except InvalidInputError:
            return math.inf
        left, right = tried.left.matrix, tried.right.matrix
        return disparity_of_all(phantom, left, right, stereo.screen, shown).worst_deg

    depth_mm = cameras(camera, stereo, STEP[stereo.method]).zero_depth_mm
    return cameras(camera, stereo, separation(stereo, worst_deg, depth_mm))
