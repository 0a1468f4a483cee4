"""The README of a set: what it is, how to read it, and under which licence.

Its head is the YAML that dataset hubs read.
"""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.metadata import version

from phantom import library
from phantom.datasets.design import Design, DrawnPhantom
from phantom.datasets.names import SET_ASIDE, apart
from phantom.datasets.places import images_of_splits, people_of_splits

MADE_WITH = ("phantom-xray", "numpy", "scipy", "numba", "OpenImageIO", "xraylib")


def card(design: Design, labels: Mapping[tuple[str, int], int], aside: int) -> str:
    """Return the README.

    Parameters
    ----------
    design
        Of the set.
    labels
        How many images there are of each split and label.
    aside
        How many images could not be made.
    """
    parts = [_head(design), f"# {design.name}", *_what(design), _numbers(design, labels)]
    if aside:
        name = apart(design, SET_ASIDE)
        parts.append(f"{aside} of the images could not be made; `{name}` says which, and why.")
    parts += [_files(design), _reading(design), _made_with(design)]
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def _head(design: Design) -> str:
    lines = ["---", f"license: {design.licence.lower()}", "configs:", "- config_name: default"]
    lines.append("  data_files:")
    for split, images in images_of_splits(design).items():
        if images:
            lines += [f"  - split: {split}", f'    path: "{split}/*{_ending(design)}"']
    return "\n".join([*lines, "---"])


def _ending(design: Design) -> str:
    return ".tar" if design.sharded else ""


def _what(design: Design) -> list[str]:
    found = [design.description]
    asked = design.phantom
    if isinstance(asked, DrawnPhantom):
        entry = library.entry(asked.name)
        found.append(f"Simulated radiographs of `{entry.name}`, {entry.title}. {entry.summary}")
    else:
        found.append("Simulated radiographs of a phantom document.")
    found.append(
        "Computed from a mathematical model: no patient was X-rayed. Not for diagnostic use."
    )
    return found


def _numbers(design: Design, labels: Mapping[tuple[str, int], int]) -> str:
    columns = "| split | people | images |" + ("" if design.blind else " with an abnormality |")
    lines = [columns, "|---" * (columns.count("|") - 1) + "|"]
    people = people_of_splits(design)
    for split in images_of_splits(design):
        images = labels.get((split, 0), 0) + labels.get((split, 1), 0)
        own = "" if design.blind else f" {labels.get((split, 1), 0)} |"
        lines.append(f"| {split} | {people[split]} | {images} |{own}")
    lines += ["", "All images of a person are in one split."]
    return "\n".join(lines)


def _files(design: Design) -> str:
    kept = design.outputs
    stem = "KEY" if design.blind else "INDEX"
    lines = ["## Files", ""]
    if design.sharded:
        lines.append(
            "`SPLIT/NNNNNN.tar`: WebDataset shards of 1,000 samples; in each, of every image:"
        )
    else:
        lines.append("`SPLIT/` has the images of a split, and `metadata.jsonl` a line for each:")
    lines.append("")
    pixels = (
        "16 bits in proportion to the signal; a code over `codes_per_unit` is its value"
        if kept.form == "linear"
        else "grey levels"
    )
    lines.append(f"- `{stem}.png`: {pixels}")
    if design.stereo is not None and design.stereo.mono != "single":
        lines.append(f"- `{stem}.right.png`: the same for the right eye")
    if kept.codes:
        lines.append(
            f"- `{stem}.u16.npy`: codes of 16 bits; one over `codes_per_unit` is its value"
        )
    if not design.blind:
        if design.twins and design.abnormalities:
            lines.append(
                f"- `{stem}.twin.png`: an abnormal image without what is wrong, of the same noise"
            )
        lines += _known(design, stem)
    lines.append("")
    if design.blind:
        lines.append("`truth/`: all that is known, by the same keys; keep it from readers.")
    lines.append("`manifest.sha256`: of every other file; `sha256sum -c manifest.sha256`.")
    return "\n".join(lines)


def _known(design: Design, stem: str) -> list[str]:
    kept, found = design.outputs, []
    if kept.masks:
        of = "the findings" if design.abnormalities else "the named leaves"
        found.append(f"- `{stem}.mask.png`: 255 where something of {of} is")
    if kept.documents:
        found.append(f"- `{stem}.document.json`: the phantom, with the first view of each case")
    if design.truth:
        found.append(f"- `truth/{stem}.truth.zip`: {', '.join(design.truth)} of every leaf")
    if kept.coco:
        found.append("- `coco/SPLIT.json`: a run-length mask of every leaf")
    if kept.parquet:
        found.append("- `index.parquet`: every row of the set")
    found.append("- `design.json`: what all of this was made from")
    return found


def _reading(design: Design) -> str:
    splits = [name for name, images in images_of_splits(design).items() if images]
    first = splits[0]
    if design.sharded:
        code = (
            "import webdataset\n\n"
            f'samples = webdataset.WebDataset("{first}/000000.tar", shardshuffle=False)'
        )
    else:
        # Other names of splits are known from this page's head alone.
        usual = set(splits) <= {"train", "validation", "test"}
        where = '"imagefolder", data_dir="."' if usual else "os.getcwd()"
        code = (
            f"import {'' if usual else 'os, '}datasets, pandas\n\n"
            f"images = datasets.load_dataset({where})\n"
            f'rows = pandas.read_json("{first}/metadata.jsonl", lines=True)'
        )
    return f"## Reading\n\n```python\n{code}\n```"


def _made_with(design: Design) -> str:
    made = ", ".join(f"{name} {version(name)}" for name in MADE_WITH)
    python = ".".join(platform.python_version_tuple()[:2])
    return (
        f"## Licence and versions\n\n{design.licence}. Made with {made}, Python {python}.\n\n"
        "The same design, versions and kind of processor give the same bytes."
    )
