"""Long work: stopped when its client goes away, refused where too much is waiting."""

from __future__ import annotations

import json
import threading
import time
from typing import Any

import anyio
import pytest
from fastapi import Request

from api.app import create_app
from api.problems import RefusedError
from api.settings import Settings
from api.work import Workshop
from phantom.errors import CancelledError


def scope(path: str) -> dict[str, Any]:
    return {
        "type": "http", "method": "POST", "path": path, "raw_path": path.encode(),
        "query_string": b"", "root_path": "", "scheme": "http", "http_version": "1.1",
        "server": ("test", 80), "client": ("test", 1),
        "headers": [(b"content-type", b"application/json")],
    }  # fmt: skip


def client_that_leaves(body: bytes, after_s: float):
    """An ASGI ``receive`` that sends the body and is gone some time later."""
    messages = iter([{"type": "http.request", "body": body, "more_body": False}])

    async def receive():
        try:
            return next(messages)
        except StopIteration:
            await anyio.sleep(after_s)
            return {"type": "http.disconnect"}

    return receive


def test_a_render_stops_when_its_client_goes_away(monkeypatch):
    stopped = threading.Event()

    def endless(self, *, cancelled, progress=None):
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline:
            if cancelled():
                stopped.set()
                raise CancelledError("stopped")
            time.sleep(0.01)

    monkeypatch.setattr("phantom.requests.radiograph.RadiographPlan.render", endless)
    application = create_app(Settings())
    body = json.dumps({"phantom": {"name": "sphere"}, "detector": {"columns": 4}}).encode()
    sent = []

    async def send(message):
        sent.append(message)

    async def call():
        await application(scope("/v1/radiographs"), client_that_leaves(body, 0.3), send)

    anyio.run(call)
    assert stopped.is_set()
    assert sent[0]["status"] == 503


def request_that_stays() -> Request:
    async def receive():
        await anyio.sleep_forever()

    return Request(scope("/"), receive)


def test_work_gives_its_result_and_its_own_errors():
    async def call():
        shop = Workshop(renders=1, queue=0)
        assert await shop.run(request_that_stays(), lambda _: 42) == 42
        with pytest.raises(ZeroDivisionError):
            await shop.run(request_that_stays(), lambda _: 1 / 0)

    anyio.run(call)


def test_beyond_the_queue_a_call_is_told_to_come_back():
    async def call():
        shop, release = Workshop(renders=1, queue=1), threading.Event()
        results: list[object] = []

        async def one():
            results.append(await shop.run(request_that_stays(), lambda _: release.wait(10)))

        async with anyio.create_task_group() as group:
            group.start_soon(one)
            group.start_soon(one)
            await anyio.sleep(0.2)
            with pytest.raises(RefusedError) as refusal:
                await shop.run(request_that_stays(), lambda _: None)
            release.set()
        assert refusal.value.status == 429
        assert "Retry-After" in refusal.value.headers
        assert results == [True, True], "those that were let in were served"

    anyio.run(call)


def test_the_service_answers_while_it_renders(monkeypatch):
    """The event loop is free: /healthz is served from the same loop during a render."""
    release = threading.Event()

    def slow(self, *, cancelled, progress=None):
        release.wait(10)
        raise CancelledError("enough")

    monkeypatch.setattr("phantom.requests.radiograph.RadiographPlan.render", slow)
    application = create_app(Settings())
    body = json.dumps({"phantom": {"name": "sphere"}, "detector": {"columns": 4}}).encode()
    statuses = []

    async def send(message):
        if message["type"] == "http.response.start":
            statuses.append(message["status"])

    async def call():
        async with anyio.create_task_group() as group:
            group.start_soon(
                application, scope("/v1/radiographs"), client_that_leaves(body, 60), send
            )
            await anyio.sleep(0.2)
            get = scope("/healthz") | {"method": "GET"}
            await application(get, client_that_leaves(b"", 60), send)
            assert statuses == [200], "the render is still going on"
            release.set()

    anyio.run(call)
