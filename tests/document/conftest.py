from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import pytest

import phantom.document
from phantom.errors import InvalidDocumentError, Problem

Tree = dict[str, Any]

SPHERE: Tree = {"type": "sphere", "center": [0, 0, 0], "radius": 10, "material": "bone"}


@pytest.fixture
def sphere() -> Callable[..., Tree]:
    """A sphere of bone; arguments replace or add fields, None takes one away."""

    def make(**fields: Any) -> Tree:
        made = copy.deepcopy(SPHERE) | fields
        return {key: value for key, value in made.items() if value is not None}

    return make


@pytest.fixture
def written() -> Callable[..., Tree]:
    """A whole document about a solid."""

    def make(solid: object, **fields: Any) -> Tree:
        materials = {"bone": {"attenuation_per_mm": 0.05}}
        return {"format": "phantom/1", "materials": materials, "solid": solid} | fields

    return make


@pytest.fixture
def problems() -> Callable[[object], list[Problem]]:
    """The problems a source is refused for; none when it is read."""

    def judge(source: Any) -> list[Problem]:
        try:
            phantom.document.read(source)
        except InvalidDocumentError as error:
            return list(error.problems) or [Problem("", "none", "refused without a problem")]
        return []

    return judge
