"""The images of a design without a file, for a training loop."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from phantom.datasets.checks import check
from phantom.datasets.design import Design
from phantom.datasets.knowledge import mask
from phantom.datasets.making import Maker
from phantom.datasets.opening import of_tree, read_design
from phantom.datasets.places import images_of_splits, place
from phantom.errors import InvalidInputError, Problem


class Stream:
    """The images of a design, or of one of its splits, made when they are asked for.

    A sequence: ``len(stream)``, ``stream[k]``, ``stream[a:b:c]``, which is a stream too, and ``for
    item in stream``; so a PyTorch ``DataLoader`` takes it for a map-style set, with any number of
    workers, and ``stream[worker::workers]`` is what one of several has to go through. It can be
    pickled.

    Each item is a dictionary of

    - ``image``: float32 (rows, columns), the quantity; a signal as a share of the open field
    - ``mask``: uint8 (rows, columns), 0 and 1, where the design keeps masks
    - ``twin``: float32, where it keeps twins; of a healthy case the image itself
    - ``right``, ``right_mask``, ``right_twin``: the right eye's, where it has two
    - ``label``: 1 with an abnormality, else 0
    - ``index``, ``person``, ``case``: numbers of the image, the person, the case

    Attributes
    ----------
    design
        Whose images.
    images
        Their numbers in the design.
    """

    def __init__(self, design: Design, images: range, threads: int | None = None) -> None:
        self.design, self.images = design, images
        self._threads = threads
        self._maker: Maker | None = None

    def __len__(self) -> int:
        """Return how many images there are."""
        return len(self.images)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yield every item."""
        for number in range(len(self)):
            yield self[number]

    @overload
    def __getitem__(self, number: int) -> dict[str, Any]: ...

    @overload
    def __getitem__(self, number: slice) -> Stream: ...

    def __getitem__(self, number: int | slice) -> dict[str, Any] | Stream:
        """Return item ``number``, or the stream of a slice of them.

        An item is a function of the design, its seed and the number of its image alone.

        Raises
        ------
        IndexError
            There is none.
        """
        if isinstance(number, slice):
            return Stream(self.design, self.images[number], self._threads)
        at = place(self.design, self.images[number])
        if self._maker is None:
            self._maker = Maker(self.design, self._threads)
        of = self._maker.case(at)
        planned = self._maker.plan(at, of)
        shot = self._maker.shoot(planned)
        quantity = self.design.quantity

        def values(radiograph: Any) -> NDArray[np.float32]:
            full = radiograph.open_field if quantity == "signal" else 1.0
            found: NDArray[np.float32] = (radiograph.quantity(quantity) / full).astype(np.float32)
            return found

        names = ("", "right_")[: len(shot.images)]
        item: dict[str, Any] = {}
        for name, image in zip(names, shot.images, strict=True):
            item[name.rstrip("_") or "image"] = values(image)
        if self.design.outputs.masks:
            for name, truth in zip(names, self._maker.tell(planned, shot), strict=True):
                white = mask(truth, of_findings=bool(self.design.abnormalities))
                item[f"{name}mask"] = (white > 0).astype(np.uint8)
        if self.design.twins:
            twin = self._maker.twin(of, shot) or shot
            for name, image in zip(names, twin.images, strict=True):
                item[f"{name}twin"] = values(image)
        item |= {"label": int(bool(of.subject.abnormalities)), "index": at.number}
        return {**item, "person": at.person, "case": at.case_number(self.design)}

    def __getstate__(self) -> dict[str, Any]:
        """Return what another process makes it from: no compiled phantom travels."""
        images = (self.images.start, self.images.stop, self.images.step)
        return {"design": self.design.tree(), "images": images, "threads": self._threads}

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        self.design, self.images = of_tree(state["design"]), range(*state["images"])
        self._threads, self._maker = state["threads"], None


def stream(
    design: Design | Mapping[str, Any] | Path | str,
    split: str | None = None,
    *,
    threads: int | None = None,
) -> Stream:
    """Return the images of a design, made when they are asked for.

    Parameters
    ----------
    design
        A design, its tree, or its file.
    split
        One of its splits; all of them by default.
    threads
        To trace each image with; one where a loader has a worker a processor.

    Raises
    ------
    InvalidInputError
        The design cannot be made, or has no such split.
    """
    wanted = read_design(design)
    check(wanted)
    if split is None:
        return Stream(wanted, range(wanted.images), threads)
    splits = images_of_splits(wanted)
    if split not in splits:
        message = f"found {split[:60]!r}; expected one of {', '.join(splits)}"
        raise InvalidInputError([Problem("/split", "unknown_value", message)])
    return Stream(wanted, splits[split], threads)
