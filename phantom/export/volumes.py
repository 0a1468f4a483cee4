"""A phantom as a volume of labels: which material is at the centre of every voxel."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from phantom.errors import CancelledError, InvalidInputError, Problem
from phantom.export.tables import MaterialRow, material_rows
from phantom.scene import Phantom
from phantom.tracing import intervals

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Labels = NDArray[np.uint8] | NDArray[np.uint16]
Spacing = float | Sequence[float]

MOST_VOXELS: Final = 2**30
"""A volume of more is refused before anything is allocated."""

_CHUNK = 1 << 21
_LEAST_MM: Final = 1e-3


@dataclass(frozen=True, eq=False)
class LabelVolume:
    """Voxels of labels.

    Attributes
    ----------
    labels
        ``(nx, ny, nz)``, uint8 or uint16; 0 where nothing is present. x, y and z are the
        document's.
    origin_mm
        ``(3,)`` centre of voxel (0, 0, 0), in the document's axes (LPS).
    spacing_mm
        ``(3,)`` from one centre to the next.
    energy_kev
        Of the rows' attenuation.
    rows
        What every label is; label k is row k.
    """

    labels: Labels
    origin_mm: tuple[float, float, float]
    spacing_mm: tuple[float, float, float]
    energy_kev: float
    rows: tuple[MaterialRow, ...]


def check_spacing(spacing_mm: Spacing) -> tuple[float, float, float]:
    """Return the spacing along x, y and z.

    Raises
    ------
    InvalidInputError
        At ``/spacing_mm``: no length, nor three, of at least a micrometre.
    """
    try:
        given = np.asarray(spacing_mm, dtype=np.float64)
    except (TypeError, ValueError):
        given = np.zeros(0)
    if given.shape not in ((), (3,)) or not np.all(np.isfinite(given) & (given >= _LEAST_MM)):
        message = f"found {str(spacing_mm)[:60]}; expected a length of {_LEAST_MM:g} mm or more, "
        message += "or three of them"
        raise InvalidInputError([Problem("/spacing_mm", "out_of_range", message)])
    x, y, z = np.broadcast_to(given, 3).tolist()
    return x, y, z


def label_volume(
    phantom: Phantom,
    spacing_mm: Spacing = 1.0,
    *,
    energy_kev: float = 60.0,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LabelVolume:
    """Sample a phantom at the centres of voxels.

    The faces of the voxels lie at whole multiples of the spacing, so that volumes of different
    phantoms fit on one another; one voxel of nothing lies all round. The label of a material is its
    place in ``phantom.material_names``, counted from 1; where ``overlap`` leaves several materials,
    or one several times, the mixture has a label of its own after those.

    Parameters
    ----------
    phantom
        What is sampled.
    spacing_mm
        One length, or three along x, y and z.
    energy_kev
        Photon energy of the attenuation in the rows.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts rows of voxels.

    Raises
    ------
    InvalidInputError
        At ``/spacing_mm``: no length, or so fine that there are too many voxels; at
        ``/energy_kev``.
    CancelledError
        Where ``cancelled`` said yes.
    """
    spacing = check_spacing(spacing_mm)
    low = [
        math.floor(float(a) / s + 1e-9) - 1 for a, s in zip(phantom.bounds[0], spacing, strict=True)
    ]
    high = [
        math.ceil(float(b) / s - 1e-9) + 1 for b, s in zip(phantom.bounds[1], spacing, strict=True)
    ]
    nx, ny, nz = (b - a for a, b in zip(low, high, strict=True))
    if nx * ny * nz > MOST_VOXELS:
        message = f"found {nx} × {ny} × {nz} voxels; expected {MOST_VOXELS} at most"
        raise InvalidInputError([Problem("/spacing_mm", "too_large", message)])
    material_rows(phantom, energy_kev)  # refused before anything is sampled
    x, y, z = (
        (first + 0.5 + np.arange(count)) * s
        for first, count, s in zip(low, (nx, ny, nz), spacing, strict=True)
    )
    coder = _Coder(len(phantom.material_names))
    labels = np.zeros((nx, ny, nz), dtype=np.uint16, order="F")
    centers = (x, y, z)
    # Rays along the axis with the most voxels: each answers for a whole row of them.
    along = int(np.argmax(labels.shape))
    one, two = (axis for axis in range(3) if axis != along)
    rows_of_voxels = np.moveaxis(labels, (one, two, along), (0, 1, 2))
    width = rows_of_voxels.shape[1]
    step = max(1, _CHUNK // (width * labels.shape[along] * len(phantom.material_names)))
    for first in range(0, len(rows_of_voxels), step):
        if cancelled is not None and cancelled():
            raise CancelledError("the sampling was cancelled")
        last = min(first + step, len(rows_of_voxels))
        origins = np.empty((last - first, width, 3))
        origins[..., one] = centers[one][first:last, None]
        origins[..., two] = centers[two]
        origins[..., along] = centers[along][0]
        counts = _counts(
            phantom, origins.reshape(-1, 3), along, spacing[along], labels.shape[along]
        )
        found = coder.labels(counts.reshape(-1, counts.shape[-1]))
        rows_of_voxels[first:last] = found.reshape(last - first, width, -1)
        if progress is not None:
            progress(last, len(rows_of_voxels))
    rows = material_rows(phantom, energy_kev, coder.mixtures)
    small: Labels = labels.astype(np.uint8) if len(rows) <= 256 else labels
    return LabelVolume(small, (float(x[0]), float(y[0]), float(z[0])), spacing, energy_kev, rows)


def _counts(phantom: Phantom, origins: Floats, axis: int, step_mm: float, voxels: int) -> Ints:
    """Return how often each material is present ``(rays, voxels, M)`` from the origins on.

    A centre on a surface counts as what lies before it, so that touching solids share none.
    """
    directions = np.zeros_like(origins)
    directions[:, axis] = 1.0
    pieces = intervals(phantom, origins, directions)
    material = phantom.leaf_materials[pieces.leaf]
    seen = material >= 0
    ray, material = pieces.ray[seen], material[seen]
    begin = np.floor(pieces.entry_mm[seen] / step_mm).astype(np.int64) + 1
    # What begins at the origin has been there before it.
    begin = np.where(pieces.entry_mm[seen] <= 0.0, 0, begin)
    end = np.floor(pieces.exit_mm[seen] / step_mm).astype(np.int64) + 1
    change = np.zeros((len(origins), voxels + 1, len(phantom.material_names)), dtype=np.int32)
    np.add.at(change, (ray, np.minimum(begin, voxels), material), 1)
    np.add.at(change, (ray, np.minimum(end, voxels), material), -1)
    return np.asarray(change.cumsum(axis=1)[:, :voxels], dtype=np.int64)


class _Coder:
    """Gives every set of materials its label, in the order in which they are met."""

    def __init__(self, materials: int) -> None:
        self._known: dict[tuple[int, ...], int] = {}
        self._first = materials + 1

    @property
    def mixtures(self) -> list[tuple[int, ...]]:
        """How often each material is present, of every label after those of the materials."""
        return list(self._known)

    def labels(self, counts: Ints) -> Ints:
        """Return the labels of counts ``(P, M)``."""
        total = counts.sum(axis=1)
        found = np.where(total == 1, counts.argmax(axis=1) + 1, 0)
        mixed = np.flatnonzero(total > 1)
        distinct, which = np.unique(counts[mixed], axis=0, return_inverse=True)
        known = [
            self._known.setdefault(tuple(mixture), self._first + len(self._known))
            for mixture in distinct.tolist()
        ]
        found[mixed] = np.array(known, dtype=np.int64)[which.reshape(-1)]
        return np.asarray(found, dtype=np.int64)
