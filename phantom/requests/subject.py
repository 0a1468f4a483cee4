"""What is X-rayed: a phantom of the library, or a document that comes with the request."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from pydantic import BaseModel, Field, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from phantom import library
from phantom.document import Document
from phantom.document.base import Choice, Model, Name, told
from phantom.document.tree import mapping
from phantom.document.validation import judge
from phantom.document.words import arranged
from phantom.errors import InvalidInputError, Problem, prefixed

if TYPE_CHECKING:
    from phantom.scene import Phantom

ModelT = TypeVar("ModelT", bound=BaseModel)


class _DocumentSchema:
    """Shows a document's schema where the document itself is checked later, as a whole."""

    @classmethod
    def __get_pydantic_json_schema__(
        cls, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return handler(Document.__pydantic_core_schema__)


class LibraryPhantom(Model):
    """A phantom of the library."""

    name: Annotated[Name, told("Name", "none", "A phantom of the library.")]
    parameters: Annotated[
        dict[str, Any], told("Parameters", "none", "What it is built from; each has a default.")
    ] = Field(default_factory=dict)
    abnormalities: Annotated[
        tuple[dict[str, Any], ...],
        told("Abnormalities", "none", "What is wrong with it, each with its type."),
    ] = ()


class OwnPhantom(Model):
    """A phantom that the caller describes."""

    document: Annotated[
        dict[str, Any],
        _DocumentSchema,
        told("Document", "none", "A phantom document, format phantom/1."),
    ]


def _kind(value: Any) -> str | None:
    if isinstance(value, Mapping):
        return "own" if "document" in value else "library"
    return {"OwnPhantom": "own", "LibraryPhantom": "library"}.get(type(value).__name__)


Subject = Annotated[
    LibraryPhantom | OwnPhantom,
    Choice(
        _kind,
        ("library", "own"),
        "wrong_shape",
        "an object with the name of a library phantom, or with a document",
    ),
]
"""Either of them, told apart by the field ``document``."""


def read_request(
    model_class: type[ModelT], tree: object, known: Iterable[Problem] = ()
) -> tuple[ModelT, Phantom]:
    """Return a request, as decoded from JSON, and the phantom that its field ``phantom`` means.

    Problems already ``known`` are listed among those that are found.

    Raises
    ------
    InvalidInputError
        Every problem of the request and of the phantom in it, each with the path of its field.
    """
    loaded: list[Phantom] = []

    def of_the_phantom(tree: object) -> tuple[Problem, ...]:
        try:
            loaded.extend(_load(mapping(mapping(tree).get("phantom"))))
        except InvalidInputError as error:
            return prefixed("/phantom", error.problems)
        return ()

    request, problems = judge(model_class, tree, of_the_phantom)
    problems += known
    if request is None or problems:
        raise InvalidInputError(arranged(problems))
    return request, loaded[0]


def _load(subject: Mapping[str, Any]) -> Iterator[Phantom]:
    """Yield the phantom; none where the subject is misshapen, which its model tells."""
    from phantom import scene

    document, name = subject.get("document"), subject.get("name")
    given = subject.get("parameters", {})
    wrong = subject.get("abnormalities", ())
    shaped = isinstance(given, Mapping) and isinstance(wrong, list | tuple)
    if isinstance(document, Mapping):
        try:
            yield scene.load(document)
        except InvalidInputError as error:
            raise InvalidInputError(prefixed("/document", error.problems)) from None
    elif isinstance(name, str) and shaped and "document" not in subject:
        yield library.prepare(name, given, wrong)
