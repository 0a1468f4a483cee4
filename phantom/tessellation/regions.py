"""The final solid as meshes: what the five operators leave of every leaf, or of every material.

The operators of Table 1 say of each point which leaves are left there; so they say of each leaf a
region. Going up the tree, ``union`` takes the left's presence from the regions of the right,
``replace`` the right's from those of the left, ``difference`` and ``intersection`` keep the left's
outside and inside the right's presence, and ``overlap`` keeps all: its regions run into one
another, as its densities add. The sets of points themselves are joined and cut by manifold3d (E.
Lalish, https://github.com/elalish/manifold), whose results are closed again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from phantom import document as doc
from phantom.errors import CancelledError, InvalidInputError, Problem
from phantom.tessellation.mesh import Mesh

if TYPE_CHECKING:
    from manifold3d import Manifold

INSTALL = 'pip install "phantom-xray[export]"'


def check_extra(path: str, *packages: str) -> None:
    """Refuse what needs packages that are not installed, and say how to get them.

    Raises
    ------
    InvalidInputError
        At ``path``.
    """
    from importlib.util import find_spec

    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        message = f"needs {' and '.join(missing)}; expected the extra export: {INSTALL}"
        raise InvalidInputError([Problem(path, "missing_extra", message)])


@dataclass(frozen=True)
class _Node:
    """Where a solid is present, and where each of its leaves is left."""

    present: Manifold
    regions: dict[int, Manifold]


def leaf_regions(
    solid: doc.Solid,
    definitions: dict[str, Any],
    meshes: Sequence[Mesh],
    *,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Mesh, ...]:
    """Return what the operators leave of every leaf.

    Parameters
    ----------
    solid, definitions
        Of a document.
    meshes
        Of its leaves, closed, in their order.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts leaves.

    Returns
    -------
    A closed mesh for each leaf, without triangles where nothing is left of it.

    Raises
    ------
    InvalidInputError
        At ``/what``, where manifold3d is not installed.
    CancelledError
        Where ``cancelled`` said yes.
    """
    check_extra("/what", "manifold3d")
    walker = _Walker(definitions, meshes, cancelled, progress)
    top = walker.node(solid)
    return tuple(_mesh(top.regions[k]) for k in range(len(meshes)))


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """Return the union of closed meshes: where several are, it counts once.

    Raises
    ------
    InvalidInputError
        At ``/what``, where manifold3d is not installed.
    """
    check_extra("/what", "manifold3d")
    from manifold3d import Manifold, OpType

    solids = [_manifold(mesh) for mesh in meshes if len(mesh.triangles)]
    return _mesh(Manifold.batch_boolean(solids, OpType.Add))


class _Walker:
    """Goes through the tree in the order of the leaves."""

    def __init__(
        self,
        definitions: dict[str, Any],
        meshes: Sequence[Mesh],
        cancelled: Callable[[], bool] | None,
        progress: Callable[[int, int], None] | None,
    ) -> None:
        self._definitions = definitions
        self._meshes = meshes
        self._cancelled = cancelled
        self._progress = progress
        self._next = 0

    def node(self, solid: doc.Solid) -> _Node:
        if doc.is_leaf(solid):
            return self._leaf()
        if isinstance(solid, doc.Transformed):
            return self.node(solid.solid)
        if isinstance(solid, doc.Instance):
            return self.node(self._definitions[solid.of])
        assert isinstance(solid, doc.Operator)
        found = self.node(solid.solids[0])
        for child in solid.solids[1:]:
            if self._cancelled is not None and self._cancelled():
                raise CancelledError("the boolean operations were cancelled")
            found = _COMBINED[type(solid)](found, self.node(child))
        return found

    def _leaf(self) -> _Node:
        index = self._next
        self._next += 1
        solid = _manifold(self._meshes[index])
        if self._progress is not None:
            self._progress(self._next, len(self._meshes))
        return _Node(solid, {index: solid})


def _less(node: _Node, what: Manifold) -> dict[int, Manifold]:
    return {index: region - what for index, region in node.regions.items()}


def _nothing(node: _Node) -> dict[int, Manifold]:
    from manifold3d import Manifold

    return dict.fromkeys(node.regions, Manifold())


def _union(left: _Node, right: _Node) -> _Node:
    regions = left.regions | _less(right, left.present)
    return _Node(left.present + right.present, regions)


def _replace(left: _Node, right: _Node) -> _Node:
    regions = _less(left, right.present) | right.regions
    return _Node(left.present + right.present, regions)


def _overlap(left: _Node, right: _Node) -> _Node:
    return _Node(left.present + right.present, left.regions | right.regions)


def _difference(left: _Node, right: _Node) -> _Node:
    regions = _less(left, right.present) | _nothing(right)
    return _Node(left.present - right.present, regions)


def _intersection(left: _Node, right: _Node) -> _Node:
    regions = {k: region ^ right.present for k, region in left.regions.items()}
    return _Node(left.present ^ right.present, regions | _nothing(right))


_COMBINED: dict[type[doc.Operator], Callable[[_Node, _Node], _Node]] = {
    doc.Union: _union,
    doc.Replace: _replace,
    doc.Overlap: _overlap,
    doc.Difference: _difference,
    doc.Intersection: _intersection,
}


def _manifold(mesh: Mesh) -> Manifold:
    from manifold3d import Manifold, Mesh64

    if not len(mesh.triangles):
        return Manifold()
    solid = Manifold(
        Mesh64(
            vert_properties=np.ascontiguousarray(mesh.vertices),
            tri_verts=np.ascontiguousarray(mesh.triangles, dtype=np.uint64),
        )
    )
    if solid.num_tri() == 0:
        raise RuntimeError(f"manifold3d refused a closed mesh: {solid.status()}")
    return solid


def _mesh(solid: Manifold) -> Mesh:
    content = solid.to_mesh64()
    triangles = np.array(content.tri_verts, dtype=np.int64).reshape(-1, 3)
    vertices = np.array(content.vert_properties, dtype=np.float64)[:, :3].reshape(-1, 3)
    return Mesh(vertices, triangles, np.zeros(len(triangles), dtype=np.int64))
