"""The names in a set: of files, and of what is kept apart in a blind one."""

from __future__ import annotations

from typing import Final

from phantom.datasets.design import Design
from phantom.datasets.places import Place

OPEN: Final = frozenset({"png", "u16.npy", "right.png", "right.u16.npy", "json"})
"""Endings of what a reader of a blind set may see."""

TRUTH: Final = "truth"
"""Folder of what a reader of a blind set may not see, and of archives of ground truth."""

STATE: Final = ".phantom"
"""Folder of what is known of a set that is being made; gone when it is finished."""

DESIGN: Final = "design.json"
MANIFEST: Final = "manifest.sha256"
CONTACT_SHEET: Final = "contact_sheet.png"
CARD: Final = "README.md"
SET_ASIDE: Final = "set_aside.jsonl"


def is_open(design: Design, ending: str) -> bool:
    """Tell whether a file of this ending stands with the pictures, and not with the truth."""
    return ending in OPEN if design.blind else not ending.endswith("truth.zip")


def file_name(design: Design, at: Place, ending: str) -> str:
    """Return the name of an image's file in its set."""
    folder = at.split if is_open(design, ending) else TRUTH
    return f"{folder}/{at.key}.{ending}"


def apart(design: Design, name: str) -> str:
    """Return the name of a table or list that tells what is known."""
    return f"{TRUTH}/{name}" if design.blind else name


def shard_name(split: str, number: int, *, truth: bool = False) -> str:
    """Return the name of a WebDataset shard; ``number`` counts those of the split."""
    return f"{TRUTH}/{split}-{number:06d}.tar" if truth else f"{split}/{number:06d}.tar"


def part_name(part: int, parts: int) -> str:
    """Return the name of the list of what one part of a set has made."""
    return f"{STATE}/part-{part:05d}-of-{parts:05d}.jsonl"
