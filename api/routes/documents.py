"""Documents: whether one is sound, and what it amounts to."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import APIRouter, Request

from api.bodies import JSON, read_json
from api.documentation import body, reference
from api.problems import PROBLEMS
from api.service import Service
from phantom import scene
from phantom.document import Document, parse
from phantom.requests.summary import DocumentSummary, summarise


def routes(service: Service) -> APIRouter:
    """Check and measure documents."""
    router = APIRouter(prefix="/v1/documents", tags=["documents"], responses=PROBLEMS)

    @router.post(
        "/validate",
        summary="Every problem of a document, or its leaves, bounds, volume and mass",
        openapi_extra=body((JSON, reference(Document))),
    )
    async def validate(request: Request) -> DocumentSummary:
        tree = await read_json(request, service.settings.max_json_bytes)
        return await service.workshop.run(request, lambda cancelled: _summary(tree, cancelled))

    return router


def _summary(tree: object, cancelled: Callable[[], bool]) -> DocumentSummary:
    return summarise(scene.load(tree if isinstance(tree, dict) else parse(tree)), cancelled)
