"""Where image i stands: whose it is, which case, which view, and in which split.

Images count view by view, then case by case, then person by person; people of a split follow one
another. People are drawn independently, so no shuffling is needed.
"""

from __future__ import annotations

import hashlib
from typing import Final, NamedTuple

from phantom.datasets.design import SAMPLES_A_SHARD, Design

ROUNDING: Final = 1e-6
"""Shares of splits add up to 1 within this."""


class Place(NamedTuple):
    """Where an image stands in its set; every number counts from 0.

    Attributes
    ----------
    number
        Of the image in the set.
    person, case, view
        Of the person in the set, the case of this person, the view of this case.
    split
        The person's.
    key
        What the image's files are called: the index with eight digits, or sixteen hexadecimal
        digits that tell nothing where the set is blind.
    """

    number: int
    person: int
    case: int
    view: int
    split: str
    key: str

    def case_number(self, design: Design) -> int:
        """Return the number of the case in the whole set."""
        return self.person * design.cases_per_person + self.case


def people_of_splits(design: Design) -> dict[str, int]:
    """Return how many people each split has; shares are rounded by their largest remainders."""
    asked = design.splits
    total = sum(asked.values())
    if abs(total - 1.0) > ROUNDING:
        return {name: int(count) for name, count in asked.items()}
    exact = {name: share * design.people for name, share in asked.items()}
    found = {name: int(number + ROUNDING) for name, number in exact.items()}
    by_remainder = sorted(exact, key=lambda name: found[name] - exact[name])
    for name in by_remainder[: design.people - sum(found.values())]:
        found[name] += 1
    return found


def images_of_splits(design: Design) -> dict[str, range]:
    """Return the indices of each split's images."""
    each = design.cases_per_person * len(design.views)
    found, first = {}, 0
    for name, people in people_of_splits(design).items():
        found[name] = range(first, first + people * each)
        first += people * each
    return found


def place(design: Design, index: int) -> Place:
    """Return where image ``index`` stands; IndexError where there is none."""
    if not 0 <= index < design.images:
        raise IndexError(f"found image {index}; expected one of {design.images}")
    case, view = divmod(index, len(design.views))
    person, case = divmod(case, design.cases_per_person)
    split = next(name for name, found in images_of_splits(design).items() if index in found)
    return Place(index, person, case, view, split, key(design, index))


def key(design: Design, index: int) -> str:
    """Return what the files of an image are called."""
    if not design.blind:
        return f"{index:08d}"
    return hashlib.sha256(f"{design.digest()} {index}".encode()).hexdigest()[:16]


class Unit(NamedTuple):
    """What is made, and made again, as a whole: the views of a case, or a shard of samples."""

    number: int
    split: str
    images: range


def units(design: Design) -> list[Unit]:
    """Return the units of a set, in the order of their images."""
    size = SAMPLES_A_SHARD if design.sharded else len(design.views)
    found: list[Unit] = []
    for split, images in images_of_splits(design).items():
        for start in range(images.start, images.stop, size):
            stop = min(start + size, images.stop)
            found.append(Unit(len(found), split, range(start, stop)))
    return found
