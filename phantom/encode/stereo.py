"""A pair as files: one for each eye, both in one picture, as two views, or all of that.

What is shown to a person comes as one picture: side by side (the left eye's at the left, for a
viewer with lenses or a screen of its own for each eye), cross-eyed (the other way round), or as an
anaglyph (the left eye's in red, the right one's in green and blue, for red and cyan glasses; of
colours each its own channels).
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, Protocol, TypeVar, get_args

import numpy as np
from numpy.typing import NDArray

from phantom.encode.content import IMAGES, Content, Wanted, everything
from phantom.encode.dicom import stereometric
from phantom.encode.encoding import Encoded, check_held, encode
from phantom.encode.exr import exr_views
from phantom.encode.formats import FORMATS, Format, format_named
from phantom.encode.picture import Picture
from phantom.encode.sidecar import sidecar
from phantom.errors import InvalidInputError, Problem

Layout = Literal["files", "side_by_side", "cross_eyed", "anaglyph", "two_view", "all"]

LAYOUTS: Final[tuple[Layout, ...]] = get_args(Layout)

IN_ONE: Final[tuple[Layout, ...]] = ("side_by_side", "cross_eyed", "anaglyph")
"""The layouts that are one picture."""

OF_PICTURES: Final = frozenset({"png", "tiff", "jpeg"})
"""Formats of grey levels, or colours, that hold both eyes' in one picture."""

MEDIA_DICOM: Final = "application/dicom"

PresentationT = TypeVar("PresentationT")
PresentationT_contra = TypeVar("PresentationT_contra", contravariant=True)


class Pair(Protocol[PresentationT_contra]):
    """A pair as an encoder sees it; ``phantom.imaging.StereoPair`` is one."""

    @property
    def pictures(self) -> Mapping[str, Picture[PresentationT_contra]]:
        """``left`` and ``right``, or one."""

    def metadata(self) -> dict[str, Any]:
        """Return plain JSON values; ``stereo`` among them."""


@dataclass(frozen=True)
class InOne:
    """Both eyes' images as one picture."""

    pair: Pair[Any]
    layout: Layout

    @property
    def _eyes(self) -> tuple[Picture[Any], Picture[Any]]:
        return self.pair.pictures["left"], self.pair.pictures["right"]

    def quantity(self, name: str) -> NDArray[np.float64]:
        """Return the values, as the layout puts them."""
        return self._put([eye.quantity(name) for eye in self._eyes])

    def presented(self, name: str, presentation: Any) -> NDArray[Any]:
        """Return the grey levels, or the colours of an anaglyph."""
        return self._put([eye.presented(name, presentation) for eye in self._eyes])

    def shown(self, name: str, presentation: Any) -> dict[str, Any]:
        """Return what the presentation came to; the left eye's where each has its own."""
        return self._eyes[0].shown(name, presentation)

    def metadata(self) -> dict[str, Any]:
        """Return what is known of the pair, and how it is laid out."""
        return {**self.pair.metadata(), "layout": self.layout}

    def _put(self, images: list[NDArray[Any]]) -> NDArray[Any]:
        left, right = images
        if self.layout == "anaglyph" and left.ndim == 3:
            return np.concatenate([left[..., :1], right[..., 1:]], axis=-1)
        if self.layout == "anaglyph":
            return np.stack([left, right, right], axis=-1)
        order = (left, right) if self.layout == "side_by_side" else (right, left)
        return np.concatenate(order, axis=1)


@dataclass(frozen=True)
class _Member:
    """An eye's picture that says what all of its pair are made of, for their identifiers."""

    picture: Picture[Any]
    pixels_sha256: str

    def quantity(self, name: str) -> NDArray[np.float64]:
        return self.picture.quantity(name)

    def presented(self, name: str, presentation: Any) -> NDArray[Any]:
        return self.picture.presented(name, presentation)

    def shown(self, name: str, presentation: Any) -> dict[str, Any]:
        return self.picture.shown(name, presentation)

    def metadata(self) -> dict[str, Any]:
        told = self.picture.metadata()
        return {**told, "stereo": {**told["stereo"], "pixels_sha256": self.pixels_sha256}}


def layouts_of(format: Format) -> tuple[Layout, ...]:
    """Return the layouts that a format can hold, the default first."""
    if format.name in OF_PICTURES:
        return (*IN_ONE, "files")
    return ("two_view", "files") if format.name == "exr" else ("files",)


def check_layout(layout: Layout, possible: tuple[Layout, ...], place: str, *, single: bool) -> None:
    """Refuse a layout that cannot be (``/stereo/layout``).

    Parameters
    ----------
    layout
        What is asked.
    possible
        What the format, or an archive, holds.
    place
        The name of that, for the message.
    single
        Whether there is one image alone, which makes no picture of both.
    """
    if layout not in possible:
        message = f"found {layout!r}, but {place} holds one of {', '.join(possible)}"
        raise InvalidInputError([Problem("/stereo/layout", "not_in_format", message)])
    if single and layout in (*IN_ONE, "two_view"):
        message = f"found {layout!r} of a single image; expected files or all"
        raise InvalidInputError([Problem("/stereo/layout", "contradiction", message)])


def encode_pair(
    pair: Pair[PresentationT],
    quantity: str = "signal",
    presentation: PresentationT | None = None,
    format: Format | str = FORMATS[0],
    *,
    layout: Layout | None = None,
    blind: bool = False,
) -> dict[str, Encoded]:
    """Return a pair as the contents of files, by name.

    Parameters
    ----------
    pair
        Such as a ``phantom.imaging.StereoPair`` or a ``phantom.visible.PicturePair``.
    quantity, presentation, format, blind
        As in :func:`phantom.encode.encode`. Each file of ``files`` has this format; of DICOM there
        is a third, ``stereo.dcm``, that says which image is which eye's.
    layout
        One of :data:`LAYOUTS`; by default the first that the format can hold. ``all`` has every
        layout, in PNG, OpenEXR and, of radiographs, DICOM, and goes into an archive.

    Raises
    ------
    InvalidInputError
        A format that cannot hold the quantity (``/quantity``) or the layout (``/stereo/layout``).
    """
    chosen = format_named(format) if isinstance(format, str) else format
    single = len(pair.pictures) == 1
    if chosen.name == "json":
        return {"pair.json": _told(pair, blind=blind)}
    held = layouts_of(chosen)
    if layout is None:
        layout = "files" if single else held[0]
    check_layout(layout, (*held, "all"), chosen.name, single=single)
    if layout == "all":
        return _everything(pair, quantity, presentation, single=single, blind=blind)
    if layout == "files":
        return _files(pair, quantity, presentation, chosen, blind=blind)
    if layout == "two_view":
        return {"pair.exr": _views(pair, quantity, blind=blind)}
    name = f"{layout.replace('_', '-')}{chosen.extensions[0]}"
    return {name: encode(InOne(pair, layout), quantity, presentation, chosen, blind=blind)}


def pair_sidecar(pair: Pair[Any], files: Mapping[str, Encoded], *, blind: bool) -> bytes:
    """Return what a sidecar says of a pair and its files; of blind ones only how to read them."""
    named = {name: dict(made.beside)["file"] for name, made in files.items()}
    return sidecar({**({} if blind else pair.metadata()), "files": named})


def _told(pair: Pair[Any], *, blind: bool) -> Encoded:
    beside: dict[str, Any] = {} if blind else pair.metadata()
    beside["file"] = {"format": "json", "holds": "metadata"}
    return Encoded(sidecar(beside), format_named("json").media_type, beside)


def _everything(
    pair: Pair[PresentationT],
    quantity: str,
    presentation: PresentationT | None,
    *,
    single: bool,
    blind: bool,
) -> dict[str, Encoded]:
    def made(format: str, layout: Layout) -> dict[str, Encoded]:
        return encode_pair(pair, quantity, presentation, format, layout=layout, blind=blind)

    png, dicom = format_named("png"), format_named("dicom")
    check_held(png, quantity)
    found = made("png", "files")
    if not single:
        for layout in IN_ONE:
            found |= made("png", layout)
    found |= made("exr", "files" if single else "two_view")
    if quantity not in dicom.quantities:
        return found
    return found | _files(pair, quantity, presentation, dicom, blind=blind)


def _files(
    pair: Pair[PresentationT],
    quantity: str,
    presentation: PresentationT | None,
    format: Format,
    *,
    blind: bool,
) -> dict[str, Encoded]:
    is_dicom = format.media_type.startswith(MEDIA_DICOM)
    pictures = dict(pair.pictures)
    if is_dicom and blind and quantity in IMAGES:
        pixels = hashlib.sha256()
        for picture in pictures.values():
            pixels.update(np.ascontiguousarray(picture.quantity(quantity)).tobytes())
        pictures = {eye: _Member(p, pixels.hexdigest()) for eye, p in pictures.items()}
    ending = format.extensions[0]
    found = {
        f"{eye}{ending}": encode(picture, quantity, presentation, format, blind=blind)
        for eye, picture in pictures.items()
    }
    if is_dicom and len(found) > 1:
        left, right = (made.data for made in found.values())
        geometry = {} if blind else pair.metadata()["stereo"]
        holds = {"format": format.name, "holds": "which image is which eye's"}
        data = stereometric(left, right, geometry)
        found[f"stereo{ending}"] = Encoded(data, format.media_type, {"file": holds})
    return found


def _views(pair: Pair[Any], quantity: str, *, blind: bool) -> Encoded:
    """Return the two-view OpenEXR: every quantity of both eyes."""
    wanted = Wanted(quantity, None, blind)
    views: dict[str, dict[str, NDArray[Any]]] = {}
    file: dict[str, Any] = {}
    for eye, picture in pair.pictures.items():
        views[eye], file = everything(picture, wanted)
    said = {"format": "exr", **file, "views": list(views)}
    content = Content({}, said, pair.metadata(), blind)
    media_type = format_named("exr").media_type
    return Encoded(exr_views(views, content.told), media_type, content.beside)
