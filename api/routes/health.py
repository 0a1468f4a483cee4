"""Whether the service is alive."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel

import phantom


class Health(BaseModel):
    """The service answers."""

    status: str = "ok"
    version: str


def routes() -> APIRouter:
    """Answer as long as the event loop turns."""
    router = APIRouter(tags=["service"])

    @router.get("/healthz", summary="Whether the service is alive")
    async def healthz() -> Health:
        return Health(version=phantom.__version__)

    return router
