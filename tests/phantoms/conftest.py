"""Rays over a grid, and solids taken apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from phantom.scene import Phantom
from phantom.tracing import Intervals, intervals

FAR_MM = 1000.0


@pytest.fixture
def along() -> Callable[..., Intervals]:
    """Pieces along one axis of rays through every pair of the other two coordinates.

    Distances are moved to be the coordinate along that axis.
    """

    def trace(phantom: Phantom, axis: str, first: Any, second: Any) -> Intervals:
        index = "xyz".index(axis)
        others = [i for i in range(3) if i != index]
        grid = np.meshgrid(np.atleast_1d(first), np.atleast_1d(second), indexing="ij")
        origins = np.full((grid[0].size, 3), -FAR_MM)
        origins[:, others] = np.stack([side.ravel() for side in grid], axis=1)
        found = intervals(phantom, origins, np.broadcast_to(np.eye(3)[index], origins.shape))
        return replace(found, entry_mm=found.entry_mm - FAR_MM, exit_mm=found.exit_mm - FAR_MM)

    return trace


@pytest.fixture
def overlapping() -> Callable[..., Any]:
    """A solid's tree in which densities add, but for unions of the named leaves alone."""

    def leaves(tree: Any) -> set[str]:
        below = [tree["solid"]] if "solid" in tree else tree.get("solids", [])
        return {tree.get("name")} if not below else set().union(*map(leaves, below))

    def change(tree: dict[str, Any], *kept: str) -> dict[str, Any]:
        changed = dict(tree)
        if "solid" in tree:
            changed["solid"] = change(tree["solid"], *kept)
        if "solids" in tree:
            changed["solids"] = [change(part, *kept) for part in tree["solids"]]
        if tree["type"] == "union" and not leaves(tree) <= set(kept):
            changed["type"] = "overlap"
        return changed

    return change
