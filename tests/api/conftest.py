from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from api.app import create_app
from api.settings import Settings


@pytest.fixture(scope="session", autouse=True)
def _jobs_apart(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """No test meets the jobs of the person who runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("state")))
        yield


@pytest.fixture(scope="session")
def client() -> Iterator[TestClient]:
    """The service with its default settings; a fault of ours is an answer, as for a real client."""
    with TestClient(create_app(Settings()), raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def service() -> Iterator[Callable[..., TestClient]]:
    """Makes services with other settings."""

    def make(**settings: Any) -> TestClient:
        return TestClient(create_app(Settings(**settings)), raise_server_exceptions=False)

    return make


@pytest.fixture
def from_npy() -> Callable[[bytes], Any]:
    return lambda content: np.load(io.BytesIO(content), allow_pickle=False)


@pytest.fixture
def to_npy() -> Callable[[Any], bytes]:
    def write(array: Any) -> bytes:
        stream = io.BytesIO()
        np.save(stream, array)
        return stream.getvalue()

    return write
