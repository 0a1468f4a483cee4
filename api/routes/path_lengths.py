"""Path lengths along rays of the caller's own."""

from __future__ import annotations

import io
import json
from typing import Final

import numpy as np
from anyio.to_thread import run_sync
from fastapi import APIRouter, Request
from fastapi.responses import Response

from api.bodies import JSON, NPY, content_type, read_bytes, read_json
from api.documentation import body, reference
from api.negotiation import negotiate
from api.problems import PROBLEMS
from api.query import phantom_of
from api.service import Service
from phantom.requests.paths import (
    FloatArray,
    PathLengthsAnswer,
    PathLengthsRequest,
    trace,
    trace_npy,
)
from phantom.scene import Phantom

BLOCK: Final = 1000
"""Rows of a JSON answer that are written at a time."""


def routes(service: Service) -> APIRouter:
    """Trace rays."""
    router = APIRouter(prefix="/v1/path-lengths", tags=["path lengths"], responses=PROBLEMS)

    @router.post(
        "",
        summary="Millimetres of every material along every ray",
        description="Rays as JSON; or as NPY (N, 2, 3) float64 with `?phantom=NAME`.",
        response_model=None,
        responses={
            200: {
                "model": PathLengthsAnswer,
                "content": {NPY: {"schema": {"type": "string", "format": "binary"}}},
            }
        },
        openapi_extra=body(
            (JSON, reference(PathLengthsRequest)), (NPY, {"type": "string", "format": "binary"})
        ),
    )
    async def path_lengths(request: Request) -> Response:
        wanted = negotiate(request.headers.get("accept"), (JSON, NPY))
        if content_type(request, JSON, NPY) == NPY:
            subject = phantom_of(request.query_params)
            data = await read_bytes(request, service.settings.max_npy_bytes)
            answer = await service.workshop.run(
                request,
                lambda cancelled: trace_npy(subject, data, service.limits, cancelled),
            )
        else:
            tree = await read_json(request, service.settings.max_json_bytes)
            answer = await service.workshop.run(
                request, lambda cancelled: trace(tree, service.limits, cancelled)
            )
        content = await run_sync(_encoded, *answer, wanted)
        return Response(content, media_type=wanted, headers={"Vary": "Accept"})

    return router


def _encoded(phantom: Phantom, lengths_mm: FloatArray, wanted: str) -> bytes:
    """Return the answer as JSON or as an NPY file."""
    if wanted == NPY:
        stream = io.BytesIO()
        np.save(stream, lengths_mm, allow_pickle=False)
        return stream.getvalue()
    # Written in blocks, so that other threads get their turn in between.
    blocks = (lengths_mm[i : i + BLOCK].tolist() for i in range(0, len(lengths_mm), BLOCK))
    rows = ",".join(json.dumps(block)[1:-1] for block in blocks)
    names = json.dumps(phantom.material_names)
    return f'{{"material_names":{names},"path_lengths_mm":[{rows}]}}'.encode()
