"""Ground truth as files: JSON, COCO, a PNG for each mask, an NPY for each map."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from phantom.encode.coco import Annotated, coco
from phantom.encode.exr import exr, layer_names
from phantom.encode.files import ZIP_SUFFIX, write_atomically, write_files
from phantom.encode.npy import npy
from phantom.encode.png import png
from phantom.errors import InvalidInputError, Problem

EXR_SUFFIX: Final = ".exr"

MAPS: Final = {"masks": "mask", "thickness": "thickness", "entry_depth": "entry_depth"}
"""The kinds that are images of a leaf, and what their layers are called."""


class LeafMaps(Annotated, Protocol):
    """A leaf with its maps; ``phantom.imaging.LeafTruth`` is one."""

    @property
    def thickness_mm(self) -> NDArray[np.float64]:
        """(rows, columns)."""

    @property
    def entry_depth_mm(self) -> NDArray[np.float64] | None:
        """(rows, columns), nan where it is missed."""


class Told(Protocol):
    """A picture's ground truth; ``phantom.imaging.Truth`` is one."""

    @property
    def kinds(self) -> Sequence[str]:
        """What was asked for."""

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows."""

    @property
    def leaves(self) -> Sequence[LeafMaps]:
        """The named leaves."""

    @property
    def centroids_px(self) -> Sequence[tuple[float, float] | None]:
        """Column and row of each leaf's centroid."""

    def told(self) -> dict[str, Any]:
        """Return plain JSON values."""


def truth_files(truth: Told, image_name: str = "image.png") -> dict[str, bytes]:
    """Return the files of a ground truth, by name.

    ``truth.json`` has what is no image, and for every leaf that is seen the names of its files.
    ``masks`` gives ``masks/NNN.png`` (0 and 255) and ``coco.json``; ``thickness`` and
    ``entry_depth`` an NPY of float32 in mm each, ``thickness/NNN.npy``. NNN is the leaf's place
    among the leaves of ``truth.json``, from 000.

    Parameters
    ----------
    truth
        What is told.
    image_name
        The picture's file, named in ``coco.json``.
    """
    files: dict[str, bytes] = {}
    said = truth.told()
    for number, leaf in enumerate(truth.leaves):
        if leaf.box is None:
            continue
        own = {}
        if "masks" in truth.kinds:
            own[f"masks/{number:03d}.png"] = png(leaf.mask.astype(np.uint8) * np.uint8(255), {})
        if "thickness" in truth.kinds:
            own[f"thickness/{number:03d}.npy"] = npy(leaf.thickness_mm.astype(np.float32))
        depth = leaf.entry_depth_mm
        if depth is not None:
            own[f"entry_depth/{number:03d}.npy"] = npy(depth.astype(np.float32))
        said["leaves"][number]["files"] = list(own)
        files |= own
    first = {"truth.json": _json(said)}
    if "masks" in truth.kinds:
        first["coco.json"] = _json(coco(truth.leaves, truth.size, image_name, truth.centroids_px))
    return first | files


def truth_layers(truth: Told) -> bytes:
    """Return an OpenEXR of the maps, float32: ``mask.NAME``, ``thickness.NAME``, …, leaf by leaf.

    Masks are 0 and 1. The whole of ``truth.json`` is in ``phantom:metadata``. Leaves that are not
    seen have no layer.

    Raises
    ------
    InvalidInputError
        No leaf is seen, or no kind of map was asked for: the file would have no layer (``/truth``).
    """
    seen = [leaf for leaf in truth.leaves if leaf.box is not None]
    layers: dict[str, NDArray[Any]] = {}
    for kind, prefix in MAPS.items():
        if kind in truth.kinds:
            names = layer_names(prefix, [leaf.name for leaf in seen])
            layers |= {n: _map(leaf, kind) for n, leaf in zip(names, seen, strict=True)}
    if not layers:
        message = "found no map of any leaf in the picture; expected some, for a file has layers"
        raise InvalidInputError([Problem("/truth", "empty", message)])
    return exr(layers, truth.told())


def _map(leaf: LeafMaps, kind: str) -> NDArray[np.float32]:
    if kind == "masks":
        return leaf.mask.astype(np.float32)
    values = leaf.thickness_mm if kind == "thickness" else leaf.entry_depth_mm
    assert values is not None
    return values.astype(np.float32)


def save_truth(truth: Told, path: Path | str, image_name: str = "image.png") -> tuple[str, ...]:
    """Write a ground truth to a folder, to an archive (``.zip``) or as layers (``.exr``).

    Every file is whole or not there; a folder is made where there is none. Returns the names of the
    files in the folder or archive, as in :func:`truth_files`.

    Raises
    ------
    InvalidInputError
        The folder to write into is not there (``/truth``), see :func:`check_truth_path`.
    """
    path = Path(path)
    check_truth_path(path)
    if path.suffix.lower() == EXR_SUFFIX:
        write_atomically(path, truth_layers(truth))
        return (path.name,)
    files = truth_files(truth, image_name)
    write_files(files, path)
    return tuple(files)


def check_truth_path(path: Path | str) -> None:
    """Refuse a place that a ground truth cannot be written to, before it is made.

    Raises
    ------
    InvalidInputError
        Its folder is not there, it is a folder whose name is a file's, or the other way.
    """
    path = Path(path)
    if not path.parent.is_dir():
        message = f"found no folder {str(path.parent)!r} to write into"
        raise InvalidInputError([Problem("/truth", "missing_folder", message)])
    if path.suffix.lower() in (ZIP_SUFFIX, EXR_SUFFIX):
        if path.is_dir():
            message = f"found a folder at {str(path)!r}, expected a file's name"
            raise InvalidInputError([Problem("/truth", "is_a_folder", message)])
    elif path.exists() and not path.is_dir():
        message = f"found a file at {str(path)!r}, expected a folder, or a .zip or .exr"
        raise InvalidInputError([Problem("/truth", "is_a_file", message)])


def _json(tree: object) -> bytes:
    """Return JSON in UTF-8, without spaces: masks are long."""
    text = json.dumps(tree, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return f"{text}\n".encode()
