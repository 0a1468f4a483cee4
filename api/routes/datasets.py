"""Data sets: a design is taken for a job."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any, Final

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse, Response

from api.bodies import JSON, read_json
from api.documentation import body, reference
from api.problems import PROBLEMS, RefusedError
from api.routes.jobs import told
from api.service import Service
from phantom.datasets import Design

LONGEST_KEY: Final = 255

ACCEPTED: Final[dict[int | str, dict[str, Any]]] = {
    202: {
        "description": "The job, new or known by its key",
        "headers": {"Location": {"schema": {"type": "string"}, "description": "The job"}},
        "content": {JSON: {"schema": {"$ref": "#/components/schemas/JobStatus"}}},
    }
}

KEY: Final = {
    "name": "Idempotency-Key",
    "in": "header",
    "required": False,
    "description": "Posted again with the same key and body, the same job is meant.",
    "schema": {"type": "string", "maxLength": LONGEST_KEY, "pattern": "^[!-~]+$"},
}


def routes(service: Service) -> APIRouter:
    """Take designs."""
    router = APIRouter(prefix="/v1/datasets", tags=["data sets"], responses=PROBLEMS)

    @router.post(
        "",
        summary="Make a data set",
        status_code=HTTPStatus.ACCEPTED,
        response_class=Response,
        responses=ACCEPTED,
        openapi_extra={**body((JSON, reference(Design))), "parameters": [KEY]},
    )
    async def post(request: Request) -> Response:
        key = request.headers.get("idempotency-key")
        printable = key is None or all("!" <= letter <= "~" for letter in key)
        if key is not None and not (printable and 1 <= len(key) <= LONGEST_KEY):
            detail = f"the Idempotency-Key is no 1 to {LONGEST_KEY} printable letters of ASCII"
            raise RefusedError(HTTPStatus.UNPROCESSABLE_ENTITY, detail)
        tree = await read_json(request, service.settings.max_json_bytes)
        job, _ = await run_sync(service.jobs.submit, tree, key)
        return JSONResponse(
            told(job).model_dump(mode="json"),
            status_code=HTTPStatus.ACCEPTED,
            headers={"Location": f"{request.scope.get('root_path', '')}/v1/jobs/{job.id}"},
        )

    return router
