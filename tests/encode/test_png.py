"""PNG read back by an independent reader: every grey level, the metadata, and the same bytes."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phantom.encode import METADATA_KEY, png
from phantom.encode.openimageio import write

METADATA: dict[str, Any] = {
    "software": {"name": "phantom-xray", "version": "1.2.3"},
    "phantom": {"name": "Knie-α", "title": "genou à 60 keV"},
    "projection_matrix": [[1.0, 0.1, 1e-17], [1 / 3, -2.0, 0.0]],
}


def grey(dtype: type[np.unsignedinteger[Any]], rows: int, columns: int) -> np.ndarray[Any, Any]:
    levels = np.random.default_rng(7).integers(0, np.iinfo(dtype).max + 1, rows * columns)
    levels[:2] = 0, np.iinfo(dtype).max
    return levels.astype(dtype).reshape(rows, columns)


@pytest.mark.parametrize("shape", [(1, 2), (5, 7), (64, 3), (3, 64), (33, 32)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_every_grey_level_comes_back(read_png: Callable[..., Any], dtype: Any, shape: Any) -> None:
    image = grey(dtype, *shape)
    found = read_png(png(image, METADATA))
    assert found.pixels.shape == shape
    assert found.pixels.dtype.itemsize == image.dtype.itemsize
    np.testing.assert_array_equal(found.pixels, image)


def test_a_view_into_a_larger_array_is_written_as_it_is_seen(
    read_png: Callable[..., Any],
) -> None:
    image = grey(np.uint16, 20, 30)
    for seen in (image[::2, 5:25:3], image.T, image[::-1, ::-1]):
        np.testing.assert_array_equal(read_png(png(seen, {})).pixels, seen)


def test_metadata_comes_back_whole(read_png: Callable[..., Any]) -> None:
    text = read_png(png(grey(np.uint8, 4, 4), METADATA)).text
    assert json.loads(text[METADATA_KEY]) == METADATA
    assert text["Software"] == "phantom-xray 1.2.3"
    assert text["Title"] == "Knie-?"


def test_equal_images_have_equal_bytes_and_no_time(read_png: Callable[..., Any]) -> None:
    image = grey(np.uint16, 40, 30)
    once = png(image, METADATA)
    assert png(image.copy(), json.loads(json.dumps(METADATA))) == once
    assert b"tIME" not in read_png(once).chunks


def test_without_files_in_memory_the_bytes_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    image = grey(np.uint8, 9, 11)
    once = png(image, METADATA)
    monkeypatch.delattr(os, "memfd_create", raising=False)
    assert png(image, METADATA) == once


def test_a_flat_array_never_reaches_the_library() -> None:
    with pytest.raises(ValueError, match="channels"):
        write(grey(np.uint8, 4, 4), "png", {})  # type: ignore[arg-type]


def test_floats_never_reach_the_library() -> None:
    with pytest.raises(ValueError, match="float64"):
        write(np.zeros((4, 4, 1)), "png", {})


def test_an_unknown_format_is_an_error_of_the_library() -> None:
    with pytest.raises(OSError, match="cannot write"):
        write(np.zeros((4, 4, 1), np.uint8), "nosuchformat", {})
