"""Whole sets: the same bytes whoever makes them, whatever is killed, and nothing lost."""

from __future__ import annotations

import hashlib
import io
import json
import os
import pickle
import signal
import subprocess
import sys
import tarfile
import time
import zipfile

import numpy as np
import pytest
from PIL import Image

from phantom import datasets
from phantom.datasets import Part, Run, make, merge
from phantom.datasets.ledger import HaltedError, Ledger
from phantom.datasets.names import MANIFEST, STATE
from phantom.datasets.sampling import healthy
from phantom.errors import CancelledError, InvalidInputError

NODULE = {
    "type": "nodule",
    "prevalence": 0.5,
    "parameters": {"radius_mm": {"type": "uniform", "low": 2.0, "high": 6.0}},
}


@pytest.fixture(scope="module")
def plain(design):
    return design(people=12, abnormalities=[NODULE], outputs={"codes": True, "parquet": True})


@pytest.fixture(scope="module")
def undisturbed(plain, tmp_path_factory):
    """A set made by one worker in one go."""
    folder = tmp_path_factory.mktemp("undisturbed") / "set"
    made = make(plain, folder, Run(workers=1))
    assert (made.images, made.aside) == (12, [])
    return folder


def test_the_manifest_lists_every_file_and_its_hash(undisturbed, content):
    found = content(undisturbed)
    del found[MANIFEST]
    lines = (undisturbed / MANIFEST).read_text().splitlines()
    assert dict(reversed(line.split("  ")) for line in lines) == found
    assert not (undisturbed / STATE).exists()


def test_tables_say_what_the_images_are(undisturbed, plain):
    from pyarrow import parquet

    index = parquet.read_table(undisturbed / "index.parquet").to_pylist()
    assert [row["index"] for row in index] == list(range(12))
    for split, images in (("train", 10), ("validation", 1), ("test", 1)):
        lines = (undisturbed / split / "metadata.jsonl").read_text().splitlines()
        rows = [json.loads(line) for line in lines]
        assert len(rows) == images
        coco = json.loads((undisturbed / "coco" / f"{split}.json").read_text())
        assert [image["id"] for image in coco["images"]] == [row["index"] + 1 for row in rows]
        names = {c["id"]: c["name"] for c in coco["categories"]}
        for row in rows:
            mask = np.asarray(Image.open(undisturbed / split / row["mask_file_name"]))
            own = [a for a in coco["annotations"] if a["image_id"] == row["index"] + 1]
            nodules = [a for a in own if names[a["category_id"]] == "nodule"]
            assert len(nodules) == row["label"]
            assert sum(a["area"] for a in nodules) == np.count_nonzero(mask)
            (same,) = (r for r in index if r["index"] == row["index"])
            assert same["file_name"] == f"{split}/{row['file_name']}"
            assert same["label"] == row["label"]
            document = json.loads((undisturbed / split / row["document"]).read_text())
            assert len(document["findings"]) == row["label"]


def test_an_image_is_the_streams_item_of_the_same_number(undisturbed, plain):
    for number in (0, 9):
        item = datasets.stream(plain)[number]
        codes = np.load(undisturbed / "train" / f"{number:08d}.u16.npy")
        assert item["image"].dtype == np.float32
        assert np.abs(item["image"] * 32768 - codes).max() <= 0.51
        mask = np.asarray(Image.open(undisturbed / "train" / f"{number:08d}.mask.png"))
        assert np.array_equal(item["mask"], mask // 255)


def test_a_slice_of_a_stream_is_a_stream_that_travels(plain):
    whole = datasets.stream(plain, "train")
    part = pickle.loads(pickle.dumps(whole[1::4]))
    assert [item["index"] for item in part] == [1, 5, 9]
    assert np.array_equal(part[-1]["image"], whole[9]["image"])
    with pytest.raises(IndexError):
        part[3]


@pytest.mark.parametrize("workers", [2])
def test_any_number_of_workers_gives_the_same_bytes(plain, undisturbed, tmp_path, content, workers):
    make(plain, tmp_path / "set", Run(workers=workers))
    assert content(tmp_path / "set") == content(undisturbed)


def test_shards_merged_give_the_same_bytes(plain, undisturbed, tmp_path, content):
    folder = tmp_path / "set"
    for number in (1, 0):
        with pytest.raises(InvalidInputError, match="expected"):
            merge(folder)
        counts = make(plain, folder, Run(Part(number, 2), workers=1, ledger=tmp_path / f"{number}"))
        assert counts.done == 6
    # What was lost or torn since is made again, and nothing else is.
    (folder / "train" / "00000002.png").unlink()
    (folder / "train" / "00000004.mask.png").write_bytes(b"torn")
    seen = []
    again = Run(Part(0, 2), workers=1, ledger=tmp_path / "0")
    make(plain, folder, again, progress=lambda counts: seen.append(counts.open))
    assert seen[0] == 2
    merge(folder)
    assert content(folder) == content(undisturbed)
    assert merge(folder).images == 12, "a finished set is finished"


def test_an_interrupt_ends_with_130_and_leaves_what_is_finished(design, tmp_path):
    """As a terminal sends it, to the whole group; far more images than are made until then."""
    file, folder = tmp_path / "design.json", tmp_path / "set"
    file.write_text(json.dumps(design(people=5_000).tree()))
    command = [sys.executable, "-c", "from phantom.cli import main; main()"]
    process = subprocess.Popen(
        [*command, "dataset", str(file), str(folder), "--workers", "2"],
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # Behind a shell's "&" interrupts are ignored, and children would ignore them too.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    while process.poll() is None and len(list(folder.glob("train/*.mask.png"))) < 3:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate()
    assert process.returncode == 130, said
    assert said.splitlines() == [
        "stopped; what is finished is kept, and the same command goes on with it"
    ]
    kept = Ledger(folder / STATE / "ledger-00000-of-00001.sqlite")
    files = [file for _, _, told in kept.records() for file in json.loads(told)["files"]]
    kept.close()
    assert len(files) >= 3
    for name, sha256, size in files:
        data = (folder / name).read_bytes()
        assert (hashlib.sha256(data).hexdigest(), len(data)) == (sha256, size)


def test_another_version_does_not_go_on_with_a_set(plain, tmp_path, monkeypatch):
    """Its bytes may be others."""
    run = Run(Part(0, 12), workers=1)
    make(plain, tmp_path / "set", run)
    monkeypatch.setattr("phantom.datasets.design.version", lambda _: "9.9")
    with pytest.raises(InvalidInputError, match="another design, or version of this program"):
        make(plain, tmp_path / "set", run)
    with pytest.raises(InvalidInputError, match="another design or version"):
        merge(tmp_path / "set")


def test_parts_of_another_division_are_refused_before_an_image_is_made(plain, tmp_path):
    folder = tmp_path / "set"
    make(plain, folder, Run(Part(0, 12), workers=1))
    for run in (Run(workers=1), Run(Part(1, 3), workers=1)):
        with pytest.raises(InvalidInputError) as refusal:
            make(plain, folder, run)
        assert [p.path for p in refusal.value.problems] == ["/shard"]
    assert len(list(folder.rglob("*.mask.png"))) == 1


def test_a_path_with_dots_makes_no_folder_on_its_way(plain, tmp_path):
    make(plain, tmp_path / "way" / ".." / "set", Run(Part(0, 12), workers=1))
    assert [p.name for p in tmp_path.iterdir()] == ["set"]


def test_a_cancelled_run_goes_on_where_it_was(plain, undisturbed, tmp_path, content):
    folder, seen = tmp_path / "set", []
    with pytest.raises(CancelledError):
        make(
            plain,
            folder,
            Run(workers=1),
            progress=lambda counts: seen.append(counts.done),
            cancelled=lambda: seen[-1] >= 4,
        )
    kept = content(folder)
    assert len([name for name in kept if name.endswith(".mask.png")]) >= 4
    before = len(seen)
    make(plain, folder, Run(workers=1), progress=lambda counts: seen.append(counts.done))
    assert seen[before] >= 4, "what is finished is not made again"
    assert content(folder) == content(undisturbed)


def test_another_design_is_refused_where_a_set_is(plain, design, undisturbed, tmp_path):
    with pytest.raises(InvalidInputError, match="another design"):
        make(design(people=13, splits={"train": 1.0}), undisturbed)


def test_a_deadly_image_is_set_aside_and_takes_no_other_along(design, tmp_path, content):
    drawn = {"type": "choice", "values": ["lives", "kills", "raises"], "weights": [8, 1, 1]}
    wanted = design(
        phantom={"name": "fatal", "parameters": {"fate": drawn}},
        people=12,
        splits={"train": 1.0},
        seed=5,
    )
    fates = [healthy(wanted, n).parameters["fate"] for n in range(12)]
    killing = [n for n, fate in enumerate(fates) if fate == "kills"]
    raising = [n for n, fate in enumerate(fates) if fate == "raises"]
    assert killing
    assert raising
    assert fates[0] == "lives", "the first is planned by the one who asks"
    made = make(wanted, tmp_path / "set", Run(workers=2))
    errors = dict(made.aside)
    assert sorted(errors) == sorted([*killing, *raising])
    assert {errors[n] for n in killing} == {f"its worker was ended by {signal.SIGKILL.name}"}
    assert {errors[n] for n in raising} == {"ZeroDivisionError: a fault of the phantom's own"}
    assert made.images == 12 - len(errors)
    rows = (tmp_path / "set" / "train" / "metadata.jsonl").read_text().splitlines()
    assert [json.loads(row)["index"] for row in rows] == [n for n in range(12) if n not in errors]
    told = (tmp_path / "set" / "set_aside.jsonl").read_text().splitlines()
    assert [json.loads(line)["index"] for line in told] == sorted(errors)


@pytest.mark.nightly
def test_an_image_that_takes_too_long_is_set_aside(design, tmp_path):
    drawn = {"type": "choice", "values": ["lives", "hangs"], "weights": [3, 1]}
    wanted = design(
        phantom={"name": "fatal", "parameters": {"fate": drawn}},
        people=4,
        splits={"train": 1.0},
        seed=0,
    )
    hanging = [n for n in range(4) if healthy(wanted, n).parameters["fate"] == "hangs"]
    assert len(hanging) == 1
    made = make(wanted, tmp_path / "set", Run(workers=1, lease_s=30.0))
    assert made.aside == [(hanging[0], "it took longer than 30 s")]


def test_shards_hold_the_samples_at_fixed_times(design, tmp_path, content):
    wanted = design(
        people=5, abnormalities=[NODULE], outputs={"shards": True}, splits={"train": 3, "test": 2}
    )
    make(wanted, tmp_path / "one", Run(workers=2))
    plain_form = design(**{**wanted.tree(), "outputs": {"shards": False}})
    make(plain_form, tmp_path / "files", Run(workers=2))
    with tarfile.open(tmp_path / "one" / "train" / "000000.tar") as shard:
        members = shard.getmembers()
        for number in range(3):
            for ending in ("png", "mask.png", "document.json"):
                data = shard.extractfile(f"{number:08d}.{ending}").read()
                own = tmp_path / "files" / "train" / f"{number:08d}.{ending}"
                assert data == own.read_bytes()
    assert {member.mtime for member in members} == {0}
    rows = (tmp_path / "one" / "index.jsonl").read_text().splitlines()
    assert [json.loads(row)["shard"] for row in rows] == ["train/000000.tar"] * 3 + [
        "test/000000.tar"
    ] * 2


def test_a_deadly_image_leaves_the_rest_of_its_shard(design, tmp_path):
    drawn = {"type": "choice", "values": ["lives", "kills"], "weights": [4, 1]}
    wanted = design(
        phantom={"name": "fatal", "parameters": {"fate": drawn}},
        people=10,
        splits={"train": 1.0},
        outputs={"shards": True},
        seed=0,
    )
    killing = [n for n in range(10) if healthy(wanted, n).parameters["fate"] == "kills"]
    assert len(killing) == 1
    made = make(wanted, tmp_path / "set", Run(workers=1))
    assert [number for number, _ in made.aside] == killing
    with tarfile.open(tmp_path / "set" / "train" / "000000.tar") as shard:
        keys = {name.partition(".")[0] for name in shard.getnames()}
    assert keys == {f"{n:08d}" for n in range(10) if n not in killing}


def test_a_blind_set_tells_readers_nothing(design, tmp_path):
    wanted = design(people=12, abnormalities=[NODULE], twins=True, blind=True)
    make(wanted, tmp_path / "set", Run(workers=2))
    folder = tmp_path / "set"
    rows = []
    for split in ("train", "validation", "test"):
        rows += map(json.loads, (folder / split / "metadata.jsonl").read_text().splitlines())
    assert {tuple(sorted(row)) for row in rows} == {
        ("codes_per_unit", "columns", "file_name", "key", "open_field", "pitch_mm", "rows", "view")
    }
    known = [json.loads(x) for x in (folder / "truth" / "index.jsonl").read_text().splitlines()]
    assert {row["key"] for row in rows} == {row["key"] for row in known}
    assert len({row["label"] for row in known}) == 2
    by_name = [row["key"] for row in sorted(known, key=lambda row: row["key"])]
    by_number = [row["key"] for row in sorted(known, key=lambda row: row["index"])]
    assert by_name != by_number, "the order of the names is not that of the people"
    open_files = [p for p in folder.rglob("*") if p.is_file() and "truth" not in p.parts]
    words = (b"nodule", b"lesioned:", b"phantom:metadata", b"twin", b"mask", b"person")
    for path in open_files:
        if path.suffix in (".png", ".jsonl", ".sha256"):
            assert not any(word in path.read_bytes() for word in words), path
    assert not [p for p in open_files if p.name in ("design.json", "coco")]
    assert sum(p.name.endswith(".twin.png") for p in (folder / "truth").iterdir()) == sum(
        row["label"] for row in known
    )


def test_a_set_goes_to_any_address_of_fsspec_that_workers_reach(plain, undisturbed, tmp_path):
    """Another than a drive is read in tests/compare/test_object_store.py."""
    import fsspec

    ours = f"file://{tmp_path}/set"
    with pytest.raises(InvalidInputError, match="expected a file on a local disk"):
        make(plain, ours)
    make(plain, ours, Run(workers=2, ledger=tmp_path / "ledger"))
    files = fsspec.filesystem("file")
    found = files.cat_file(f"{tmp_path}/set/{MANIFEST}")
    assert found == (undisturbed / MANIFEST).read_bytes()
    for line in found.decode().splitlines():
        sha, _, name = line.partition("  ")
        assert hashlib.sha256(files.cat_file(f"{tmp_path}/set/{name}")).hexdigest() == sha


def test_a_place_that_workers_do_not_see_is_refused(plain, tmp_path):
    """The memory of a process is its own: what workers wrote there would be gone with them."""
    with pytest.raises(InvalidInputError) as refusal:
        make(plain, "memory://bucket/set", Run(workers=1, ledger=tmp_path / "ledger"))
    assert [(p.path, p.kind) for p in refusal.value.problems] == [("/output", "not_shared")]
    assert list(tmp_path.iterdir()) == []


def test_a_worker_of_a_cluster_refuses_a_place_that_it_does_not_see(plain, tmp_path):
    from phantom.datasets.cluster import make_chunk

    with pytest.raises(InvalidInputError, match="do not see"):
        make_chunk(plain.tree(), str(tmp_path / "of-another-machine"), None, [0])


@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1:port", "foo://127.0.0.1:1", ""])
def test_what_is_no_address_of_a_scheduler_is_refused(plain, tmp_path, address):
    with pytest.raises(InvalidInputError) as refusal:
        make(plain, tmp_path / "set", Run(scheduler=address))
    assert [p.path for p in refusal.value.problems] == ["/scheduler"]
    assert list((tmp_path / "set").iterdir()) == []


def test_places_that_cannot_be_used_are_refused_and_nothing_is_left(plain, tmp_path):
    letter = tmp_path / "letter.txt"
    letter.write_text("dear")
    closed = tmp_path / "closed.zip"
    with zipfile.ZipFile(closed, "w") as archive:
        archive.writestr("a", "b")
    for output, ledger, path in (
        (letter / "set", None, "/output"),
        (f"zip://set::file://{closed}", tmp_path / "ledger", "/output"),
        (f"zip://set::file://{tmp_path}/none.zip", tmp_path / "ledger", "/output"),
        (tmp_path / "set", letter, "/ledger"),
        (tmp_path / "set", letter / "ledger", "/ledger"),
    ):
        with pytest.raises(InvalidInputError) as refusal:
            make(plain, output, Run(workers=1, ledger=ledger))
        assert [(p.path, p.kind) for p in refusal.value.problems] == [(path, "unusable")]
        assert sorted(p.name for p in tmp_path.iterdir()) == ["closed.zip", "letter.txt"]
    assert letter.read_text() == "dear"


def test_a_place_that_is_lost_halts_the_run_and_blames_no_image(
    plain, undisturbed, tmp_path, content
):
    folder = tmp_path / "set"
    with pytest.raises(HaltedError, match="exists"):
        make(
            plain,
            folder,
            Run(workers=2),
            progress=lambda _: (folder / "train").touch(),  # where its folder should be
        )
    (folder / "train").unlink()
    assert make(plain, folder, Run(workers=2)).aside == []
    assert content(folder) == content(undisturbed)


def test_the_contact_sheet_shows_some_of_all_splits(undisturbed):
    sheet = Image.open(io.BytesIO((undisturbed / "contact_sheet.png").read_bytes()))
    # 12 pictures of 32 pixels, six in a row, with a caption and a gap each.
    assert sheet.size == (6 * (32 + 6) + 6, 2 * (32 + 14 + 6) + 6)
