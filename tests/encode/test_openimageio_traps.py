"""What OpenImageIO does without an error, and that none of it reaches a file."""

from __future__ import annotations

import io
import os
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
import tifffile

from phantom.encode import FORMATS, encode
from phantom.encode.openimageio import write

NAMES = tuple(known.name for known in FORMATS)


def test_a_flat_array_is_refused() -> None:
    """The library would take (rows, columns) for something else and write it."""
    with pytest.raises(ValueError, match="channels"):
        write(np.zeros((4, 6), np.uint8), "tif", {})


@pytest.mark.parametrize(
    ("extension", "dtype"),
    [("png", np.float32), ("jpg", np.float32), ("jpg", np.uint16), ("exr", np.uint16)],
)
def test_numbers_are_refused_where_the_library_would_convert_them(extension, dtype) -> None:
    with pytest.raises(ValueError, match="found"):
        write(np.ones((4, 6, 1), dtype), extension, {})


@pytest.mark.parametrize("extension", ["tif", "exr"])
def test_nan_and_infinity_stay_what_they_are(extension: str, tmp_path: Any) -> None:
    values = np.array([[np.nan, np.inf, -np.inf], [-0.0, 1e-45, 3.4e38]], np.float32)
    data = write(values[:, :, None], extension, {"compression": "zip", "tiff:predictor": 1}, ["Y"])
    path = tmp_path / f"x.{extension}"
    path.write_bytes(data)
    if extension == "tif":
        found = tifffile.imread(path)
    else:
        found = OpenEXR.File(str(path)).channels()["Y"].pixels
    np.testing.assert_array_equal(found.view(np.uint32), values.view(np.uint32))


def test_a_writer_that_leaves_nothing_is_an_error() -> None:
    with pytest.raises(OSError, match="empty"):
        write(np.ones((16, 16, 1), np.uint8), "jp2", {})


def test_no_file_says_when_it_was_made(shot, tmp_path: Any) -> None:
    (page,) = tifffile.TiffFile(io.BytesIO(encode(shot(), format="tiff").data)).pages
    assert page.tags["DateTime"].value.replace(" ", "") == "::::"
    assert (
        str(time.gmtime().tm_year).encode() not in page.tags["XMP"].value.split(b"Description")[1]
    )
    (tmp_path / "x.exr").write_bytes(encode(shot(), format="exr").data)
    assert OpenEXR.File(str(tmp_path / "x.exr")).header()["capDate"].replace(" ", "") == "::::"


def test_every_format_has_the_same_bytes_a_second_later_and_on_any_number_of_threads(shot) -> None:
    first = {name: encode(shot(), format=name).data for name in NAMES}
    time.sleep(1.1)  # the stamp counts seconds
    threads = OpenImageIO.get_int_attribute("threads")
    OpenImageIO.attribute("threads", 1)
    try:
        again = {name: encode(shot(), format=name).data for name in NAMES}
    finally:
        OpenImageIO.attribute("threads", threads)
    assert again == first


def test_every_format_has_the_same_bytes_without_files_in_memory(
    shot, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = {name: encode(shot(), format=name).data for name in NAMES}
    monkeypatch.delattr(os, "memfd_create", raising=False)
    assert {name: encode(shot(), format=name).data for name in NAMES} == first


def test_files_written_at_the_same_time_do_not_mix(shot) -> None:
    """The library lets other threads run while it writes."""
    seeds = range(12)
    alone = [encode(shot(seed=seed), format="exr").data for seed in seeds]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda seed: encode(shot(seed=seed), format="exr").data, seeds))
    assert together == alone
    assert len(set(alone)) == len(alone)


def test_metadata_that_the_library_would_drop_from_a_tiff_is_there(shot) -> None:
    (page,) = tifffile.TiffFile(io.BytesIO(encode(shot(), format="tiff").data)).pages
    assert '"seed":77001' in page.description
