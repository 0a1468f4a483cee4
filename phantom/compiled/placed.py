"""The leaves of a document where they stand, in the order in which they are compiled."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from phantom import document as doc
from phantom.geometry.transforms import Similarity, similarity


class Placed(NamedTuple):
    """A leaf as it was written, and the similarity that puts it where it stands."""

    leaf: doc.Leaf
    to: Similarity


def placed_leaves(document: doc.Document) -> Iterator[Placed]:
    """Yield the leaves from left to right, instances expanded: one a row of ``leaf_names``."""
    stack: list[tuple[doc.Solid, Similarity]] = [(document.solid, Similarity.identity())]
    while stack:
        solid, to = stack.pop()
        if doc.is_leaf(solid):
            yield Placed(solid, to)
        elif isinstance(solid, doc.Transformed):
            stack.append((solid.solid, to.after(similarity(solid))))
        elif isinstance(solid, doc.Instance):
            stack.append((document.definitions[solid.of], to))
        elif isinstance(solid, doc.Operator):
            stack.extend((child, to) for child in reversed(solid.solids))
