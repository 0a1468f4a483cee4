"""PyTorch loads the stream of a design: the stream's own images, each of them once.

``uv run --with torch pytest -n 0 -m compare tests/compare/test_torch.py``
"""

from __future__ import annotations

import importlib
import re
from pathlib import Path

import numpy as np
import pytest

from phantom import datasets

pytestmark = [
    pytest.mark.compare,
    pytest.mark.filterwarnings("ignore"),
]

torch = pytest.importorskip("torch")

PAGE = Path(__file__).parents[2] / "docs" / "datasets.md"
DRAWN = {"type": "uniform", "low": 5.0, "high": 20.0}
TREE = {
    "phantom": {"name": "sphere", "parameters": {"radius_mm": DRAWN}},
    "people": 10,
    "detector": {"columns": 24, "rows": 16},
    "splits": {"train": 7, "test": 3},
    "seed": 3,
}


@pytest.fixture(scope="module")
def truth():
    """The images of the split for training, without torch."""
    return {item["index"]: item for item in datasets.stream(TREE, "train")}


@pytest.fixture
def once(tmp_path, monkeypatch):
    """The class that the page shows, in a module that workers can import."""
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.S)
    (shown,) = (block for block in blocks if "IterableDataset" in block)
    head, _, rest = shown.partition("stream = ")
    written = head + "class Once" + rest.partition("class Once")[2]
    (tmp_path / "shown_to_torch.py").write_text(written)
    monkeypatch.syspath_prepend(str(tmp_path))
    return importlib.import_module("shown_to_torch").Once


def _loaded(of, workers, **given):
    context = {"multiprocessing_context": "spawn"} if workers else {}
    loader = torch.utils.data.DataLoader(of, batch_size=2, num_workers=workers, **context, **given)
    found = []
    for batch in loader:
        assert batch["image"].dtype == torch.float32
        assert batch["image"].shape[1:] == (16, 24)
        images, masks = batch["image"].numpy(), batch["mask"].numpy()
        rows = zip(batch["index"].tolist(), batch["label"].tolist(), images, masks, strict=True)
        found += rows
    return found


def _are_these(found, truth):
    assert sorted(number for number, *_ in found) == sorted(truth), "each of them once"
    for number, label, image, mask in found:
        assert label == truth[number]["label"]
        assert np.array_equal(image, truth[number]["image"])
        assert np.array_equal(mask, truth[number]["mask"])


@pytest.mark.parametrize("workers", [0, 1, 2])
def test_a_map_style_loader_gives_the_streams_own_images(truth, workers):
    stream = datasets.stream(TREE, "train", threads=1)
    _are_these(_loaded(stream, workers), truth)
    shuffled = torch.Generator().manual_seed(1)
    found = _loaded(stream, workers, shuffle=True, generator=shuffled)
    _are_these(found, truth)
    assert [number for number, *_ in found] != sorted(truth)


@pytest.mark.parametrize("workers", [0, 1, 2])
def test_an_iterable_loader_gives_them_too(truth, once, workers):
    of = once(datasets.stream(TREE, "train", threads=1))
    assert isinstance(of, torch.utils.data.IterableDataset)
    _are_these(_loaded(of, workers), truth)
