"""Reading a design: from a file, a tree or JSON, with every problem at its place."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from phantom.datasets.design import Design
from phantom.document import validate_model
from phantom.document.reading import read_tree


def read_design(source: Path | str | Mapping[str, Any] | Design) -> Design:
    """Return a design from a file, JSON or YAML, or from a tree that was parsed already.

    Raises
    ------
    InvalidInputError
        Every problem of its form; what cannot be made is told by
        :func:`phantom.datasets.checks.check`.
    """
    if isinstance(source, Design):
        return source
    tree = source if isinstance(source, Mapping) else read_tree(Path(source))
    return of_tree(tree)


def of_tree(tree: object) -> Design:
    """Return the design of a tree, as decoded from JSON."""
    return validate_model(Design, tree)
