"""Every leaf of a phantom as a closed mesh, with the net that it is drawn by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.placed import placed_leaves
from phantom.errors import CancelledError, InvalidInputError, Problem
from phantom.geometry.halfspaces import Halfspaces
from phantom.geometry.quadrics import QuadricShape, bounds, quadric
from phantom.geometry.transforms import Similarity
from phantom.scene import Phantom
from phantom.tessellation.caps import cut
from phantom.tessellation.mesh import Mesh, collapsed, joined
from phantom.tessellation.nets import Net
from phantom.tessellation.quadrics import quadric_nets
from phantom.tessellation.surfaces import surface
from phantom.tessellation.swept import swept_nets

Floats = NDArray[np.float64]

_SURFACE, _SNAP, _SHORT = 0.95, 0.03, 0.01
"""Shares of the tolerance: for chords, for vertices that are moved onto a plane, and for edges that
are drawn together to a point."""

LEAST_TOLERANCE_MM = 1e-6
"""A finer mesh is refused: neither files nor other programs can tell its corners apart."""

_CORNERS = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)
_FACES = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)


@dataclass(frozen=True, eq=False)
class Drawn:
    """What a leaf's surface is made of, in coordinates of its own.

    Attributes
    ----------
    nets
        Each bounds a body.
    planes
        What is cut away from them.
    block
        ``(2, 3)`` mm: where it is given, the solid is this box less the bodies.
    """

    nets: tuple[Net, ...]
    planes: Halfspaces
    block: Floats | None = None


def drawn(leaf: doc.Leaf) -> Drawn:
    """Return the nets of a valid leaf and the planes that cut them, before it is placed."""
    if isinstance(leaf, doc.GeneralizedCylinder):
        return Drawn(tuple(swept_nets(leaf)), Halfspaces.cuts(leaf.cuts))
    shape = quadric(leaf)
    if shape.form is None:
        return Drawn((), Halfspaces.cuts(leaf.cuts), bounds(quadric(_uncut(leaf))))
    box = bounds(shape)
    middle, reach = 0.5 * (box[0] + box[1]), 0.55 * float(np.linalg.norm(box[1] - box[0]))
    nets, outside = quadric_nets(_about(shape, middle), middle, reach)
    block = np.stack([middle - reach, middle + reach]) if outside else None
    return Drawn(tuple(nets), shape.planes, block)


def leaf_mesh(leaf: doc.Leaf, tolerance_mm: float) -> Mesh:
    """Tessellate a valid leaf where it was written: closed, outward, within the tolerance."""
    found = drawn(leaf)
    mesh = joined([surface(net, _SURFACE * tolerance_mm) for net in found.nets])
    if found.block is not None and found.nets:
        # Around everything that is taken away from it.
        low = np.minimum(found.block[0], mesh.vertices.min(axis=0))
        high = np.maximum(found.block[1], mesh.vertices.max(axis=0))
        room = 0.1 * (high - low).max()
        mesh = joined([_block(low - room, high + room), mesh.reversed()])
    elif found.block is not None:
        mesh = _block(*found.block)
    mesh = cut(mesh, found.planes, _SNAP * tolerance_mm)
    return collapsed(mesh, _SHORT * tolerance_mm)


def tessellate(
    phantom: Phantom,
    tolerance_mm: float,
    *,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Mesh, ...]:
    """Tessellate every leaf of a phantom, each by itself and where it stands.

    Parameters
    ----------
    phantom
        Whose leaves; the operators between them play no part.
    tolerance_mm
        How far, in mm, a triangle may lie from the surface.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts leaves.

    Returns
    -------
    A closed mesh for each of ``phantom.leaf_names``.

    Raises
    ------
    InvalidInputError
        At ``/tolerance_mm``: not above 0, or so fine that a mesh would be too large.
    CancelledError
        Where ``cancelled`` said yes.
    """
    check_tolerance(tolerance_mm)
    placed = list(placed_leaves(phantom.document))
    known: dict[tuple[int, float], Mesh] = {}
    found = []
    for done, (leaf, to) in enumerate(placed):
        if cancelled is not None and cancelled():
            raise CancelledError("the tessellation was cancelled")
        key = (id(leaf), to.scale)
        if key not in known:
            known[key] = leaf_mesh(leaf, tolerance_mm / to.scale)
        found.append(known[key].moved(to))
        if progress is not None:
            progress(done + 1, len(placed))
    return tuple(found)


def check_tolerance(tolerance_mm: float) -> None:
    """Refuse a tolerance that is no length, or too small to tell.

    Raises
    ------
    InvalidInputError
        At ``/tolerance_mm``.
    """
    if not LEAST_TOLERANCE_MM <= tolerance_mm < np.inf:
        message = f"found {tolerance_mm:g}; expected at least {LEAST_TOLERANCE_MM:g} mm"
        raise InvalidInputError([Problem("/tolerance_mm", "out_of_range", message)])


def placed_nets(phantom: Phantom) -> list[tuple[Drawn, Similarity]]:
    """Return what every leaf is drawn by, and the similarity that puts it where it stands."""
    return [(drawn(leaf), to) for leaf, to in placed_leaves(phantom.document)]


def _uncut(leaf: doc.Leaf) -> doc.Box:
    assert isinstance(leaf, doc.Box)
    return leaf.model_copy(update={"cuts": ()})


def _about(shape: QuadricShape, center: Floats) -> tuple[Floats, Floats, float]:
    """Return a form about another centre."""
    assert shape.form is not None
    a, b, c = shape.form
    s = center - shape.center
    return a, a @ s + b, float(c + s @ a @ s + 2 * b @ s)


def _block(low: Floats, high: Floats) -> Mesh:
    """Return a box, each of its sides a sheet."""
    vertices = 0.5 * (low + high) + 0.5 * _CORNERS * (high - low)
    triangles = np.concatenate([_FACES[:, [0, 1, 2]], _FACES[:, [0, 2, 3]]])
    return Mesh(vertices, triangles, np.tile(np.arange(1, 7), 2))
