"""A dry run: what a design would give, how large, and how long it would take."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from phantom.datasets.checks import check, check_room, warnings
from phantom.datasets.design import Design
from phantom.datasets.making import Maker
from phantom.datasets.places import images_of_splits, people_of_splits, units
from phantom.datasets.presence import cases_with
from phantom.datasets.storage import Storage
from phantom.requests.limits import Limits
from phantom.tracing import default_workers

TRIED: int = 3
"""Images that are made to see how long one takes, spread over the set."""


@dataclass(frozen=True, slots=True)
class Forecast:
    """What a design would give.

    Attributes
    ----------
    images, people, abnormal
        How many; the last as drawn, of each abnormality.
    splits
        Split to its people and its images.
    columns, rows
        Pixels.
    bytes
        Of the whole set, from images that were made.
    seconds
        With so many workers, from the same.
    workers
        How many.
    shards
        WebDataset shards; 0 where the set comes as files.
    image_seconds, image_bytes
        Of one image, on one thread.
    warnings
        What to know before it is made.
    """

    images: int
    people: int
    abnormal: dict[str, int]
    splits: dict[str, tuple[int, int]]
    columns: int
    rows: int
    bytes: int
    seconds: float
    workers: int
    shards: int
    image_seconds: float
    image_bytes: int
    warnings: tuple[str, ...]

    def told(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        splits = {n: {"people": p, "images": i} for n, (p, i) in self.splits.items()}
        own = {name: getattr(self, name) for name in self.__slots__}
        return {**own, "splits": splits, "warnings": list(self.warnings)}


def forecast(
    design: Design,
    where: Storage | None = None,
    workers: int | None = None,
    *,
    limits: Limits | None = None,
    clock: Callable[[], float] = time.perf_counter,
) -> Forecast:
    """Return what a design would give; some of its images are made, and none is kept.

    Raises
    ------
    InvalidInputError
        The design cannot be made, or there is no room for it.
    """
    planned = check(design, limits)
    if where is not None:
        check_room(design, planned, where)
    maker = Maker(design, threads=1)
    maker.make(0)  # loads what the first image alone would be charged for
    numbers = {k * (design.images - 1) // max(TRIED - 1, 1) for k in range(TRIED)}
    sizes, times = [], []
    for number in sorted(numbers):
        begun = clock()
        made = Maker(design, threads=1).make(number)
        times.append(clock() - begun)
        sizes.append(sum(map(len, made.files.values())))
    people, count = people_of_splits(design), workers or default_workers()
    detector = planned.view.detector
    return Forecast(
        images=design.images,
        people=design.people,
        abnormal=cases_with(design),
        splits={n: (people[n], len(found)) for n, found in images_of_splits(design).items()},
        columns=detector.columns,
        rows=detector.rows,
        bytes=int(sum(sizes) / len(sizes) * design.images),
        seconds=sum(times) / len(times) * design.images / count,
        workers=count,
        shards=len(units(design)) if design.sharded else 0,
        image_seconds=sum(times) / len(times),
        image_bytes=int(sum(sizes) / len(sizes)),
        warnings=tuple(warnings(design, planned)),
    )
