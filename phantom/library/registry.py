"""The phantoms there are, and how one is made: name, parameters and abnormalities to a document."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any, NamedTuple

from phantom.document import Document, validate_model
from phantom.errors import (
    InvalidDocumentError,
    InvalidInputError,
    Problem,
    UnknownPhantomError,
    pointer,
    prefixed,
)
from phantom.library.entries import Abnormality, Entry
from phantom.library.folders import entry_of, files

if TYPE_CHECKING:
    from phantom.scene import Phantom

GROUP = "phantom.library"


@cache
def _entry_points() -> dict[str, EntryPoint]:
    return {point.name: point for point in sorted(entry_points(group=GROUP))}


def names() -> tuple[str, ...]:
    """Return the names of all phantoms, installed or in folders, in order, loading none."""
    return tuple(sorted({*_entry_points(), *files()}))


def entry(name: str) -> Entry[Any]:
    """Return the library's entry of that name; an installed phantom goes before a file.

    Raises
    ------
    UnknownPhantomError
        There is none; the problem, at ``/name``, lists the names there are.
    InvalidInputError
        It is a file, and no document.
    """
    point = _entry_points().get(name)
    if point is None and (path := files().get(name)) is not None:
        return entry_of(name, path)
    if point is None:
        known = ", ".join(names())
        message = f"found {name!r}, expected one of the library's phantoms: {known}"
        raise UnknownPhantomError([Problem("/name", "unknown_phantom", message)])
    loaded = point.load()
    if not isinstance(loaded, Entry):
        raise TypeError(f"entry point {point.value!r} is not a phantom.library.Entry")
    return loaded


class Line(NamedTuple):
    """One phantom in a list."""

    name: str
    title: str
    summary: str


def catalogue() -> tuple[Line, ...]:
    """Return every phantom's name, title and summary; of a file that is no document, what is wrong.

    Loads all of them.
    """
    lines = []
    for name in names():
        try:
            known = entry(name)
        except InvalidInputError as error:
            lines.append(Line(name, f"(no document: {error.problems[0]})", str(error)))
        else:
            lines.append(Line(name, known.title, known.summary))
    return tuple(lines)


def document(
    name: str,
    parameters: Mapping[str, object] | None = None,
    abnormalities: Sequence[object] = (),
) -> Document:
    """Return the document that a library phantom is with these parameters and abnormalities.

    Each abnormality is an object, as decoded from JSON, with the ``type`` it is of. Without them
    the document is the healthy twin.

    Raises
    ------
    UnknownPhantomError
        No phantom has that name.
    InvalidInputError
        Parameters that are unknown or out of range, with paths under ``/parameters``; abnormalities
        that are, or that do not fit, under ``/abnormalities``.
    """
    chosen = entry(name)
    problems: list[Problem] = []
    checked, found = None, []
    try:
        checked = validate_model(chosen.parameters, dict(parameters or {}))
    except InvalidInputError as error:
        problems += prefixed("/parameters", error.problems)
    for index, given in enumerate(abnormalities):
        try:
            found.append(_abnormality(chosen, given))
        except InvalidInputError as error:
            problems += prefixed(pointer(("abnormalities", index)), error.problems)
    if checked is None or problems:
        raise InvalidInputError(problems)
    return chosen.build(checked, tuple(found)) if chosen.abnormalities else chosen.build(checked)


def _abnormality(chosen: Entry[Any], given: object) -> Abnormality:
    """Return one abnormality, checked; paths of what is refused start at it."""
    if not isinstance(given, Mapping):
        raise InvalidInputError([Problem("", "not_an_object", "expected an object with a type")])
    known = chosen.abnormalities
    wanted = given.get("type")
    if not isinstance(wanted, str) or wanted not in known:
        expected = f"one of {', '.join(known)}" if known else f"none, for {chosen.name} has none"
        message = f"found {str(wanted)[:60]!r}; expected {expected}"
        kind = "missing" if wanted is None else "unknown_type"
        raise InvalidInputError([Problem("/type", kind, message)])
    return validate_model(known[wanted], dict(given))


def prepare(
    name: str,
    parameters: Mapping[str, object] | None = None,
    abnormalities: Sequence[object] = (),
) -> Phantom:
    """Return a library phantom, ready to be X-rayed.

    Raises
    ------
    UnknownPhantomError, InvalidInputError
        As in :func:`document`; also where the document they give is refused.
    """
    from phantom.scene import load

    tree = document(name, parameters, abnormalities).model_dump(mode="json")
    try:
        return load(tree)
    except InvalidDocumentError as error:
        raise InvalidInputError(
            Problem("/parameters", p.kind, f"they give a document that is refused: {p}")
            for p in error.problems
        ) from None


def build(name: str, /, abnormalities: Sequence[object] = (), **parameters: object) -> Phantom:
    """Return a library phantom, ready to be X-rayed; see :func:`prepare`.

    Examples
    --------
    >>> build("sphere", radius_mm=30).material_names  # doctest: +SKIP
    ('bone',)
    """
    return prepare(name, parameters, abnormalities)
