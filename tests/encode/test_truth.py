"""Ground truth in files: run lengths, COCO, the archive, each read by other means."""

from __future__ import annotations

import dataclasses
import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from phantom.encode import METADATA_KEY, save_truth
from phantom.encode.archive import archive
from phantom.encode.coco import coco, run_lengths
from phantom.encode.truth import truth_files
from phantom.errors import InvalidInputError
from phantom.imaging import Detector, Truth, View, ground_truth
from phantom.scene import load

DETECTOR = Detector(
    center=(0, 200, 0), right=(1, 0, 0), down=(0, 0, -1), columns=40, rows=30, pitch_mm=2
)
VIEW = View(source=None, direction=(0, 1, 0), detector=DETECTOR)
SOLIDS = [
    {"type": "box", "name": "bar", "center": [-9, 0, 7], "size": [11, 6, 5], "material": "bone"},
    {
        "type": "sphere",
        "name": "group/ball",
        "center": [4, 0, -3],
        "radius": 9.1,
        "material": "soft",
    },
    {"type": "sphere", "name": "unseen", "center": [400, 0, 0], "radius": 9, "material": "soft"},
]


@pytest.fixture(scope="module")
def truth() -> Truth:
    tree = {
        "format": "phantom/1",
        "materials": {"bone": {"attenuation_per_mm": 1}, "soft": {"attenuation_per_mm": 0.1}},
        "solid": {"type": "union", "solids": SOLIDS},
        "landmarks": {"isocentre": [0, 0, 0]},
        "findings": [{"name": "fracture", "leaves": ["bar"]}],
    }
    return ground_truth(load(tree), VIEW)


def decoded(segmentation: dict[str, Any]) -> Any:
    """A COCO mask pixel by pixel: down the first column, then the next."""
    rows, columns = segmentation["size"]
    mask = np.zeros((rows, columns), dtype=bool)
    position, value = 0, False
    for count in segmentation["counts"]:
        for _ in range(count):
            mask[position % rows, position // rows] = value
            position += 1
        value = not value
    assert position == rows * columns
    return mask


def test_run_lengths_go_down_the_columns_and_begin_with_0() -> None:
    """The mask of three columns 011 / 110 / 000, as one would count it by hand."""
    mask = np.array([[0, 1, 0], [1, 1, 0], [1, 0, 0]], dtype=bool)
    assert run_lengths(mask) == [1, 4, 4]
    assert run_lengths(~mask) == [0, 1, 4, 4]
    assert run_lengths(np.zeros((2, 3), dtype=bool)) == [6]
    assert run_lengths(np.ones((2, 3), dtype=bool)) == [0, 6]


@pytest.mark.parametrize("seed", range(20))
def test_random_masks_come_back_from_their_run_lengths(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mask = rng.random(rng.integers(1, 12, 2)) < rng.random()
    segmentation = {"size": list(mask.shape), "counts": run_lengths(mask)}
    np.testing.assert_array_equal(decoded(segmentation), mask)
    assert all(count > 0 for count in segmentation["counts"][1:])


def test_coco_has_an_annotation_for_each_leaf_that_is_seen(truth: Truth) -> None:
    tree = coco(truth.leaves, truth.size, "knee.png", truth.centroids_px)
    assert tree["images"] == [{"id": 1, "width": 40, "height": 30, "file_name": "knee.png"}]
    names = [(c["id"], c["name"], c["supercategory"]) for c in tree["categories"]]
    assert names == [(1, "bar", "bone"), (2, "group/ball", "soft"), (3, "unseen", "soft")]
    bar, ball = tree["annotations"]
    # Pixel centres are at x = 2 c - 39 and z = 29 - 2 r; the bar goes from -14.5 to -3.5 and from
    # 4.5 to 9.5, so that its columns are 13 to 17 and its rows 10 to 12.
    mask = np.zeros((30, 40), dtype=bool)
    mask[10:13, 13:18] = True
    np.testing.assert_array_equal(decoded(bar["segmentation"]), mask)
    assert bar["bbox"] == [13, 10, 5, 3]
    assert bar["area"] == 15
    x, z = 2 * np.arange(40) - 39, 29 - 2 * np.arange(30)
    # No pixel centre lies on its outline, where rounding would decide.
    inside = (x[None, :] - 4) ** 2 + (z[:, None] + 3) ** 2 < 9.1**2
    np.testing.assert_array_equal(decoded(ball["segmentation"]), inside)
    # The ball's middle is at column 21.5 and row 16 of ours, half a pixel on in COCO's.
    np.testing.assert_allclose(ball["centroid"], [22.0, 16.5], atol=0.05)


def test_files_hold_what_was_traced(truth: Truth) -> None:
    files = truth_files(truth, "knee.png")
    told = json.loads(files["truth.json"])
    assert json.loads(files["coco.json"])["images"][0]["file_name"] == "knee.png"
    assert [leaf["name"] for leaf in told["leaves"]] == ["bar", "group/ball", "unseen"]
    assert told["findings"] == [{"name": "fracture", "leaves": ["bar"]}]
    assert told["landmarks"]["isocentre"]["pixel"] == pytest.approx([19.5, 14.5])
    bar = told["leaves"][0]
    assert bar["box"] == {"first_column": 13, "first_row": 10, "last_column": 17, "last_row": 12}
    assert bar["files"] == ["masks/000.png", "thickness/000.npy", "entry_depth/000.npy"]
    assert told["leaves"][2]["box"] is None
    assert "files" not in told["leaves"][2]
    mask = np.array(Image.open(io.BytesIO(files["masks/000.png"])))
    assert mask.dtype == np.uint8
    expected = np.zeros((30, 40))
    expected[10:13, 13:18] = 255
    np.testing.assert_array_equal(mask, expected)
    thickness = np.load(io.BytesIO(files["thickness/000.npy"]))
    np.testing.assert_allclose(thickness, 6 * expected / 255, atol=1e-6)
    # The bar begins at y = -3, which is 203 before the detector.
    depth = np.load(io.BytesIO(files["entry_depth/000.npy"]))
    np.testing.assert_allclose(depth[expected > 0], -203, atol=1e-4)
    assert np.isnan(depth[expected == 0]).all()


def test_only_what_was_asked_for_is_written(truth: Truth) -> None:
    tree = {
        "format": "phantom/1",
        "materials": {"bone": {"attenuation_per_mm": 1}, "soft": {"attenuation_per_mm": 0.1}},
        "solid": {"type": "union", "solids": SOLIDS},
    }
    few = truth_files(ground_truth(load(tree), VIEW, ["boxes"]))
    assert list(few) == ["truth.json"]
    some = truth_files(ground_truth(load(tree), VIEW, ["thickness"]))
    assert list(some) == ["truth.json", "thickness/000.npy", "thickness/001.npy"]


def test_an_openexr_has_a_layer_for_each_map_of_each_leaf_that_is_seen(
    truth: Truth, tmp_path: Path
) -> None:
    path = tmp_path / "truth.exr"
    assert save_truth(truth, path) == ("truth.exr",)
    file = OpenEXR.File(str(path), separate_channels=True)
    layers = {name: channel.pixels for name, channel in file.channels().items()}
    kinds, names = ("mask", "thickness", "entry_depth"), ("bar", "group/ball")
    assert set(layers) == {f"{kind}.{name}" for kind in kinds for name in names}
    expected = np.zeros((30, 40), dtype=np.float32)
    expected[10:13, 13:18] = 1
    np.testing.assert_array_equal(layers["mask.bar"], expected)
    np.testing.assert_allclose(layers["thickness.bar"], 6 * expected, atol=1e-6)
    assert np.isnan(layers["entry_depth.bar"][0, 0])
    assert json.loads(file.header()[METADATA_KEY])["leaves"][0]["name"] == "bar"


def test_an_openexr_without_layers_is_refused(truth: Truth, tmp_path: Path) -> None:
    only_boxes = dataclasses.replace(truth, kinds=("boxes",))
    with pytest.raises(InvalidInputError) as refusal:
        save_truth(only_boxes, tmp_path / "truth.exr")
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("/truth", "empty")]
    assert not list(tmp_path.iterdir())


def test_an_archive_is_the_same_bytes_every_time_and_unpacks_to_the_files(truth: Truth) -> None:
    files = truth_files(truth)
    data = archive(files)
    assert archive(truth_files(truth)) == data
    with zipfile.ZipFile(io.BytesIO(data)) as whole:
        assert whole.testzip() is None
        assert {name: whole.read(name) for name in whole.namelist()} == files
        assert {entry.date_time for entry in whole.infolist()} == {(1980, 1, 1, 0, 0, 0)}
