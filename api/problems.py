"""Errors as ``application/problem+json`` (RFC 9457): one table says which status each one gets."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterable, Mapping
from http import HTTPStatus
from typing import Any, Final

from fastapi import FastAPI, Request
from fastapi.responses import Response
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from phantom.errors import (
    CancelledError,
    InvalidInputError,
    PhantomError,
    Problem,
    UnknownPhantomError,
)

logger = logging.getLogger("phantom.api")

MEDIA_TYPE = "application/problem+json"

STATUS: dict[type[Exception], int] = {
    UnknownPhantomError: HTTPStatus.NOT_FOUND,
    InvalidInputError: HTTPStatus.UNPROCESSABLE_ENTITY,
    CancelledError: HTTPStatus.SERVICE_UNAVAILABLE,
    ClientDisconnect: HTTPStatus.BAD_REQUEST,
    Exception: HTTPStatus.INTERNAL_SERVER_ERROR,
}
"""The status of every error the engine raises; the nearest base class counts."""


class RefusedError(PhantomError):
    """A call that is refused for how it was made, before its content is looked at."""

    def __init__(
        self, status: HTTPStatus, detail: str, headers: Mapping[str, str] | None = None
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.detail = detail
        self.headers = dict(headers or {})


class ProblemItem(BaseModel):
    """One thing wrong with the input."""

    path: str = Field(description="JSON pointer of the field, as in the request")
    kind: str = Field(description="a short stable word for programs")
    message: str = Field(description="what was found and what was expected")


class ProblemDetails(BaseModel):
    """An error (RFC 9457); `problems` lists every fault found, as the command line does."""

    type: str = "about:blank"
    title: str
    status: int
    detail: str
    problems: list[ProblemItem] = []


PROBLEMS: Final[dict[int | str, dict[str, Any]]] = {
    "default": {
        "description": "Every problem found",
        "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/ProblemDetails"}}},
    }
}
"""How every call describes its errors in OpenAPI."""


def problem_response(
    status: int,
    detail: str,
    problems: Iterable[Problem] = (),
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return the problem document; its text is ASCII, so lone surrogates stay escaped."""
    listed = [{"path": p.path, "kind": p.kind, "message": p.message} for p in problems]
    content = {
        "type": "about:blank",
        "title": HTTPStatus(status).phrase,
        "status": int(status),
        "detail": detail,
        "problems": listed,
    }
    return Response(
        json.dumps(content),
        status_code=status,
        media_type=MEDIA_TYPE,
        headers={"Cache-Control": "no-store", **(headers or {})},
    )


def _status(error: Exception) -> int:
    return next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)


async def _invalid(_: Request, error: Exception) -> Response:
    assert isinstance(error, InvalidInputError)
    count = len(error.problems)
    detail = error.problems[0].message if count == 1 else f"{count} problems were found"
    return problem_response(_status(error), detail, error.problems)


async def _refused(_: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)
    return problem_response(error.status, error.detail, headers=error.headers)


async def _http(_: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return problem_response(error.status_code, str(error.detail), headers=error.headers)


async def _gone(_: Request, error: Exception) -> Response:
    return problem_response(_status(error), "the client went away before the answer was ready")


async def _fault(request: Request, error: Exception) -> Response:
    logger.error("%s %s failed", request.method, request.url.path, exc_info=error)
    return problem_response(_status(error), "a fault of ours; it has been logged")


def install(app: FastAPI) -> None:
    """Make every error of the application a problem document."""
    app.add_exception_handler(InvalidInputError, _invalid)
    app.add_exception_handler(RefusedError, _refused)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(CancelledError, _gone)
    app.add_exception_handler(ClientDisconnect, _gone)
    app.add_exception_handler(Exception, _fault)
