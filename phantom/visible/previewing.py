"""A fast, coarse picture for the review of a model (paper III.E): tessellated leaves, a z-buffer.

The leaves are tessellated once and kept with the phantom; each picture after that is a matter of
their triangles. Operators and hidden leaves are taken on every pixel's own intervals.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from phantom.document.identity import identity
from phantom.scene import Phantom
from phantom.tessellation import check_tolerance, tessellate
from phantom.tracing.pool import cut_bands, run_bands
from phantom.tracing.shown import shown_leaves
from phantom.visible.camera import Camera
from phantom.visible.lights import Color, Lighting, light_arrays
from phantom.visible.looks import looks
from phantom.visible.picture import Picture
from phantom.visible.presets import CameraPreset
from phantom.visible.rendering import BLACK, camera_of, check_samples, view_of
from phantom.visible.zbuffer import Facets, ZBuffer, facets

Floats = NDArray[np.float64]

COARSE = 1e-3
"""Tolerance of a preview, as a share of the phantom's diagonal, where none is given."""

_BAND_ROWS = 32


def preview(
    phantom: Phantom,
    camera: Camera | CameraPreset | None = None,
    *,
    lighting: Lighting | None = None,
    background: Color = BLACK,
    samples_per_pixel: int = 1,
    tolerance_mm: float | None = None,
    hide: Sequence[str] = (),
    workers: int | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Picture:
    """Look at a tessellated phantom.

    The first picture of a phantom tessellates its leaves; they are kept with it, so that the next
    ones, from anywhere and in any light, are fast. There are no shadows.

    Parameters
    ----------
    phantom
        What is looked at.
    camera, background, samples_per_pixel, hide, workers, cancelled
        As of :func:`phantom.render`.
    lighting
        As of :func:`phantom.render`; its shadows are left out.
    tolerance_mm
        How far a triangle may lie from the surface; by default a thousandth of the diagonal of the
        phantom's box.
    progress
        As in :func:`phantom.tracing.pool.run_bands`: leaves, then rows.

    Raises
    ------
    InvalidInputError
        As :func:`phantom.render`; and at ``/tolerance_mm``.
    CancelledError
        ``cancelled`` turned true.
    """
    check_samples(samples_per_pixel)
    shown = shown_leaves(phantom, hide)
    tolerance = preview_tolerance_mm(phantom, tolerance_mm)
    camera = camera_of(phantom, camera, shown)
    lighting = lighting if lighting is not None else Lighting()
    model = _model(phantom, tolerance, cancelled, progress)
    samples = samples_per_pixel
    view = view_of(phantom, camera, samples)
    raster = ZBuffer(phantom, model, camera, view, shown, samples)
    appearance, ambient = looks(phantom), np.array(lighting.ambient, dtype=np.float64)
    lights = light_arrays(lighting, camera)
    rgb = np.zeros((camera.rows, camera.columns, 3))
    coverage = np.zeros((camera.rows, camera.columns))

    def band(first: int, last: int) -> None:
        from phantom.kernels.phong import shade_facets

        seen = raster.rows(first * samples, last * samples)
        shade_facets(
            view,
            first * samples,
            seen.t,
            seen.hits,
            seen.normals,
            appearance,
            ambient,
            *lights,
            samples,
            rgb[first:last],
            coverage[first:last],
        )

    bands = cut_bands(camera.rows, _BAND_ROWS)
    run_bands(band, bands, workers=workers, cancelled=cancelled, progress=progress)
    coverage = np.minimum(coverage, 1.0)
    rgb += (1.0 - coverage)[..., None] * np.array(background)
    told = {
        **identity(phantom.document),
        "lighting": lighting.model_copy(update={"shadows": False}).model_dump(mode="json"),
        "background": list(background),
        "samples_per_pixel": samples,
        "tolerance_mm": tolerance,
        "triangles": len(model.leaf),
        "hidden": list(hide),
        "warnings": [] if coverage.any() else ["nothing of the phantom is in the picture"],
    }
    return Picture(rgb, coverage, camera, "preview", told)


def preview_tolerance_mm(phantom: Phantom, asked_mm: float | None) -> float:
    """Return the tolerance that is meant, or refuse it (``/tolerance_mm``)."""
    if asked_mm is None:
        return COARSE * float(np.linalg.norm(phantom.bounds[1] - phantom.bounds[0]))
    check_tolerance(asked_mm)
    return asked_mm


def _model(
    phantom: Phantom,
    tolerance_mm: float,
    cancelled: Callable[[], bool] | None,
    progress: Callable[[int, int], None] | None,
) -> Facets:
    """Return the facets that are kept with the phantom, made anew for another tolerance."""

    def make() -> Facets:
        meshes = tessellate(phantom, tolerance_mm, cancelled=cancelled, progress=progress)
        return facets(meshes, tolerance_mm)

    model = phantom.kept("facets", make)
    if model.tolerance_mm != tolerance_mm:
        model = phantom.kept("facets", make, anew=True)
    return model
