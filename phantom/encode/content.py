"""What goes into a file: the arrays that a format takes from a result, and what is said of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from numpy.typing import NDArray

from phantom.encode.coding import coding
from phantom.encode.exr import layer_names
from phantom.encode.picture import Picture

IMAGES: Final = ("signal", "transmission", "line_integral")
"""The quantities with one value a pixel, in the order of an OpenEXR's layers."""

COLOR: Final = "color"
"""The quantity of a picture in visible light: red, green and blue."""

CHANNELS: Final = ("R", "G", "B")
"""The layers of a colour in an OpenEXR, as programs expect them."""


@dataclass(frozen=True, slots=True)
class Content:
    """What a writer gets.

    Attributes
    ----------
    layers
        Name to (rows, columns) or (rows, columns, M) array; one for most formats.
    file
        What the file holds, as plain JSON values: quantity, coding, names of layers.
    metadata
        Of the result. A writer takes from it what its format cannot do without; what it says
        beside that is :attr:`told`.
    blind
        True where the file must not say what it shows.
    """

    layers: Mapping[str, NDArray[Any]]
    file: Mapping[str, Any]
    metadata: Mapping[str, Any]
    blind: bool

    @property
    def only(self) -> NDArray[Any]:
        """The array of a format that has one."""
        (array,) = self.layers.values()
        return array

    @property
    def told(self) -> dict[str, Any]:
        """What the file says of itself; nothing where it is blind."""
        return {} if self.blind else {**self.metadata, "file": dict(self.file)}

    @property
    def beside(self) -> dict[str, Any]:
        """What a sidecar says; of a blind file only how to read its numbers."""
        return {"file": dict(self.file)} if self.blind else self.told


class Wanted(NamedTuple):
    """What is asked of a result.

    Attributes
    ----------
    quantity
        Its name.
    presentation
        How it becomes grey levels.
    blind
        True where the file must not say what it shows.
    """

    quantity: str
    presentation: Any
    blind: bool


Taken = tuple[dict[str, NDArray[Any]], dict[str, Any]]
"""Layers by name, and what is said of them."""

Take = Callable[[Picture[Any], Wanted], Taken]


def grey(picture: Picture[Any], wanted: Wanted) -> Taken:
    """Take the grey levels of a quantity."""
    levels = picture.presented(wanted.quantity, wanted.presentation)
    said: dict[str, Any] = {"holds": "grey levels", "quantity": wanted.quantity}
    said["bits"] = 8 * levels.dtype.itemsize
    said["presentation"] = picture.shown(wanted.quantity, wanted.presentation)
    return {wanted.quantity: levels}, said


def numbers(picture: Picture[Any], wanted: Wanted) -> Taken:
    """Take a quantity as it is."""
    quantity = wanted.quantity
    return {quantity: picture.quantity(quantity)}, {"holds": "numbers", "quantity": quantity}


def codes(picture: Picture[Any], wanted: Wanted) -> Taken:
    """Take a quantity as codes of 16 bits."""
    values = picture.quantity(wanted.quantity)
    unit = picture.metadata().get("units", {}).get(wanted.quantity, "1")
    chosen = coding(wanted.quantity, values, unit)
    return {wanted.quantity: chosen.codes(values)}, {"holds": "codes", **chosen.told()}


def everything(picture: Picture[Any], wanted: Wanted) -> Taken:
    """Take every quantity: a layer each, and one for the thickness of each material.

    Materials tell what there is to find; so a blind file has none of their layers.
    """
    if wanted.quantity == COLOR:
        values = picture.quantity(COLOR)
        colors = {name: values[..., i] for i, name in enumerate(CHANNELS)}
        return colors, {"holds": "numbers", "quantity": COLOR, "layers": list(colors)}
    layers: dict[str, NDArray[Any]] = {name: picture.quantity(name) for name in IMAGES}
    said: dict[str, Any] = {"holds": "numbers", "layers": list(layers)}
    if wanted.blind:
        return layers, said
    thickness = picture.quantity("path_lengths")
    materials = picture.metadata()["phantom"]["material_names"]
    thicknesses = layer_names("thickness", materials)
    for index, name in enumerate(thicknesses):
        layers[name] = thickness[..., index]
    of_materials = dict(zip(thicknesses, materials, strict=True))
    return layers, {**said, "layers": list(layers), "materials": of_materials}


def nothing(picture: Picture[Any], wanted: Wanted) -> Taken:
    """Take no pixels."""
    return {}, {"holds": "metadata"}
