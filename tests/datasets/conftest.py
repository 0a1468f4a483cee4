from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from phantom.datasets import Design, read_design
from phantom.library import registry

ENTRY_POINTS = """[phantom.library]
lesioned = phantoms_of_the_tests:lesioned
fatal = phantoms_of_the_tests:fatal
"""


@pytest.fixture(scope="session", autouse=True)
def installed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The phantoms of plugin.py as an installed package, for this process and for workers."""
    folder = tmp_path_factory.mktemp("site")
    source = Path(__file__).with_name("plugin.py").read_text(encoding="utf-8")
    (folder / "phantoms_of_the_tests.py").write_text(source, encoding="utf-8")
    about = folder / "phantoms_of_the_tests-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Name: phantoms-of-the-tests\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(ENTRY_POINTS)
    root = str(Path(__file__).parents[2])
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        patch.setenv("PYTHONPATH", os.pathsep.join([str(folder), root]))
        registry._entry_points.cache_clear()
        yield folder
    sys.modules.pop("phantoms_of_the_tests", None)
    registry._entry_points.cache_clear()


@pytest.fixture(scope="session")
def design() -> Callable[..., Design]:
    """Makes small designs; what is given replaces what they usually say."""

    def make(**given: Any) -> Design:
        usual: dict[str, Any] = {
            "phantom": {"name": "lesioned"},
            "people": 10,
            "detector": {"columns": 32, "pitch_mm": 2.0},
            "beam": {"kvp": 60},
            "seed": 7,
        }
        return read_design({**usual, **given})

    return make


@pytest.fixture(scope="session")
def content() -> Callable[[Path], dict[str, str]]:
    """Tells every file below a folder, and its hash."""

    def read(folder: Path) -> dict[str, str]:
        return {
            str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*"))
            if path.is_file()
        }

    return read
