"""Shaded pictures: the first hit of every ray, lit by Phong's model (paper II.G)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from phantom.document.identity import identity
from phantom.errors import InvalidInputError, Problem
from phantom.geometry.vectors import box_corners
from phantom.scene import Phantom
from phantom.tracing.shading import shaded
from phantom.tracing.shown import shown_leaves
from phantom.visible.camera import Camera
from phantom.visible.lights import Color, Lighting, light_arrays
from phantom.visible.looks import looks
from phantom.visible.picture import Picture
from phantom.visible.presets import CameraPreset

Floats = NDArray[np.float64]
Flags = NDArray[np.uint8]

MAX_SAMPLES = 8
"""Most samples along a side of a pixel."""

BLACK: Color = (0.0, 0.0, 0.0)


def render(
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
) -> Picture:
    """Look at a phantom in visible light.

    What is seen is the surface of the final solid, traced by the same intervals as X-rays. Each
    leaf looks as its ``appearance`` in the document says, else as its material does
    (:mod:`phantom.visible.looks`).

    Parameters
    ----------
    phantom
        What is looked at.
    camera
        From where; a preset is fitted to what is shown. By default from the front, a little from
        the patient's left and above.
    lighting
        Light from everywhere and lights; by default two lights that move with the camera.
    background
        Linear red, green and blue of a ray that hits nothing.
    samples_per_pixel
        Rays along each side of a pixel, 1 to 8; their light is averaged.
    hide
        Materials, and labels of leaves or groups, that are looked through: a skin around bones.
    workers, cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts rows.

    Returns
    -------
    The picture; a pixel whose rays hit nothing is the background. A camera inside a solid sees its
    wall from within.

    Raises
    ------
    InvalidInputError
        An unknown name to hide (``/hide/i``), or samples out of range (``/samples_per_pixel``).
    CancelledError
        ``cancelled`` turned true.
    """
    check_samples(samples_per_pixel)
    shown = shown_leaves(phantom, hide)
    camera = camera_of(phantom, camera, shown)
    lighting = lighting if lighting is not None else Lighting()
    samples = samples_per_pixel
    rgb, coverage = shaded(
        phantom,
        view_of(phantom, camera, samples),
        camera.rows,
        camera.columns,
        samples,
        shown,
        looks(phantom),
        np.array(lighting.ambient, dtype=np.float64),
        light_arrays(lighting, camera),
        shadows=lighting.shadows,
        workers=workers,
        cancelled=cancelled,
        progress=progress,
    )
    rgb += (1.0 - coverage)[..., None] * np.array(background)
    told = {
        **identity(phantom.document),
        "lighting": lighting.model_dump(mode="json"),
        "background": list(background),
        "samples_per_pixel": samples,
        "hidden": list(hide),
        "warnings": [] if coverage.any() else ["nothing of the phantom is in the picture"],
    }
    return Picture(rgb, coverage, camera, "shaded", told)


def check_samples(samples_per_pixel: int) -> None:
    """Refuse a number of samples that is out of range (``/samples_per_pixel``)."""
    if not 1 <= samples_per_pixel <= MAX_SAMPLES:
        message = f"found {samples_per_pixel}; expected 1 to {MAX_SAMPLES}"
        raise InvalidInputError([Problem("/samples_per_pixel", "out_of_range", message)])


def camera_of(phantom: Phantom, camera: Camera | CameraPreset | None, shown: Flags) -> Camera:
    """Return the camera itself, or the preset fitted to the leaves that are shown."""
    if isinstance(camera, Camera):
        return camera
    preset = camera if camera is not None else CameraPreset()
    leaves = [leaf for leaf in phantom.surfacing_leaves if shown[leaf]]
    boxes = phantom.leaf_bounds[leaves]
    # What operators take away need not be in the picture.
    boxes = np.clip(boxes, phantom.bounds[0], phantom.bounds[1])
    return preset.camera(boxes if len(boxes) else phantom.bounds)


def view_of(phantom: Phantom, camera: Camera, samples: int = 1) -> Floats:
    """Return the (6, 3) rays of a camera as :class:`phantom.tracing.hits.HitRaster` wants them.

    Each ray ends in a plane beyond the whole phantom; one with everything behind it is short.
    """
    corners = np.concatenate([box_corners(box) for box in phantom.leaf_bounds])
    far = max(float(camera.project(corners)[1].max()), 0.0) + 1.0
    right, down, forward = camera.axes
    step = camera.pitch / samples
    # The first sample of the first pixel: half a pixel back, half a sample forth.
    corner = np.array(0.5 / samples - 0.5)
    first = camera.offsets(corner, corner)
    view = np.zeros((6, 3))
    view[0] = camera.eye
    if camera.parallel_width_mm is None:
        view[3], view[4], view[5] = far * (first + forward), far * step * down, far * step * right
    else:
        view[0] += first
        view[1], view[2], view[3] = step * down, step * right, far * forward
    return view
