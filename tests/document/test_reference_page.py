"""The reference page tells the fields that the models have."""

from __future__ import annotations

import runpy
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def test_the_field_tables_are_those_of_the_models() -> None:
    script = runpy.run_path(str(DOCS / "document_tables.py"))
    page = (DOCS / "document.md").read_text(encoding="utf-8")
    assert page.split(script["START"])[1].strip() == script["tables"]().strip()
