"""The key a caller must show, and the headers that every answer carries."""

from __future__ import annotations

import hmac
from http import HTTPStatus

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from api.problems import problem_response

OPEN_PATHS = ("/healthz", "/openapi.json", "/docs")
"""Paths that need no key: they say nothing of what the service is used for."""


def _is_open(path: str) -> bool:
    return any(path == known or path.startswith(known + "/") for known in OPEN_PATHS)


def _shown_key(headers: Headers) -> str:
    scheme, _, credentials = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        return credentials.strip()
    return headers.get("x-api-key", "")


class KeyRequired:
    """Pure ASGI middleware: without the key, nothing of the application is reached."""

    def __init__(self, app: ASGIApp, key: str) -> None:
        self.app = app
        self._key = key.encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a call through that carries the key, and answer 401 to any other."""
        if scope["type"] == "http":
            path = scope["path"].removeprefix(scope.get("root_path", ""))
            shown = _shown_key(Headers(scope=scope)).encode("latin-1", "replace")
            if not _is_open(path) and not hmac.compare_digest(shown, self._key):
                refusal = problem_response(
                    HTTPStatus.UNAUTHORIZED,
                    "expected the service's key as Authorization: Bearer KEY or X-API-Key: KEY",
                    headers={"WWW-Authenticate": "Bearer"},
                )
                await refusal(scope, receive, send)
                return
        await self.app(scope, receive, send)


class SafeHeaders:
    """Pure ASGI middleware: an answer is what its type says, and is embedded nowhere."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Add the headers to every HTTP answer that does not set them itself."""

        async def send_safely(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.setdefault("X-Content-Type-Options", "nosniff")
                headers.setdefault(
                    "Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'"
                )
            await send(message)

        await self.app(scope, receive, send_safely if scope["type"] == "http" else send)
