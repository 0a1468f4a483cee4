"""How deep and how many a document's solids are once its instances are expanded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from phantom.document.tree import PHANTOM, Parts, Placed, used_by
from phantom.errors import Problem, pointer

DEEPEST_NESTING = 64
MOST_SOLIDS = 20_000
_UNCOUNTED = 10**9  # counts stop growing here; they can double with every definition


@dataclass(frozen=True)
class Extent:
    """Solids and levels of a solid; an instance counts as one around what it stands for."""

    solids: int
    levels: int


def extents(solids: Mapping[Parts, list[Placed]], order: list[str]) -> dict[Parts, Extent]:
    """Return the extent of every definition and of the phantom itself, without expanding any.

    Parameters
    ----------
    solids
        All solids of the document, by the place of their root.
    order
        The names of the definitions, each after those it uses.
    """
    known: dict[Parts, Extent] = {}
    for root in [*(("definitions", name) for name in order), PHANTOM]:
        count, levels = 0, 0
        for at, solid in solids[root]:
            # A step down is two parts of a place (`solids`, index) or one (`solid`).
            depth = 1 + sum(part in ("solids", "solid") for part in at[len(root) :])
            inner = known.get(("definitions", used_by(solid) or ""), Extent(0, 0))
            count += 1 + inner.solids
            levels = max(levels, depth + inner.levels)
        known[root] = Extent(min(count, _UNCOUNTED), levels)
    return known


def oversize(
    sizes: Mapping[Parts, Extent], solids: Mapping[Parts, list[Placed]]
) -> Iterator[Problem]:
    """Yield a problem for the phantom, or an unused definition, that is too deep or too many."""
    used = {used_by(solid) for placed in solids.values() for _, solid in placed}
    for place, extent in sizes.items():
        if place != PHANTOM and place[-1] in used:
            continue
        if extent.levels > DEEPEST_NESTING:
            message = f"found solids nested {extent.levels} deep with instances expanded; "
            message += f"expected at most {DEEPEST_NESTING}"
            yield Problem(pointer(place), "too_deep", message)
        if extent.solids > MOST_SOLIDS:
            count = f"{extent.solids}" if extent.solids < _UNCOUNTED else f"over {_UNCOUNTED}"
            message = f"found {count} solids with instances expanded; "
            message += f"expected at most {MOST_SOLIDS}"
            yield Problem(pointer(place), "too_many_solids", message)
