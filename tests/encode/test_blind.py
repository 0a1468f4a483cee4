"""A blind file shows what it shows and tells nothing."""

from __future__ import annotations

import io
import json

import numpy as np
import pydicom
import pytest
import tifffile

from phantom.encode import FORMATS, encode, save

NAMES = tuple(known.name for known in FORMATS)
TELLING = (b"77001", b"5ec2e7", b"genou", b"phantom:", b"1.2.3", b"cortical", b"magnification")
"""Seed, document, name, metadata's key, version, a material, geometry."""


@pytest.mark.parametrize("name", NAMES)
def test_a_blind_file_says_nothing_of_what_made_it(shot, name: str) -> None:
    encoded = encode(shot(), "line_integral", format=name, blind=True)
    for word in TELLING:
        assert word not in encoded.data, word
    assert encoded.beside.keys() == {"file"}
    assert "cortical" not in json.dumps(encoded.beside)


@pytest.mark.parametrize("name", [n for n in NAMES if not n.startswith(("npy", "json"))])
def test_an_open_file_says_it(shot, name: str) -> None:
    assert b"5ec2e7" in encode(shot(), format=name).data


def test_the_pixels_are_the_same(shot) -> None:
    blind, seen = (encode(shot(), format="tiff", blind=b).data for b in (True, False))
    np.testing.assert_array_equal(*(tifffile.imread(io.BytesIO(data)) for data in (blind, seen)))
    blind, seen = (encode(shot(), format="dicom", blind=b).data for b in (True, False))
    one, other = (pydicom.dcmread(io.BytesIO(data)) for data in (blind, seen))
    assert one.PixelData == other.PixelData


def test_a_blind_dicom_file_has_identifiers_that_no_request_leads_to(shot) -> None:
    """Two requests with equal pixels are one file, so trying requests tells nothing."""
    one, other = shot(), shot(beam={"energy_kev": 70.0})
    blind = [encode(picture, format="dicom", blind=True).data for picture in (one, other)]
    seen = [encode(picture, format="dicom").data for picture in (one, other)]
    assert blind[0] == blind[1]
    assert seen[0] != seen[1]


def test_a_blind_sidecar_only_says_how_to_read_the_numbers(shot, tmp_path) -> None:
    save(shot(), tmp_path / "a.u16.npy", "line_integral", sidecar=True, blind=True)
    beside = json.loads((tmp_path / "a.u16.json").read_text())
    assert beside.keys() == {"file"}
    assert beside["file"]["codes_per_unit"] == 8192
