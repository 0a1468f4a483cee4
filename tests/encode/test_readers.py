"""Every format against a reader that is not ours: bit for bit, with names, units and metadata."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import OpenEXR
import pytest
import tifffile
from PIL import Image

from phantom.encode import METADATA_KEY, encode
from phantom.encode.exr import exr, layer_names
from phantom.encode.jpeg import jpeg

IMAGES = ("signal", "transmission", "line_integral")


def from_exr(data: bytes, tmp_path: Any) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    (tmp_path / "x.exr").write_bytes(data)
    file = OpenEXR.File(str(tmp_path / "x.exr"), separate_channels=True)
    return {name: channel.pixels for name, channel in file.channels().items()}, file.header()


def test_an_openexr_file_holds_every_quantity_and_every_material_by_name(shot, tmp_path) -> None:
    picture = shot()
    layers, header = from_exr(encode(picture, format="exr").data, tmp_path)
    expected = {name: picture.quantity(name) for name in IMAGES}
    expected["thickness.bone, cortical"] = picture.thickness[..., 0]
    expected["thickness.Knochen-α"] = picture.thickness[..., 1]
    assert layers.keys() == expected.keys()
    for name, values in expected.items():
        assert layers[name].dtype == np.float32
        np.testing.assert_array_equal(layers[name], values.astype(np.float32))
    told = json.loads(header[METADATA_KEY])
    assert told.pop("file")["materials"] == {
        "thickness.bone, cortical": "bone, cortical",
        "thickness.Knochen-α": "Knochen-α",
    }
    assert told == picture.metadata()


def test_layers_keep_apart_whatever_their_materials_are_called(tmp_path) -> None:
    names = ["a\0b", "a_b", "a\nb", "𝕏" * 200, "𝕏" * 199, "x.y", " "]
    layers = layer_names("thickness", names)
    assert len(set(layers)) == len(names)
    assert layers[5] == "thickness.x.y"
    values = {name: np.full((3, 4), i, np.float32) for i, name in enumerate(layers)}
    found, _ = from_exr(exr(values, {}), tmp_path)
    assert {name: pixels[0, 0] for name, pixels in found.items()} == {
        name: i for i, name in enumerate(layers)
    }


@pytest.mark.parametrize("quantity", IMAGES)
@pytest.mark.parametrize("bits", [8, 16])
def test_a_tiff_holds_the_grey_levels(shot, quantity, bits) -> None:
    picture = shot()
    data = encode(picture, quantity, bits, "tiff").data
    expected = picture.presented(quantity, bits)
    (page,) = tifffile.TiffFile(io.BytesIO(data)).pages
    assert page.photometric == tifffile.PHOTOMETRIC.MINISBLACK
    assert page.asarray().dtype == expected.dtype
    np.testing.assert_array_equal(page.asarray(), expected)
    np.testing.assert_array_equal(np.array(Image.open(io.BytesIO(data))), expected)


@pytest.mark.parametrize("quantity", IMAGES)
def test_a_float_tiff_holds_the_numbers(shot, quantity) -> None:
    picture = shot()
    data = encode(picture, quantity, format="tiff-float32").data
    expected = picture.quantity(quantity).astype(np.float32)
    for found in (tifffile.imread(io.BytesIO(data)), np.array(Image.open(io.BytesIO(data)))):
        assert found.dtype == np.float32
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("name", ["tiff", "tiff-float32"])
def test_a_tiff_says_what_it_holds(shot, name) -> None:
    picture = shot()
    data = encode(picture, format=name).data
    (page,) = tifffile.TiffFile(io.BytesIO(data)).pages
    told = json.loads(page.description)
    assert told.pop("file")["format"] == name
    assert told == picture.metadata()
    assert page.tags["Software"].value == "phantom-xray 1.2.3"


def test_a_png_and_a_tiff_hold_the_same_grey_levels(shot, read_png: Callable[..., Any]) -> None:
    picture = shot()
    png, tiff = (encode(picture, "signal", 16, name).data for name in ("png", "tiff"))
    np.testing.assert_array_equal(read_png(png).pixels, tifffile.imread(io.BytesIO(tiff)))


def smooth(dtype: Any) -> np.ndarray:
    y, x = np.mgrid[:96, :128] / 128
    level = 0.5 + 0.5 * np.sin(5 * x + 3 * y)
    return np.rint(level * np.iinfo(dtype).max).astype(dtype)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_a_jpeg_is_a_preview_within_two_grey_levels(dtype) -> None:
    image = smooth(dtype)
    found = Image.open(io.BytesIO(jpeg(image, {})))
    assert found.mode == "L"
    wanted = image if dtype == np.uint8 else image / 257
    assert np.abs(np.array(found) - wanted.astype(np.float64)).max() <= 2.0


def test_a_jpeg_has_the_quality_it_states() -> None:
    # Table K.1 of ITU-T T.81, scaled as the Independent JPEG Group does: 200 - 2 × 95 percent.
    first_row = np.array([16, 11, 10, 16, 24, 40, 51, 61])
    table = Image.open(io.BytesIO(jpeg(smooth(np.uint8), {}))).quantization[0]
    assert list(table[:8]) == list((first_row * 10 + 50) // 100)


def test_a_jpeg_says_what_it_holds_where_that_fits_into_a_comment(shot) -> None:
    picture = shot()
    told = json.loads(Image.open(io.BytesIO(encode(picture, format="jpeg").data)).info["comment"])
    assert told.pop("file")["bits"] == 8
    assert told == picture.metadata()
    image = smooth(np.uint8)
    fits, exceeds = ({"x": "y" * (65_533 - len('{"x":""}') + more)} for more in (0, 1))
    assert json.loads(Image.open(io.BytesIO(jpeg(image, fits))).info["comment"]) == fits
    long = Image.open(io.BytesIO(jpeg(image, exceeds)))
    assert b"sidecar" in long.info["comment"]
    np.testing.assert_array_equal(np.array(long), np.array(Image.open(io.BytesIO(jpeg(image, {})))))


def test_json_is_the_metadata_alone(shot) -> None:
    told = json.loads(encode(shot(), format="json").data)
    assert told.pop("file") == {"format": "json", "holds": "metadata"}
    assert told == shot().metadata()
