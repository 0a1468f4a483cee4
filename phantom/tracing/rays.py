"""Free rays: path lengths, and the pieces of the final solid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phantom.errors import InvalidInputError, Problem
from phantom.geometry import tolerances
from phantom.scene import Phantom
from phantom.tracing.pool import cut_bands, run_bands

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_BAND = 512
_ROOM = 256
FARTHEST_MM = 1e6
"""Origins farther out than this are refused: a coordinate there has no 1e-10 mm left."""


@dataclass(frozen=True)
class Intervals:
    """Where rays run through the final solid: one row for each leaf that is left there.

    Rows are in the order of rays; within one ray by entry. A ray that misses has no row.

    Attributes
    ----------
    ray
        ``(K,)`` which ray.
    entry_mm, exit_mm
        ``(K,)`` distances from the ray's origin.
    leaf
        ``(K,)`` index into ``leaf_names``.
    leaf_names
        Labels of the phantom's leaves.
    """

    ray: Ints
    entry_mm: Floats
    exit_mm: Floats
    leaf: Ints
    leaf_names: tuple[str, ...]


def _vectors(name: str, given: ArrayLike, problems: list[Problem]) -> Floats:
    """Return an array ``(N, 3)``, or note what is wrong with it."""
    try:
        array = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        problems.append(Problem(f"/{name}", "not_numbers", "found no array of numbers"))
        return np.zeros((0, 3))
    if array.ndim != 2 or array.shape[1] != 3:
        message = f"found an array of shape {array.shape}; expected (N, 3)"
        problems.append(Problem(f"/{name}", "wrong_shape", message))
        return np.zeros((0, 3))
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(bad):
        message = "found a number that is not finite; expected finite numbers"
        problems.append(Problem(f"/{name}/{bad[0]}", "not_finite", message))
    return array


def check_points(points: ArrayLike) -> Floats:
    """Return points ``(P, 3)``, or raise :class:`InvalidInputError` with what is wrong."""
    problems: list[Problem] = []
    array = _vectors("points", points, problems)
    if problems:
        raise InvalidInputError(problems)
    return array


def check_rays(origins: ArrayLike, directions: ArrayLike) -> tuple[Floats, Floats]:
    """Return origins and unit directions ``(N, 3)``, or say what is wrong with them.

    Raises
    ------
    InvalidInputError
        Where shapes differ from (N, 3) or from each other, a number is not finite, a direction
        has no length, or an origin lies too far out.
    """
    problems: list[Problem] = []
    arrays = [
        _vectors(name, given, problems)
        for name, given in (("origins", origins), ("directions", directions))
    ]
    if problems:
        raise InvalidInputError(problems)
    start, along = arrays
    if len(start) != len(along):
        message = f"found {len(along)} directions for {len(start)} origins; expected as many"
        raise InvalidInputError([Problem("/directions", "wrong_shape", message)])
    # Scaled first, so that neither the smallest nor the largest vector loses its direction.
    largest = np.abs(along).max(axis=1, initial=0.0)
    for row in np.flatnonzero(largest == 0)[:1]:
        message = "found a direction of length 0; expected one that points somewhere"
        problems.append(Problem(f"/directions/{row}", "zero_vector", message))
    for row in np.flatnonzero(np.abs(start).max(axis=1, initial=0.0) > FARTHEST_MM)[:1]:
        message = f"found an origin farther out than {FARTHEST_MM:g} mm; expected it nearer"
        problems.append(Problem(f"/origins/{row}", "out_of_range", message))
    if problems:
        raise InvalidInputError(problems)
    along = along / largest[:, None]
    along /= np.linalg.norm(along, axis=1)[:, None]
    return start, along


def path_lengths(
    phantom: Phantom,
    origins: ArrayLike,
    directions: ArrayLike,
    *,
    cancelled: Callable[[], bool] | None = None,
) -> Floats:
    """Trace rays that start at their origins and go on without end.

    Parameters
    ----------
    phantom
        What is traced.
    origins
        ``(N, 3)`` mm; an origin inside a solid is legal.
    directions
        ``(N, 3)``, of any length above 0.
    cancelled
        Asked between bands of rays; yes ends the trace with :class:`CancelledError`.

    Returns
    -------
    ``(N, M)`` mm of each material on each ray, in the order of ``phantom.material_names``; a ray
    that misses has zeros.

    Raises
    ------
    InvalidInputError
        With every problem of the arrays.
    """
    start, along = check_rays(origins, directions)
    return trace(phantom, start, along, cancelled)


def trace(
    phantom: Phantom,
    start: Floats,
    along: Floats,
    cancelled: Callable[[], bool] | None = None,
) -> Floats:
    """Path lengths of rays already checked: unit directions, no end."""
    from phantom.kernels import rays as kernels

    out = np.zeros((len(start), len(phantom.material_names)))
    ends = np.full(len(start), np.inf)

    def band(first: int, last: int) -> None:
        room, at = _ROOM, first
        counter = np.zeros(1, dtype=np.int64)
        while at < last:
            stopped = kernels.path_lengths(
                phantom.compiled.scene,
                start[at:last],
                along[at:last],
                ends[at:last],
                tolerances.CHORD_MM,
                room,
                out[at:last],
                counter,
            )
            if stopped < 0:
                return
            at, room = at + stopped, 4 * room

    run_bands(band, cut_bands(len(start), _BAND), cancelled=cancelled)
    return out


def intervals(phantom: Phantom, origins: ArrayLike, directions: ArrayLike) -> Intervals:
    """Return where rays run through the final solid, and which leaves are left there.

    Parameters and errors are those of :func:`path_lengths`. Where ``overlap`` keeps several
    leaves, each has its row.
    """
    from phantom.kernels import rays as kernels

    start, along = check_rays(origins, directions)
    bands = cut_bands(len(start), _BAND)
    found: dict[int, list[tuple[Ints, Floats, Floats, Ints]]] = {b[0]: [] for b in bands}
    ends = np.full(len(start), np.inf)

    def band(first: int, last: int) -> None:
        room, rows, at = _ROOM, 16 * _BAND, first
        counter = np.zeros(1, dtype=np.int64)
        while at < last:
            ray, leaf = np.empty(rows, dtype=np.int64), np.empty(rows, dtype=np.int64)
            entry, exit_ = np.empty(rows), np.empty(rows)
            done, filled = kernels.intervals(
                phantom.compiled.scene,
                start[at:last],
                along[at:last],
                ends[at:last],
                tolerances.CHORD_MM,
                room,
                ray,
                entry,
                exit_,
                leaf,
                counter,
            )
            found[first].append(
                (
                    ray[:filled] + at,
                    entry[:filled].copy(),
                    exit_[:filled].copy(),
                    leaf[:filled].copy(),
                )
            )
            if done == 0:
                room, rows = 4 * room, 4 * rows
            at += done

    run_bands(band, bands)
    parts = [part for b in bands for part in found[b[0]]]
    if not parts:
        none = np.zeros(0, dtype=np.int64)
        return Intervals(none, np.zeros(0), np.zeros(0), none, phantom.leaf_names)
    ray, entry, exit_, leaf = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Intervals(ray, entry, exit_, leaf, phantom.leaf_names)
