from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from typer.testing import CliRunner

from phantom.cli import app


@pytest.fixture
def run() -> Callable[..., Result]:
    """Runs the command line in this process."""

    def call(*words: str) -> Result:
        return CliRunner().invoke(app, list(words), catch_exceptions=False)

    return call


@pytest.fixture
def written(tmp_path: Path) -> Callable[..., str]:
    """Writes a document, given as a tree or as text, and returns its path."""

    def write(document: Any, name: str = "document.json") -> str:
        path = tmp_path / name
        path.write_text(document if isinstance(document, str) else json.dumps(document))
        return str(path)

    return write
