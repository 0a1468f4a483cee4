"""Other people's programs read a set as it is: Hugging Face, pandas, pycocotools, WebDataset.

``uv run --group sets pytest -n 0 -m compare tests/datasets/test_readers.py``
"""

from __future__ import annotations

import io
import json
import pickle
import re
from multiprocessing import get_context

import numpy as np
import pytest
from PIL import Image

from phantom import datasets as ours
from phantom.datasets import Run, make

pytestmark = [
    pytest.mark.compare,
    # Their programs, not ours, leave files open and use what is to go.
    pytest.mark.filterwarnings("ignore"),
]

NODULE = {
    "type": "nodule",
    "prevalence": 0.5,
    "parameters": {"radius_mm": {"type": "uniform", "low": 2.0, "high": 6.0}},
}
SPLITS = {"train": 8, "validation": 2, "test": 2}


@pytest.fixture(scope="module")
def wanted(design):
    return design(people=12, abnormalities=[NODULE], twins=True, splits=SPLITS)


@pytest.fixture(scope="module")
def folder(wanted, tmp_path_factory):
    folder = tmp_path_factory.mktemp("readers") / "set"
    make(wanted, folder, Run(workers=2))
    return folder


@pytest.fixture(scope="module")
def truth(wanted):
    """What each image is, from the stream, without a file."""
    return [*ours.stream(wanted)]


def _agrees(pixels, item, name="image"):
    codes = np.asarray(pixels)
    assert np.abs(codes / 32768 - item[name]).max() < 1 / 32768


def test_hugging_face_reads_it_as_an_imagefolder(folder, truth, tmp_path, monkeypatch):
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    datasets = pytest.importorskip("datasets")
    read = datasets.load_dataset("imagefolder", data_dir=str(folder), cache_dir=str(tmp_path))
    assert {split: len(rows) for split, rows in read.items()} == SPLITS
    seen = set()
    for split, rows in read.items():
        for row in rows:
            item = truth[row["index"]]
            seen.add(row["index"])
            assert (row["split"], row["label"]) == (split, item["label"])
            assert row["person"] == item["person"]
            _agrees(row["image"], item)
            _agrees(row["twin"], item, "twin")
            assert np.array_equal(np.asarray(row["mask"]) > 0, item["mask"] > 0)
    assert seen == set(range(12))


def test_the_readme_is_a_dataset_card(folder, truth, tmp_path, monkeypatch):
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    datasets = pytest.importorskip("datasets")
    read = datasets.load_dataset(str(folder), cache_dir=str(tmp_path))
    assert {split: len(rows) for split, rows in read.items()} == SPLITS
    row = read["test"][1]
    _agrees(row["image"], truth[row["index"]])


def test_splits_of_any_name_are_read_as_the_readme_says(design, truth, tmp_path, monkeypatch):
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    datasets = pytest.importorskip("datasets")
    wanted = design(people=12, abnormalities=[NODULE], twins=True, splits={"readers": 9, "try": 3})
    make(wanted, tmp_path / "set", Run(workers=2))
    (code,) = re.findall(r"```python\n(.*?)```", (tmp_path / "set/README.md").read_text(), re.S)
    monkeypatch.chdir(tmp_path / "set")
    monkeypatch.setattr(datasets.config, "HF_DATASETS_CACHE", tmp_path / "cache")
    said = {}
    exec(code, said)
    assert {split: len(rows) for split, rows in said["images"].items()} == {"readers": 9, "try": 3}
    assert said["rows"]["label"].tolist() == [item["label"] for item in truth[:9]]
    row = said["images"]["try"][0]
    _agrees(row["image"], truth[9])


def test_pandas_reads_the_rows(folder, truth):
    pandas = pytest.importorskip("pandas")
    rows = pandas.concat(
        pandas.read_json(folder / split / "metadata.jsonl", lines=True) for split in SPLITS
    )
    assert rows["index"].tolist() == list(range(12))
    assert rows["label"].tolist() == [item["label"] for item in truth]
    assert rows["has_nodule"].tolist() == rows["label"].tolist()
    assert rows.notna().all().all()
    radii = rows["abnormalities"].map(json.loads).map(lambda a: a[0]["radius_mm"] if a else 0.0)
    area = [int(item["mask"].sum()) for item in truth]
    assert np.corrcoef(radii**2, area)[0, 1] > 0.9
    parameters = rows["parameters"].map(json.loads)
    assert parameters.map(lambda p: 15 <= p["half_mm"] <= 25).all()
    assert rows["height_cm"].between(140, 210).all()


def test_pycocotools_reads_the_masks(folder, truth):
    coco = pytest.importorskip("pycocotools.coco")
    found = 0
    for split in SPLITS:
        read = coco.COCO(str(folder / "coco" / f"{split}.json"))
        (nodule,) = read.getCatIds(catNms=["nodule"])
        assert len(read.getImgIds()) == SPLITS[split]
        for image in read.loadImgs(read.getImgIds()):
            item = truth[image["id"] - 1]
            assert (folder / image["file_name"]).exists()
            own = read.loadAnns(read.getAnnIds(imgIds=image["id"], catIds=[nodule]))
            assert len(own) == item["label"]
            for annotation in own:
                mask = read.annToMask(annotation)
                assert np.array_equal(mask, item["mask"])
                rows, columns = np.nonzero(mask)
                left, top, width, height = annotation["bbox"]
                assert (left, top) == (columns.min(), rows.min())
                assert (width, height) == (np.ptp(columns) + 1, np.ptp(rows) + 1)
                found += 1
    assert found == sum(item["label"] for item in truth)


def test_webdataset_reads_the_shards(wanted, design, truth, tmp_path):
    webdataset = pytest.importorskip("webdataset")
    tree = wanted.tree() | {"outputs": {"shards": True}}
    make(design(**tree), tmp_path / "set", Run(workers=2))
    seen = []
    for split in SPLITS:
        shard = tmp_path / "set" / split / "000000.tar"
        # Its own decoder makes 8 bits of 16, so pictures are opened by hand.
        for sample in webdataset.WebDataset(str(shard), shardshuffle=False):
            row = json.loads(sample["json"])
            item = truth[row["index"]]
            assert sample["__key__"].endswith(f"{row['index']:08d}")
            assert (row["split"], row["label"]) == (split, item["label"])
            _agrees(Image.open(io.BytesIO(sample["png"])), item)
            mask = np.asarray(Image.open(io.BytesIO(sample["mask.png"])))
            assert np.array_equal(mask > 0, item["mask"] > 0)
            assert ("twin.png" in sample) == bool(item["label"])
            seen.append(row["index"])
    assert seen == list(range(12))


def _fetch(packed: bytes, numbers: list[int]) -> list[dict]:
    stream = pickle.loads(packed)
    return [stream[number] for number in numbers]


def test_a_loader_with_workers_gets_the_same_items(wanted, truth):
    """As torch's DataLoader does it: the set is pickled to processes that are spawned."""
    packed = pickle.dumps(ours.stream(wanted, threads=1))
    with get_context("spawn").Pool(2) as pool:
        halves = pool.starmap(_fetch, [(packed, [0, 2, 4]), (packed, [5, 3, 1])])
    for number, item in zip([0, 2, 4, 5, 3, 1], [*halves[0], *halves[1]], strict=True):
        assert np.array_equal(item["image"], truth[number]["image"])
        assert item["label"] == truth[number]["label"]
