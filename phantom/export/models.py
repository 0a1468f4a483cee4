"""A phantom as named parts, each a closed mesh of one material."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Literal, get_args

from phantom.errors import InvalidInputError, Problem
from phantom.scene import Phantom
from phantom.tessellation import Mesh, tessellate
from phantom.tessellation.regions import check_extra, leaf_regions, merged
from phantom.visible.looks import looks

What = Literal["leaves", "parts", "result"]
WHAT: Final[tuple[str, ...]] = get_args(What)
"""``leaves``: every leaf by itself, before any operator. ``parts``: what the operators leave of
every leaf. ``result``: where every material is present in the final solid."""

Color = tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Part:
    """A closed mesh with what it is.

    Attributes
    ----------
    name
        The leaf's label, or the material's name.
    material
        Name in the document's materials; None for a leaf that never surfaces.
    color
        Linear red, green and blue from 0 to 1: of the leaf (:mod:`phantom.visible.looks`), or of
        the first leaf of the material.
    mesh
        In mm, in the document's axes.
    """

    name: str
    material: str | None
    color: Color
    mesh: Mesh


def check_what(what: str) -> None:
    """Refuse a word that no model has, and what needs a package that is not there.

    Raises
    ------
    InvalidInputError
        At ``/what``.
    """
    if what not in WHAT:
        message = f"found {str(what)[:60]!r}; expected one of {', '.join(WHAT)}"
        raise InvalidInputError([Problem("/what", "unknown_choice", message)])
    if what != "leaves":
        check_extra("/what", "manifold3d")


def model(
    phantom: Phantom,
    tolerance_mm: float,
    what: What = "leaves",
    *,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Part, ...]:
    """Return a phantom as closed meshes.

    Parameters
    ----------
    phantom
        Of what.
    tolerance_mm
        How far a triangle may lie from the surface.
    what
        ``leaves``, ``parts`` or ``result``, see :data:`WHAT`. Where ``overlap`` leaves several
        materials in one place, the parts of all of them cover it.
    cancelled, progress
        As in :func:`phantom.tracing.pool.run_bands`; progress counts leaves, cut and joined.

    Returns
    -------
    Parts that have something left, in the order of the leaves or of the materials.

    Raises
    ------
    InvalidInputError
        At ``/tolerance_mm`` or ``/what``.
    CancelledError
        Where ``cancelled`` said yes.
    """
    check_what(what)
    count = len(phantom.leaf_names)
    total = count if what == "leaves" else 2 * count

    def told(first: int) -> Callable[[int, int], None]:
        return lambda done, _: None if progress is None else progress(first + done, total)

    meshes = tessellate(phantom, tolerance_mm, cancelled=cancelled, progress=told(0))
    if what != "leaves":
        document = phantom.document
        meshes = leaf_regions(
            document.solid,
            document.definitions,
            meshes,
            cancelled=cancelled,
            progress=told(count),
        )
    parts = _of_leaves(phantom, meshes)
    found = _of_materials(phantom, parts) if what == "result" else parts
    return tuple(part for part in found if len(part.mesh.triangles))


def _of_leaves(phantom: Phantom, meshes: Sequence[Mesh]) -> list[Part]:
    colors = looks(phantom)[:, :3].tolist()
    names = phantom.material_names
    return [
        Part(label, names[material] if material >= 0 else None, tuple(color), mesh)
        for label, material, color, mesh in zip(
            phantom.leaf_names, phantom.leaf_materials.tolist(), colors, meshes, strict=True
        )
    ]


def _of_materials(phantom: Phantom, parts: Sequence[Part]) -> list[Part]:
    found = []
    for name in phantom.material_names:
        own = [part for part in parts if part.material == name and len(part.mesh.triangles)]
        if own:
            mesh = own[0].mesh if len(own) == 1 else merged([part.mesh for part in own])
            found.append(Part(name, name, own[0].color, mesh))
    return found
