"""What the tables of a set say of each image, from its record."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Final

from phantom.datasets.design import Design
from phantom.datasets.making import text
from phantom.datasets.names import is_open
from phantom.datasets.places import place

Row = Mapping[str, Any]

BLIND: Final = ("key", "view", "columns", "rows", "pitch_mm", "open_field", "codes_per_unit")
"""What a reader of a blind set may know of an image."""

PICTURES: Final = {
    "file_name": "png",
    "right_file_name": "right.png",
    "mask_file_name": "mask.png",
    "right_mask_file_name": "right.mask.png",
    "twin_file_name": "twin.png",
    "right_twin_file_name": "twin.right.png",
}
"""Columns of pictures, as imagefolder wants them called."""

OTHERS: Final = {
    "codes": "u16.npy",
    "right_codes": "right.u16.npy",
    "truth": "truth.zip",
    "right_truth": "right.truth.zip",
    "document": "document.json",
}
"""Columns of other files."""


def seen(design: Design, row: Row) -> Row:
    """Return what may be said of an image beside it: of a blind one, next to nothing."""
    return {name: row[name] for name in BLIND} if design.blind else row


def open_row(design: Design, record: Row) -> Row:
    """Return the same from an image's record, with its shard where it is in one."""
    shard = {"shard": record["shard"]} if design.sharded else {}
    return {**shard, **seen(design, record["row"])}


def beside(design: Design, record: Row, row: Row, folder: str = "") -> Row:
    """Return a row with the names of the image's files before it, below ``folder``.

    The twin of a healthy picture is the picture itself. A case has one document, kept with its
    first view.
    """
    endings, key = record["endings"], record["row"]["key"]
    found = {
        column: f"{folder}{key}.{ending}"
        for column, ending in {**PICTURES, **OTHERS}.items()
        if ending in endings and is_open(design, ending)
    }
    if design.twins and not design.blind:
        for eye in ("", "right_"):
            if f"{eye}file_name" in found:
                found.setdefault(f"{eye}twin_file_name", found[f"{eye}file_name"])
    if design.outputs.documents and not design.blind:
        number = record["row"]["index"]
        first = place(design, number - number % len(design.views))
        found["document"] = f"{folder}{first.key}.document.json"
    return {**found, **row}


def whole(design: Design, record: Row) -> Row:
    """Return all that is known of an image, with the names of its files in the set."""
    row = record["row"]
    if design.sharded:
        return {"shard": record["shard"], **row}
    return {**beside(design, record, {}, f"{row['split']}/"), **row}


def lines(design: Design, rows: Iterable[Row]) -> Iterator[str]:
    """Yield rows as JSON, a line each; those of a blind set in the order of their names."""
    if design.blind:
        rows = sorted(rows, key=lambda row: str(row["key"]))
    for row in rows:
        yield f"{text(row)}\n"


def coco_lines(design: Design, split: str, records: Callable[[], Iterable[Row]]) -> Iterator[str]:
    """Yield the COCO tree of a split, piece by piece.

    Images are numbered from 1 by their place in the set. Categories are the leaves of all splits,
    numbered from 1 as they turn up, so that every split has the same.
    """
    categories: dict[tuple[str, str], int] = {}
    for record in records():
        for told in record.get("coco", ()):
            name = (told["name"], told["material"])
            categories.setdefault(name, len(categories) + 1)
    named = [
        {"id": number, "name": name, "supercategory": material}
        for (name, material), number in categories.items()
    ]
    yield f'{{"categories":{text(named)},\n"images":['
    before = "\n"
    for record in records():
        row = record["row"]
        if row["split"] == split:
            folder = "" if design.sharded else f"{split}/"
            image = {
                "id": row["index"] + 1,
                "width": row["columns"],
                "height": row["rows"],
                "file_name": f"{folder}{row['key']}.png",
            }
            yield before + text(image)
            before = ",\n"
    yield '],\n"annotations":['
    before, number = "\n", 0
    for record in records():
        row = record["row"]
        if row["split"] != split:
            continue
        for told in record.get("coco", ()):
            number += 1
            content = {k: v for k, v in told.items() if k not in ("name", "material")}
            category = categories[told["name"], told["material"]]
            numbers = {"id": number, "image_id": row["index"] + 1, "category_id": category}
            yield before + text({**numbers, **content})
            before = ",\n"
    yield "]}\n"
