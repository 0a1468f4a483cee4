"""A planned pair as files: which forms it can have, and what is in each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final

from phantom.encode import (
    FORMATS,
    LAYOUTS,
    ZIP_MEDIA_TYPE,
    Encoded,
    Format,
    Layout,
    archive,
    check_layout,
    encode_pair,
    format_named,
    layouts_of,
    pair_sidecar,
    truth_files,
)
from phantom.errors import InvalidInputError, Problem
from phantom.imaging import StereoPair, Truth
from phantom.requests.stereo import StereoPlan

SIDECAR: Final = "pair.json"


def forms_of(planned: StereoPlan) -> tuple[str, ...]:
    """Return the media types that one answer can have, the first where the caller does not mind.

    Two files come in an archive, and so does whatever has ground truth with it.
    """
    layout = planned.wish.layout
    if planned.mono.truth or layout == "all" or (layout == "files" and not planned.single):
        return (ZIP_MEDIA_TYPE,)
    json = format_named("json").media_type
    if planned.single:
        single = [known.media_type for known in FORMATS]
        return (*single, ZIP_MEDIA_TYPE)
    if layout is None:
        whole = [f.media_type for f in FORMATS if layouts_of(f)[0] != "files"]
        return (*whole, json, ZIP_MEDIA_TYPE)
    return (*(f.media_type for f in FORMATS if layout in layouts_of(f)), json)


def settle(planned: StereoPlan, format: Format | None) -> Layout:
    """Return the layout in a format, or in an archive (None), before anything is traced.

    Raises
    ------
    InvalidInputError
        A layout (``/stereo/layout``), a quantity (``/quantity``) or another thing that it cannot
        hold; a format of files where there are none (``/stereo/format``).
    """
    wish, mono = planned.wish, planned.mono
    if format is not None and format.name == "json":
        return wish.layout or "files"
    possible = LAYOUTS if format is None else layouts_of(format)
    usual: Layout = "all" if format is None else "files" if planned.single else possible[0]
    layout = wish.layout or usual
    place = "an archive" if format is None else format.name
    check_layout(layout, possible, place, single=planned.single)
    if wish.format is not None and (format is not None or layout != "files"):
        message = f"found {wish.format!r}; expected it only for files in an archive"
        raise InvalidInputError([Problem("/stereo/format", "no_effect", message)])
    for held in _formats(planned, format, layout):
        mono.check_format(held)
    return layout


def _formats(planned: StereoPlan, format: Format | None, layout: Layout) -> tuple[Format, ...]:
    """Return the formats of the files that there will be."""
    if format is not None:
        return (format,)
    if layout == "all":
        return (format_named("png"), format_named("exr"), format_named("dicom"))
    own = "exr" if layout == "two_view" else "png"
    return (format_named(planned.wish.format or own),)


def encoded(planned: StereoPlan, pair: StereoPair, format: Format | None) -> dict[str, Encoded]:
    """Return the files of a pair in a format, or those of its archive (None), by name."""
    layout, mono = settle(planned, format), planned.mono
    chosen = _formats(planned, format, layout)[0]
    return encode_pair(
        pair, mono.quantity, mono.presentation, chosen, layout=layout, blind=mono.blind
    )


def archived(
    planned: StereoPlan,
    pair: StereoPair,
    files: Mapping[str, Encoded],
    truths: Mapping[str, Truth],
) -> bytes:
    """Return a ZIP of a pair's files, what a sidecar says of them, and each eye's ground truth."""
    inside: dict[str, Any] = {name: made.data for name, made in files.items()}
    inside[SIDECAR] = pair_sidecar(pair, files, blind=planned.mono.blind)
    return archive({**inside, **truths_files(truths, files)})


def truths_files(truths: Mapping[str, Truth], files: Iterable[str]) -> dict[str, bytes]:
    """Return the files of each eye's ground truth, in a folder of the eye's name.

    Parameters
    ----------
    truths
        By eye.
    files
        Names of the pair's files, of which the first of an eye is what its masks belong to.
    """
    names, found = list(files), dict[str, bytes]()
    for eye, truth in truths.items():
        image = next((name for name in names if name.startswith(f"{eye}.")), f"{eye}.png")
        for name, data in truth_files(truth, f"../{image}").items():
            found[f"{eye}/{name}"] = data
    return found
