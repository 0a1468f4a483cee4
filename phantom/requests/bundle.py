"""A radiograph with its ground truth, as files that belong together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from phantom.encode import Encoded, archive, encode, format_named, sidecar, truth_files
from phantom.encode.content import IMAGES

if TYPE_CHECKING:
    from phantom.encode import Format
    from phantom.imaging import Radiograph, Truth
    from phantom.requests.radiograph import RadiographPlan


def picture_format(planned: RadiographPlan) -> Format:
    """Return the format of the picture in an archive: PNG, or NPY for what is no image."""
    return format_named("png" if planned.quantity in IMAGES else "npy")


def bundle(planned: RadiographPlan, made: Radiograph, truth: Truth) -> tuple[bytes, Encoded]:
    """Return a ZIP of the picture, what a sidecar says of it and its ground truth; the picture too.

    The picture is ``image.png`` (``image.npy`` for path lengths) and its sidecar ``image.json``.
    """
    chosen = picture_format(planned)
    encoded = encode(made, planned.quantity, planned.presentation, chosen, blind=planned.blind)
    name = f"image{chosen.extensions[0]}"
    files: Mapping[str, Any] = {
        name: encoded.data,
        "image.json": sidecar(encoded.beside),
        **truth_files(truth, name),
    }
    return archive(files), encoded
