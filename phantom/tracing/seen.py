"""Free rays of visible light: what each sees first, and how the surface lies there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phantom.scene import Phantom
from phantom.tracing.hits import face_slack_mm, hits_of_rays
from phantom.tracing.parameters import parameters_of
from phantom.tracing.pool import cut_bands, run_bands
from phantom.tracing.rays import check_rays
from phantom.tracing.shown import shown_leaves

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_BAND = 4096


@dataclass(frozen=True, eq=False)
class FirstHits:
    """What rays see first, one row a ray.

    Attributes
    ----------
    distance_mm
        ``(N,)`` from the ray's origin; inf for a miss.
    normal
        ``(N, 3)`` unit vector out of the final solid; nan for a miss.
    leaf
        ``(N,)`` index into ``leaf_names`` of the leaf that is seen, -1 for a miss.
    surface_leaf
        ``(N,)`` of the leaf whose surface it is: another one where a difference has cut.
    uv
        ``(N, 2)`` parameters of a swept surface (:mod:`phantom.tracing.parameters`); v is nan on
        its flat ends, both are nan on every other surface and for a miss.
    inside
        ``(N,)`` true where the ray starts in the solid and sees its wall from within.
    leaf_names
        Labels of the phantom's leaves.
    """

    distance_mm: Floats
    normal: Floats
    leaf: Ints
    surface_leaf: Ints
    uv: Floats
    inside: NDArray[np.bool_]
    leaf_names: tuple[str, ...]


def first_hits(
    phantom: Phantom,
    origins: ArrayLike,
    directions: ArrayLike,
    *,
    hide: Sequence[str] = (),
    cancelled: Callable[[], bool] | None = None,
) -> FirstHits:
    """Return what rays see first: the first place where the final solid begins or ends.

    What lasts no longer than 1e-9 of the phantom's size, such as the sliver between two faces that
    coincide, is not seen.

    Parameters
    ----------
    phantom
        What is looked at.
    origins
        ``(N, 3)`` mm; an origin inside a solid is legal.
    directions
        ``(N, 3)``, of any length above 0.
    hide
        Materials, and labels of leaves or groups, that are looked through.
    cancelled
        Asked between bands of rays; yes ends the trace with :class:`CancelledError`.

    Raises
    ------
    InvalidInputError
        With every problem of the arrays, or of the names to hide.
    """
    from phantom.kernels import normals as kernels

    shown = shown_leaves(phantom, hide)
    start, along = check_rays(origins, directions)
    count, scene = len(start), phantom.compiled.scene
    distances, hits = np.full(count, np.inf), np.full((count, 4), -1, dtype=np.int64)
    outward, faces = np.full((count, 3), np.nan), np.full((count, 2), -1, dtype=np.int64)
    taus = np.zeros(count)
    points = np.zeros((count, 3))

    def band(first: int, last: int) -> None:
        rows = slice(first, last)
        distances[rows], hits[rows] = hits_of_rays(phantom, start[rows], along[rows], shown)
        met = first + np.flatnonzero(np.isfinite(distances[rows]))
        points[met] = start[met] + distances[met, None] * along[met]
        normal, face, tau = np.empty((len(met), 3)), faces[met], np.empty(len(met))
        slack = face_slack_mm(phantom)
        kernels.normals(scene, points[met], hits[met, 0], slack, normal, face, tau)
        outward[met], faces[met], taus[met] = normal * hits[met, 2:3], face, tau

    run_bands(band, cut_bands(count, _BAND), cancelled=cancelled)
    segment = faces[:, 1]
    swept = segment >= 0
    u = np.full(count, np.nan)
    spans = scene.spans[segment[swept]]
    u[swept] = spans.mean(axis=1) + 0.5 * taus[swept] * np.diff(spans, axis=1)[:, 0]
    uv = parameters_of(phantom, hits[:, 0], points, u, faces[:, 0] == kernels.SIDE)
    return FirstHits(
        distances, outward, hits[:, 1], hits[:, 0], uv, hits[:, 3] == 1, phantom.leaf_names
    )
