"""COCO: one annotation with a run-length mask for each leaf.

The data format of cocodataset.org: ``segmentation`` is ``{"size": [rows, columns], "counts": […]}``
with the lengths of runs of 0 and of 1 in turn, the first of 0, down the columns one after another.
Coordinates there have whole numbers at the pixels' edges, so that the middle of the first pixel is
at (0.5, 0.5): a box is ``[first column, first row, columns, rows]``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

PIXEL_CENTRE = 0.5
"""What COCO's coordinates are ahead of ours, whose pixel centres are at whole numbers."""


class Annotated(Protocol):
    """A leaf as an annotation sees it; ``phantom.imaging.LeafTruth`` is one."""

    @property
    def name(self) -> str:
        """Its label."""

    @property
    def material(self) -> str:
        """The name of its material."""

    @property
    def box(self) -> tuple[int, int, int, int] | None:
        """First column, first row, last column, last row."""

    @property
    def mask(self) -> NDArray[np.bool_]:
        """(rows, columns)."""


def run_lengths(mask: NDArray[np.bool_]) -> list[int]:
    """Return the lengths of runs of False and True in turn, down the columns, False first."""
    flat = np.asarray(mask, dtype=np.bool_).ravel(order="F")
    if not flat.size:
        return []
    starts = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    lengths = np.diff(np.concatenate([[0], starts, [flat.size]]))
    return [0, *lengths.tolist()] if flat[0] else [int(n) for n in lengths]


def coco(
    leaves: Iterable[Annotated],
    size: tuple[int, int],
    file_name: str,
    centroids_px: Iterable[tuple[float, float] | None] = (),
) -> dict[str, Any]:
    """Return the masks of a picture as a COCO tree.

    A category is a leaf's label, numbered from 1 in the document's order, whether or not the leaf
    is seen; a leaf that is not seen has no annotation.

    Parameters
    ----------
    leaves
        Of one picture.
    size
        Its columns and rows.
    file_name
        Of the picture.
    centroids_px
        Of the leaves, in our coordinates; where there is one, its annotation has ``centroid`` in
        COCO's.
    """
    columns, rows = size
    told = list(leaves)
    middles = list(centroids_px) or [None] * len(told)
    annotations = []
    for number, (leaf, middle) in enumerate(zip(told, middles, strict=True), start=1):
        if leaf.box is None:
            continue
        left, top, right, bottom = leaf.box
        mask = leaf.mask
        annotation: dict[str, Any] = {
            "id": number,
            "image_id": 1,
            "category_id": number,
            "segmentation": {"size": [rows, columns], "counts": run_lengths(mask)},
            "area": int(np.count_nonzero(mask)),
            "bbox": [left, top, right - left + 1, bottom - top + 1],
            "iscrowd": 0,
        }
        if middle is not None:
            annotation["centroid"] = [middle[0] + PIXEL_CENTRE, middle[1] + PIXEL_CENTRE]
        annotations.append(annotation)
    return {
        "images": [{"id": 1, "width": columns, "height": rows, "file_name": file_name}],
        "categories": [
            {"id": number, "name": leaf.name, "supercategory": leaf.material}
            for number, leaf in enumerate(told, start=1)
        ],
        "annotations": annotations,
    }
