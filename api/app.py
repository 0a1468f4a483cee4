"""The service, put together; every part is elsewhere."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager

from anyio.to_thread import run_sync
from fastapi import FastAPI

import phantom
from api import documentation, problems
from api.routes import (
    datasets,
    documents,
    health,
    jobs,
    path_lengths,
    phantoms,
    radiographs,
    renders,
    stereo_pairs,
)
from api.security import KeyRequired, SafeHeaders
from api.service import Service
from api.settings import Settings
from phantom.datasets import Design
from phantom.document import Document
from phantom.requests.draw import DrawRequest
from phantom.requests.paths import PathLengthsRequest
from phantom.requests.radiograph import RadiographRequest
from phantom.requests.render_pair import RenderPairRequest
from phantom.requests.stereo import StereoRequest
from phantom.tracing import warm

BODIES = (
    problems.ProblemDetails,
    Document,
    RadiographRequest,
    StereoRequest,
    DrawRequest,
    RenderPairRequest,
    PathLengthsRequest,
    Design,
)

PARTS = (
    phantoms,
    radiographs,
    stereo_pairs,
    renders,
    datasets,
    jobs,
    path_lengths,
    documents,
)


def _life(service: Service) -> Callable[[FastAPI], AbstractAsyncContextManager[None]]:
    """Have the kernels ready before the first call, and work at jobs until the last."""

    @asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        await run_sync(warm)
        service.jobs.start()
        try:
            yield
        finally:
            await run_sync(service.jobs.stop)

    return life


def create_app(settings: Settings | None = None) -> FastAPI:
    """Return the application; without settings those of the environment hold."""
    settings = Settings.from_environment(os.environ) if settings is None else settings
    service = Service.of(settings)
    app = FastAPI(
        title="phantom",
        version=phantom.__version__,
        description="Exact X-ray images of phantoms. Lengths are millimetres, energies keV.",
        docs_url=None,
        redoc_url=None,
        lifespan=_life(service),
    )
    for part in PARTS:
        app.include_router(part.routes(service))
    app.include_router(health.routes())
    app.include_router(documentation.routes())
    documentation.install(app, BODIES, with_key=settings.api_key is not None)
    problems.install(app)
    if settings.api_key is not None:
        app.add_middleware(KeyRequired, key=settings.api_key)
    app.add_middleware(SafeHeaders)
    return app
