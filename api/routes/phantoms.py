"""The library: its phantoms, their parameters and their documents."""

from __future__ import annotations

from typing import Any
from urllib.parse import quote

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request
from pydantic import BaseModel

from api.bodies import JSON, read_json
from api.documentation import body
from api.problems import PROBLEMS
from api.service import Service
from phantom import library
from phantom.document import Document
from phantom.errors import InvalidInputError, Problem


class PhantomTitle(BaseModel):
    """A phantom in the list."""

    name: str
    title: str
    summary: str


class PhantomDescription(PhantomTitle):
    """A phantom, and what may be asked of it."""

    views: tuple[str, ...]
    parameters: dict[str, Any]
    abnormalities: dict[str, dict[str, Any]]
    """JSON schema of each, by its type."""
    thumbnail: str
    """Where a small radiograph of it is to be had, relative to this description."""


def routes(service: Service) -> APIRouter:
    """Describe the library's phantoms and resolve them to documents."""
    router = APIRouter(prefix="/v1/phantoms", tags=["phantoms"], responses=PROBLEMS)

    @router.get("", summary="The library")
    def phantoms() -> list[PhantomTitle]:
        return [PhantomTitle(**line._asdict()) for line in library.catalogue()]

    @router.get("/{name}", summary="One phantom and the JSON schema of its parameters")
    def phantom(name: str) -> PhantomDescription:
        entry = library.entry(name)
        return PhantomDescription(
            name=entry.name,
            title=entry.title,
            summary=entry.summary,
            views=entry.views,
            parameters=entry.parameters.model_json_schema(),
            abnormalities={
                kind: model.model_json_schema() for kind, model in entry.abnormalities.items()
            },
            thumbnail=f"../radiographs/{quote(entry.name)}?columns=256",
        )

    @router.post(
        "/{name}/document",
        summary="The document that a phantom is with these parameters",
        response_model=Document,
        response_model_exclude_none=True,
        openapi_extra=body((JSON, {"type": "object"})),
    )
    async def document(name: str, request: Request) -> Document:
        library.entry(name)
        parameters = await read_json(request, service.settings.max_json_bytes)
        return await run_sync(_document, name, parameters)

    return router


def _document(name: str, parameters: object) -> Document:
    """Return the document; the body is the parameters, so paths start there."""
    if not isinstance(parameters, dict):
        raise InvalidInputError(
            [Problem("", "not_an_object", "expected an object with the phantom's parameters")]
        )
    try:
        return library.document(name, parameters)
    except InvalidInputError as error:
        moved = ((p.path.removeprefix("/parameters"), p) for p in error.problems)
        raise InvalidInputError(Problem(path, p.kind, p.message) for path, p in moved) from None
