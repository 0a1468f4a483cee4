"""The phantom library: every phantom that an installed package offers, by name.

A package offers phantoms through the entry-point group ``phantom.library``; each entry point
names an `Entry`. The engine knows no phantom itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from pydantic import BaseModel

from phantom.document import Document, validate_model
from phantom.errors import (
    InvalidDocumentError,
    InvalidInputError,
    Problem,
    UnknownPhantomError,
    prefixed,
)

if TYPE_CHECKING:
    from phantom.scene import Phantom

GROUP = "phantom.library"

ParametersT = TypeVar("ParametersT", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class Technique:
    """How a phantom is X-rayed when a request does not say: what a radiographer would set.

    Attributes
    ----------
    energy_kev
        Energy of the monochromatic beam, where there is no ``kvp``.
    kvp, anode, filtration_mm
        Tube voltage in kV, anode and filters (material to mm); None for the latter two means what a
        beam has by default.
    source_detector_mm, object_detector_mm
        Distances from the detector to the source and to the isocentre; None for the latter means
        as near as the phantom lets it.
    polarity
        ``bones_white``, or ``bones_dark`` as in the paper.
    window
        Centre and width of the one range of line integrals that is shown, so that no lesion and no
        case shifts another's greys; None for a stretch of each image by itself, as in the paper.
    """

    energy_kev: float = 60.0
    source_detector_mm: float = 1150.0
    object_detector_mm: float | None = None
    polarity: str = "bones_white"
    window: tuple[float, float] | None = None
    kvp: float | None = None
    anode: str | None = None
    filtration_mm: Mapping[str, float] | None = None


@dataclass(frozen=True, slots=True)
class Entry(Generic[ParametersT]):
    """One phantom of the library.

    Attributes
    ----------
    name
        Its name in the library, as in ``phantom radiograph NAME``.
    title, summary
        One line, and a paragraph that says what it is made of and where that comes from.
    parameters
        A frozen pydantic model; every field has a default, a unit and a range.
    build
        Turns checked parameters into the document.
    views
        Preset views worth looking at, the best first.
    technique
        The defaults of its radiographs.
    techniques
        Those of single preset views, in place of ``technique``.
    """

    name: str
    title: str
    summary: str
    parameters: type[ParametersT]
    build: Callable[[ParametersT], Document]
    views: tuple[str, ...] = ("ap", "left_lateral")
    technique: Technique = field(default_factory=Technique)
    techniques: Mapping[str, Technique] = field(default_factory=dict)

    def technique_of(self, view: str | None) -> Technique:
        """Return the defaults of a preset view; None is a view with a source and a detector."""
        return self.techniques.get(view, self.technique) if view is not None else self.technique


@cache
def _entry_points() -> dict[str, EntryPoint]:
    return {point.name: point for point in sorted(entry_points(group=GROUP))}


def names() -> tuple[str, ...]:
    """Return the names of every installed phantom, in alphabetical order, loading none."""
    return tuple(_entry_points())


def entry(name: str) -> Entry[Any]:
    """Return the library's entry of that name.

    Raises
    ------
    UnknownPhantomError
        There is none; the problem, at ``/name``, lists the names there are.
    """
    point = _entry_points().get(name)
    if point is None:
        known = ", ".join(names())
        message = f"found {name!r}, expected one of the library's phantoms: {known}"
        raise UnknownPhantomError([Problem("/name", "unknown_phantom", message)])
    loaded = point.load()
    if not isinstance(loaded, Entry):
        raise TypeError(f"entry point {point.value!r} is not a phantom.library.Entry")
    return loaded


def document(name: str, parameters: Mapping[str, object] | None = None) -> Document:
    """Return the document that a library phantom is with these parameters.

    Raises
    ------
    UnknownPhantomError
        No phantom has that name.
    InvalidInputError
        Parameters that are unknown or out of range, with paths under ``/parameters``.
    """
    chosen = entry(name)
    try:
        checked = validate_model(chosen.parameters, dict(parameters or {}))
    except InvalidInputError as error:
        raise InvalidInputError(prefixed("/parameters", error.problems)) from None
    return chosen.build(checked)


def build(name: str, /, **parameters: object) -> Phantom:
    """Return a library phantom, ready to be X-rayed.

    Examples
    --------
    >>> build("sphere", radius_mm=30).material_names  # doctest: +SKIP
    ('bone',)
    """
    from phantom.scene import load

    tree = document(name, parameters).model_dump(mode="json")
    try:
        return load(tree)
    except InvalidDocumentError as error:
        raise InvalidInputError(
            Problem("/parameters", p.kind, f"they give a document that is refused: {p}")
            for p in error.problems
        ) from None
