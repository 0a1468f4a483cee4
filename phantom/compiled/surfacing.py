"""Which leaves can be part of the final solid."""

from __future__ import annotations

from phantom.compiled.layout import DIFFERENCE, INTERSECTION, Scene


def surfacing(scene: Scene) -> tuple[int, ...]:
    """Return the numbers of the leaves that can surface, left to right.

    What an operator only takes away, or asks for as a limit, cannot.
    """
    return tuple(
        leaf
        for leaf in range(len(scene.leaf_material))
        if scene.leaf_material[leaf] >= 0 and _surfaces(scene, leaf)
    )


def _surfaces(scene: Scene, leaf: int) -> bool:
    node = leaf
    while scene.parent[node] >= 0:
        above = int(scene.parent[node])
        if scene.operator[above] in (DIFFERENCE, INTERSECTION) and scene.left[above] != node:
            return False
        node = above
    return True
