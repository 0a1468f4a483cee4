"""Finishing a set: its tables, README, contact sheet and, last of all, the manifest."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from phantom.datasets.card import card
from phantom.datasets.contact import Tile, sheet
from phantom.datasets.design import Design
from phantom.datasets.making import text
from phantom.datasets.names import (
    CARD,
    CONTACT_SHEET,
    DESIGN,
    MANIFEST,
    SET_ASIDE,
    STATE,
    TRUTH,
    apart,
)
from phantom.datasets.parts import Parts
from phantom.datasets.places import images_of_splits
from phantom.datasets.rows import beside, coco_lines, lines, open_row, whole
from phantom.datasets.storage import Hashed, Storage

CAPTION_DIGITS: Final = 8


@dataclass(slots=True)
class Finished:
    """What a set came to.

    Attributes
    ----------
    images, bytes
        Made, and of how many bytes in all files.
    aside
        Number and error of every image that could not be made.
    """

    images: int = 0
    bytes: int = 0
    aside: list[tuple[int, str]] = field(default_factory=list)


@dataclass(slots=True)
class _Listing:
    """The files of a set as the manifest has them: name to hash."""

    where: Storage
    names: dict[str, str] = field(default_factory=dict)
    size: int = 0

    def put(self, name: str, data: bytes) -> None:
        self.where.put(name, data)
        self.add(name, hashlib.sha256(data).hexdigest(), len(data))

    def add(self, name: str, sha256: str, size: int) -> None:
        self.names[name] = sha256
        self.size += size

    def write(self, name: str, lines: Iterable[str]) -> None:
        """Write lines to a file."""
        with self.where.writing(name) as stream:
            hashed = Hashed(stream)
            for line in lines:
                hashed.write(line.encode())
        self.add(name, hashed.sha256(), hashed.bytes)


def finish(design: Design, where: Storage) -> Finished:
    """Write what a set has beside its images, and forget how it was made.

    Raises
    ------
    InvalidInputError
        A part of the set is missing (``/output``).
    """
    parts = Parts(where, design.digest())
    listing, found = _Listing(where), Finished()
    tiles, labels = dict[int, Tile](), Counter[tuple[str, int]]()
    for number, record in parts:
        if "error" in record:
            found.aside.append((number, record["error"]))
            continue
        found.images += 1
        for name, sha256, size in record["files"]:
            listing.add(name, sha256, size)
        row = record["row"]
        labels[row["split"], row["label"]] += 1
        if "thumbnail" in record:
            framed = bool(row["label"]) and not design.blind
            tiles[number] = Tile(record["thumbnail"], row["key"][:CAPTION_DIGITS], framed)
    _tables(design, parts, listing)
    if design.outputs.coco:
        for split in images_of_splits(design):
            name = f"coco/{split}.json" if not design.blind else f"{TRUTH}/coco-{split}.json"
            listing.write(name, coco_lines(design, split, lambda: _made(parts)))
    if found.aside:
        told = ({"index": number, "error": error} for number, error in found.aside)
        listing.write(apart(design, SET_ASIDE), (f"{text(line)}\n" for line in told))
    tree = json.dumps(design.tree(), indent=1, ensure_ascii=False, allow_nan=False)
    listing.put(apart(design, DESIGN), f"{tree}\n".encode())
    if tiles:
        order = sorted(tiles, key=lambda n: tiles[n].caption if design.blind else f"{n:012d}")
        listing.put(CONTACT_SHEET, sheet([tiles[number] for number in order]))
    listing.put(CARD, card(design, labels, len(found.aside)).encode())
    _manifests(design, listing)
    found.bytes = listing.size
    where.forget(STATE)
    return found


def _manifests(design: Design, listing: _Listing) -> None:
    """Write the hashes as ``sha256sum`` does; those of a blind set's truth apart from the rest."""
    kept_apart = {n: sha for n, sha in listing.names.items() if n.startswith(f"{TRUTH}/")}
    if design.blind:
        for name in kept_apart:
            del listing.names[name]
        own = {name.removeprefix(f"{TRUTH}/"): sha for name, sha in kept_apart.items()}
        listing.where.put(f"{TRUTH}/{MANIFEST}", _sums(own))
    listing.where.put(MANIFEST, _sums(listing.names))


def _sums(names: Mapping[str, str]) -> bytes:
    return "".join(f"{sha}  {name}\n" for name, sha in sorted(names.items())).encode()


def _tables(design: Design, parts: Parts, listing: _Listing) -> None:
    """Write the rows: beside the pictures as imagefolder reads them, and of the whole set."""
    if design.sharded:
        listing.write("index.jsonl", lines(design, (open_row(design, r) for r in _made(parts))))
    else:
        for split, images in images_of_splits(design).items():
            own = (r for r in _made(parts) if r["row"]["split"] == split)
            if images:
                rows = (beside(design, record, open_row(design, record)) for record in own)
                listing.write(f"{split}/metadata.jsonl", lines(design, rows))
    if design.blind:
        known = (f"{text(record['row'])}\n" for record in _made(parts))
        listing.write(f"{TRUTH}/index.jsonl", known)
    if design.outputs.parquet:
        from phantom.datasets.tables import parquet

        name = apart(design, "index.parquet")
        with listing.where.writing(name) as stream:
            hashed = Hashed(stream)
            parquet(hashed, (whole(design, record) for record in _made(parts)))
        listing.add(name, hashed.sha256(), hashed.bytes)


def _made(parts: Parts) -> Iterator[Mapping[str, Any]]:
    return (record for _, record in parts if "error" not in record)
