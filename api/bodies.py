"""Reading a request's body: never more of it than the limit, never on the event loop."""

from __future__ import annotations

from http import HTTPStatus

from anyio.to_thread import run_sync
from fastapi import Request

from api.problems import RefusedError
from phantom.document import decode_json

JSON = "application/json"
NPY = "application/x-npy"


def content_type(request: Request, *expected: str) -> str:
    """Return which of the expected media types the body has; the first where it does not say."""
    encoding = request.headers.get("content-encoding", "identity").strip().lower()
    if encoding not in ("", "identity"):
        detail = (
            f"found Content-Encoding: {encoding[:50]!r}, expected a body that is not compressed"
        )
        raise RefusedError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE, detail, {"Accept-Encoding": "identity"}
        )
    given = request.headers.get("content-type", expected[0]).split(";")[0].strip().lower()
    if given not in expected:
        detail = f"found Content-Type: {given[:100]!r}, expected {' or '.join(expected)}"
        raise RefusedError(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, detail)
    return given


def _too_large(limit: int) -> RefusedError:
    detail = f"the body is longer than the {limit} bytes that are read"
    return RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, detail, {"Connection": "close"})


async def read_bytes(request: Request, limit: int) -> bytes:
    """Return the body, refused with 413 as soon as it is known to be longer than the limit."""
    declared = request.headers.get("content-length", "0")
    if not declared.isascii() or not declared.isdigit():
        raise RefusedError(HTTPStatus.BAD_REQUEST, "Content-Length is not a number")
    if len(declared) > 18 or int(declared) > limit:
        raise _too_large(limit)
    read = bytearray()
    async for chunk in request.stream():
        if len(read) + len(chunk) > limit:
            raise _too_large(limit)
        read += chunk
    return bytes(read)


async def read_json(request: Request, limit: int) -> object:
    """Return the decoded JSON body, read in a worker thread so that other calls are not held up."""
    content_type(request, JSON)
    data = await read_bytes(request, limit)
    return await run_sync(decode_json, data)
