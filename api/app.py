"""The service, put together; every part is elsewhere."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from anyio.to_thread import run_sync
from fastapi import FastAPI

import phantom
from api import documentation, problems
from api.routes import documents, health, path_lengths, phantoms, radiographs, renders, stereo_pairs
from api.security import KeyRequired, SafeHeaders
from api.service import Service
from api.settings import Settings
from phantom.document import Document
from phantom.requests.paths import PathLengthsRequest
from phantom.requests.radiograph import RadiographRequest
from phantom.requests.render import RenderRequest
from phantom.requests.stereo import StereoRequest
from phantom.tracing import warm

BODIES = (
    problems.ProblemDetails,
    Document,
    RadiographRequest,
    StereoRequest,
    RenderRequest,
    PathLengthsRequest,
)


@asynccontextmanager
async def _warm(_: FastAPI) -> AsyncIterator[None]:
    """Have the kernels ready before the first call."""
    await run_sync(warm)
    yield


def create_app(settings: Settings | None = None) -> FastAPI:
    """Return the application; without settings those of the environment hold."""
    settings = Settings.from_environment(os.environ) if settings is None else settings
    app = FastAPI(
        title="phantom",
        version=phantom.__version__,
        description="Exact X-ray images of phantoms. Lengths are millimetres, energies keV.",
        docs_url=None,
        redoc_url=None,
        lifespan=_warm,
    )
    service = Service.of(settings)
    for part in (phantoms, radiographs, stereo_pairs, renders, path_lengths, documents):
        app.include_router(part.routes(service))
    app.include_router(health.routes())
    app.include_router(documentation.routes())
    documentation.install(app, BODIES, with_key=settings.api_key is not None)
    problems.install(app)
    if settings.api_key is not None:
        app.add_middleware(KeyRequired, key=settings.api_key)
    app.add_middleware(SafeHeaders)
    return app
