"""``phantom serve``: the HTTP service."""

from __future__ import annotations

import ipaddress
import os
import secrets
from importlib import import_module
from typing import Annotated

import typer

from phantom.cli.console import reporting, say


def serve(
    host: Annotated[str, typer.Option("--host", help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port.")] = 8000,
) -> None:
    """Serve the library over HTTP; beyond this machine a key is required.

    The key is the environment variable PHANTOM_API_KEY; without it one is made and printed.
    """
    with reporting(as_json=False):
        import uvicorn

        from phantom.cli.engine import ready

        # The service stands above the command line, so it is found by name.
        settings = import_module("api.settings").Settings.from_environment(os.environ)
        if settings.api_key is None and not is_loopback(host):
            settings = settings.model_copy(update={"api_key": secrets.token_urlsafe(32)})
            say(f"key for every call (Authorization: Bearer KEY): {settings.api_key}")
        ready(load=True, light=True)
        application = import_module("api.app").create_app(settings)
        say(f"documentation at http://{_shown(host)}:{port}/docs")
        uvicorn.run(
            application,
            host=host,
            port=port,
            root_path=settings.root_path,
            log_level="warning",
            server_header=False,
        )


def is_loopback(host: str) -> bool:
    """Tell whether only this machine can reach the address; of names only localhost is sure."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _shown(host: str) -> str:
    return f"[{host}]" if ":" in host else host
