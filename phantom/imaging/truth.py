"""What a picture shows, leaf by leaf: masks, thickness, boxes, depths, centroids, landmarks.

Everything is of what the final solid keeps of a leaf: what an operator took away, or another leaf
replaced, is not there. Masks of several leaves overlap, for a pixel's ray crosses many.

Columns and rows are those of the projection: pixel centres at whole numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

Kind = Literal["masks", "thickness", "boxes", "entry_depth", "centroids", "landmarks"]

KINDS: Final[tuple[Kind, ...]] = get_args(Kind)
"""Every kind of ground truth."""


class Box(NamedTuple):
    """The pixels of a mask lie in these columns and rows, the last ones included."""

    first_column: int
    first_row: int
    last_column: int
    last_row: int


@dataclass(frozen=True, eq=False)
class LeafTruth:
    """One leaf in one picture. Arrays cannot be written to.

    Attributes
    ----------
    name, material
        Its label, and its material's name.
    size
        Columns and rows of the picture.
    box
        Around its mask; None where no ray to a pixel's centre meets it.
    thickness_in_box_mm
        (rows, columns) of the box: mm of it between source and pixel; no rows without a box.
    entry_in_box_mm
        (rows, columns) of the box: depth at which a ray first enters it, along the camera's axis as
        in :meth:`phantom.imaging.Projection.depth_mm`; nan where it is missed. None if not asked
        for.
    centroid_mm
        World coordinates of the middle of its volume, as far as the field shows it; None if not
        asked for, or without a box.
    volume_mm3
        That volume, summed over the pixels.
    """

    name: str
    material: str
    size: tuple[int, int]
    box: Box | None
    thickness_in_box_mm: FloatArray
    entry_in_box_mm: FloatArray | None = None
    centroid_mm: tuple[float, float, float] | None = None
    volume_mm3: float | None = None

    @property
    def thickness_mm(self) -> FloatArray:
        """(rows, columns) of the picture: mm of the leaf between source and pixel."""
        return self._framed(self.thickness_in_box_mm, 0.0)

    @property
    def entry_depth_mm(self) -> FloatArray | None:
        """(rows, columns) of the picture: depth of the first entry, nan where it is missed."""
        if self.entry_in_box_mm is None:
            return None
        return self._framed(self.entry_in_box_mm, np.nan)

    @property
    def mask(self) -> BoolArray:
        """(rows, columns) of the picture: where the leaf's thickness is above 0."""
        return self.thickness_mm > 0.0

    @property
    def area_px(self) -> int:
        """How many pixels the mask has."""
        return int(np.count_nonzero(self.thickness_in_box_mm))

    def _framed(self, part: FloatArray, ground: float) -> FloatArray:
        """Return the part of an array that lies in the box as one of the whole picture."""
        columns, rows = self.size
        whole = np.full((rows, columns), ground)
        if self.box is not None:
            b = self.box
            whole[b.first_row : b.last_row + 1, b.first_column : b.last_column + 1] = part
        whole.setflags(write=False)
        return whole


class Landmark(NamedTuple):
    """A named point of the document.

    Attributes
    ----------
    world_mm
        Where it is.
    pixel
        Its column and row; None at or behind the source.
    in_field
        Whether that is on the detector, to the edges of the outermost pixels.
    """

    world_mm: tuple[float, float, float]
    pixel: tuple[float, float] | None
    in_field: bool


@dataclass(frozen=True, eq=False)
class Truth:
    """The ground truth of a picture.

    Attributes
    ----------
    kinds
        What was asked for.
    size
        Columns and rows of the picture.
    leaves
        Every named leaf that can surface, in the document's order, seen or not.
    centroids_px
        Column and row of each leaf's centroid; None where it has none.
    landmarks
        Those of the document, by name.
    findings
        Those of the document, name to the names of its leaves.
    """

    kinds: tuple[Kind, ...]
    size: tuple[int, int]
    leaves: tuple[LeafTruth, ...]
    centroids_px: tuple[tuple[float, float] | None, ...]
    landmarks: Mapping[str, Landmark]
    findings: tuple[tuple[str, tuple[str, ...]], ...]

    def __getitem__(self, name: str) -> LeafTruth:
        """Return the leaf of that name; KeyError where there is none."""
        for leaf in self.leaves:
            if leaf.name == name:
                return leaf
        raise KeyError(name)

    def told(self) -> dict[str, Any]:
        """Return what was asked for and is no image, as plain JSON values."""
        told: dict[str, Any] = {
            "axes": "columns and rows, pixel centres at whole numbers, from the upper left",
            "columns": self.size[0],
            "rows": self.size[1],
            "kinds": list(self.kinds),
            "leaves": [self._leaf(i) for i in range(len(self.leaves))],
            "findings": [{"name": name, "leaves": list(of)} for name, of in self.findings],
        }
        if "landmarks" in self.kinds:
            told["landmarks"] = {name: mark._asdict() for name, mark in self.landmarks.items()}
        return told

    def _leaf(self, index: int) -> dict[str, Any]:
        leaf = self.leaves[index]
        said: dict[str, Any] = {"name": leaf.name, "material": leaf.material}
        said["area_px"] = leaf.area_px
        if "boxes" in self.kinds:
            said["box"] = None if leaf.box is None else leaf.box._asdict()
        if "centroids" in self.kinds:
            said["centroid_mm"] = leaf.centroid_mm
            said["centroid_px"] = self.centroids_px[index]
            said["volume_mm3"] = leaf.volume_mm3
        return said
