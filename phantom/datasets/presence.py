"""Which abnormalities a case has: each by chance, or so many cases of a split to the case."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from phantom.datasets.design import Design
from phantom.datasets.draws import chance, stream, word
from phantom.datasets.places import ROUNDING, Place, images_of_splits, people_of_splits, place

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

PRESENCE: Final = 2
"""Whether a case has an abnormality: the second number of the keys."""

ORDER: Final = 5
"""The order in which the cases of a split have one, where prevalence is exact."""


def present(design: Design, at: Place) -> tuple[int, ...]:
    """Return which of the design's abnormalities a case has, by their numbers."""
    if design.exact_prevalence:
        return _by_order(design, at)
    shares = [asked.prevalence for asked in design.abnormalities]
    key = (design.seed, at.person, PRESENCE, at.case)
    if not design.exclusive:
        return tuple(k for k, share in enumerate(shares) if chance(*key, k) < share)
    left = chance(*key) if shares else 1.0
    for k, share in enumerate(shares):
        left -= share
        if left < 0.0:
            return (k,)
    return ()


def counts(design: Design) -> dict[str, tuple[int, ...]]:
    """Return how many cases of each split have each abnormality, where prevalence is exact.

    All splits together have the share of all cases, rounded; each split has its own share rounded
    down or up. Where abnormalities are exclusive that holds for the healthy cases too.
    """
    people = people_of_splits(design)
    sizes = [count * design.cases_per_person for count in people.values()]
    shares = [asked.prevalence for asked in design.abnormalities]
    if design.exclusive:
        rows = allotted(shares, sizes)
    else:
        rows = [allotted([share], sizes)[0] for share in shares]
    return {split: tuple(row[k] for row in rows) for k, split in enumerate(people)}


def cases_with(design: Design) -> dict[str, int]:
    """Return how many cases have an abnormality of each type, one or more."""
    types = [asked.type for asked in design.abnormalities]
    found = dict.fromkeys(types, 0)
    if design.exact_prevalence and (design.exclusive or len(found) == len(types)):
        for own in counts(design).values():
            for asked, count in zip(design.abnormalities, own, strict=True):
                found[asked.type] += count
    elif found:
        for case in range(design.people * design.cases_per_person):
            for kind in {
                types[k] for k in present(design, place(design, case * len(design.views)))
            }:
                found[kind] += 1
    return found


def allotted(shares: Sequence[float], sizes: Sequence[int]) -> list[list[int]]:
    """Return whole numbers near ``share * size`` whose sums are right both ways.

    Each is its product rounded down or up; those of a share add up to its part of all, rounded;
    those of a size, with what no share asks for, add up to it. Such numbers always exist: first all
    are rounded down, then what is missing is given one by one, where need be on a path that takes
    some back (a flow in a network, whose limits are whole).
    """
    total = sum(sizes)
    wholes = [round(share * total) for share in shares]
    rows = [*shares, 1.0 - math.fsum(shares)]
    exact = [[share * size for size in sizes] for share in rows]
    found = [[math.floor(number + ROUNDING) for number in row] for row in exact]
    left = [size - sum(row[s] for row in found) for s, size in enumerate(sizes)]
    given: set[tuple[int, int]] = set()

    def give(k: int, seen: set[int]) -> bool:
        nearest = sorted(range(len(sizes)), key=lambda s: found[k][s] - exact[k][s])
        for s in nearest:
            if (k, s) in given or s in seen or exact[k][s] - found[k][s] <= ROUNDING:
                continue
            seen.add(s)
            other = None
            if not left[s]:
                takers = (o for o in range(len(rows)) if (o, s) in given and give(o, seen))
                other = next(takers, None)
                if other is None:
                    continue
                given.remove((other, s))
            else:
                left[s] -= 1
            given.add((k, s))
            return True
        return False

    for k, whole in enumerate([*wholes, total - sum(wholes)]):
        for _ in range(whole - sum(found[k])):
            give(k, set())
    return [[n + ((k, s) in given) for s, n in enumerate(found[k])] for k in range(len(shares))]


def _by_order(design: Design, at: Place) -> tuple[int, ...]:
    """Return what a case has where prevalence is exact: the first of a split's order have it."""
    images = images_of_splits(design)[at.split]
    views = len(design.views)
    case, cases = at.case_number(design) - images.start // views, len(images) // views
    key = (design.seed, cases, word(at.split), ORDER)
    own = counts(design)[at.split]
    if not design.exclusive:
        return tuple(k for k, count in enumerate(own) if _order(*key, k)[case] < count)
    left = int(_order(*key)[case])
    for k, count in enumerate(own):
        left -= count
        if left < 0:
            return (k,)
    return ()


@lru_cache(maxsize=64)
def _order(seed: int, cases: int, *key: int) -> NDArray[np.uint32]:
    """Return which place each case of a split has in the order of this key."""
    import numpy as np

    order = np.arange(cases, dtype=np.uint32)
    stream(seed, *key).shuffle(order)
    order.setflags(write=False)
    return order
