"""A planned pair as files: which forms it can have, and what is in each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final, Protocol

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
from phantom.encode.content import COLOR
from phantom.encode.stereo import Pair
from phantom.errors import InvalidInputError, Problem
from phantom.imaging import Truth
from phantom.requests.stereo import StereoWish

SIDECAR: Final = "pair.json"


class PairPlan(Protocol):
    """A pair that is planned, of radiographs or in visible light."""

    @property
    def wish(self) -> StereoWish:
        """What is asked of the eyes."""

    @property
    def single(self) -> bool:
        """Whether there is one image alone."""

    @property
    def quantity(self) -> str:
        """What a pixel holds."""

    @property
    def presentation(self) -> Any:
        """How it is shown."""

    @property
    def truth(self) -> tuple[str, ...]:
        """Kinds of ground truth; none for the images alone."""

    @property
    def blind(self) -> bool:
        """Whether the files leave out what they say of themselves."""

    def check_format(self, format: Format) -> None:
        """Refuse a file format that cannot hold an image."""


def forms_of(planned: PairPlan) -> tuple[str, ...]:
    """Return the media types that one answer can have, the first where the caller does not mind.

    Two files come in an archive, and so does whatever has ground truth with it.
    """
    layout = planned.wish.layout
    if planned.truth or layout == "all" or (layout == "files" and not planned.single):
        return (ZIP_MEDIA_TYPE,)
    json = format_named("json").media_type
    if planned.single:
        single = [f.media_type for f in FORMATS if planned.quantity in f.quantities]
        return (*single, ZIP_MEDIA_TYPE)
    if layout is None:
        whole = [f.media_type for f in FORMATS if layouts_of(f)[0] != "files"]
        return (*whole, json, ZIP_MEDIA_TYPE)
    return (*(f.media_type for f in FORMATS if layout in layouts_of(f)), json)


def settle(planned: PairPlan, format: Format | None) -> Layout:
    """Return the layout in a format, or in an archive (None), before anything is traced.

    Raises
    ------
    InvalidInputError
        A layout (``/stereo/layout``), a quantity (``/quantity``) or another thing that it cannot
        hold; a format of files where there are none (``/stereo/format``).
    """
    wish = planned.wish
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
        planned.check_format(held)
    return layout


def _formats(planned: PairPlan, format: Format | None, layout: Layout) -> tuple[Format, ...]:
    """Return the formats of the files that there will be."""
    if format is not None:
        return (format,)
    if layout == "all":
        kinds = tuple(format_named(name) for name in ("png", "exr", "dicom"))
        return tuple(
            kind for kind in kinds if planned.quantity != COLOR or COLOR in kind.quantities
        )
    own = "exr" if layout == "two_view" else "png"
    return (format_named(planned.wish.format or own),)


def encoded(planned: PairPlan, pair: Pair[Any], format: Format | None) -> dict[str, Encoded]:
    """Return the files of a pair in a format, or those of its archive (None), by name."""
    layout = settle(planned, format)
    chosen = _formats(planned, format, layout)[0]
    return encode_pair(
        pair,
        planned.quantity,
        planned.presentation,
        chosen,
        layout=layout,
        blind=planned.blind,
    )


def archived(
    planned: PairPlan,
    pair: Pair[Any],
    files: Mapping[str, Encoded],
    truths: Mapping[str, Truth],
) -> bytes:
    """Return a ZIP of a pair's files, what a sidecar says of them, and each eye's ground truth."""
    inside: dict[str, Any] = {name: made.data for name, made in files.items()}
    inside[SIDECAR] = pair_sidecar(pair, files, blind=planned.blind)
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
