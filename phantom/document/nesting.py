"""How deep and how many a document's solids are once its instances are expanded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from phantom.document.tree import every_solid, mapping, roots
from phantom.errors import Problem, pointer

DEEPEST_NESTING = 64
MOST_SOLIDS = 20_000
_UNCOUNTED = 10**9  # counts stop growing here; they can double with every definition


@dataclass(frozen=True)
class Extent:
    """Solids and levels of a solid; an instance counts as one around what it stands for."""

    solids: int
    levels: int


def extents(document: object, order: list[str]) -> dict[str, Extent]:
    """Return the extent of every definition and, under ``""``, of the phantom itself.

    Parameters
    ----------
    document
        The document's tree.
    order
        The names of the definitions, each after those it uses.
    """
    definitions = mapping(mapping(document).get("definitions"))
    known: dict[str, Extent] = {}
    for name in order:
        known[name] = _extent(definitions[name], known)
    known[""] = _extent(mapping(document).get("solid"), known)
    return known


def _extent(root: object, known: Mapping[str, Extent]) -> Extent:
    solids, levels = 0, 0
    for at, solid in every_solid(root):
        # Two parts of a place (`solids`, index) or one (`solid`) are one level each.
        depth = 1 + sum(part in ("solids", "solid") for part in at)
        used = solid.get("of") if solid.get("type") == "instance" else None
        inner = known.get(used, Extent(0, 0)) if isinstance(used, str) else Extent(0, 0)
        solids += 1 + inner.solids
        levels = max(levels, depth + inner.levels)
    return Extent(min(solids, _UNCOUNTED), levels)


def oversize(document: object, sizes: Mapping[str, Extent]) -> Iterator[Problem]:
    """Yield a problem for the phantom, or an unused definition, that is too deep or too many."""
    used = {
        solid.get("of")
        for place, root in roots(document)
        for _, solid in every_solid(root, place)
        if solid.get("type") == "instance" and isinstance(solid.get("of"), str)
    }
    for place, _ in roots(document):
        if place[-1] in used and place != ("solid",):
            continue
        extent = sizes["" if place == ("solid",) else str(place[1])]
        if extent.levels > DEEPEST_NESTING:
            message = f"found solids nested {extent.levels} deep with instances expanded; "
            message += f"expected at most {DEEPEST_NESTING}"
            yield Problem(pointer(place), "too_deep", message)
        if extent.solids > MOST_SOLIDS:
            count = f"{extent.solids}" if extent.solids < _UNCOUNTED else f"over {_UNCOUNTED}"
            message = (
                f"found {count} solids with instances expanded; expected at most {MOST_SOLIDS}"
            )
            yield Problem(pointer(place), "too_many_solids", message)
