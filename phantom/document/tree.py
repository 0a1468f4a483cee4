"""Solids in a tree that may still be wrong: checks across a document read it as far as it goes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from phantom.document.solids import OPERATORS

Parts = tuple[str | int, ...]


def mapping(value: object) -> Mapping[str, Any]:
    """Return the value if it is an object, else an empty one."""
    return value if isinstance(value, Mapping) else {}


def text(value: object) -> str | None:
    """Return the value if it is a string that says something, else None."""
    return value if isinstance(value, str) and value else None


def children(solid: object) -> Iterator[tuple[Parts, Any]]:
    """Yield the solids that a solid is made of, each with its place below it."""
    node = mapping(solid)
    kind = node.get("type")
    if kind == "transformed":
        if isinstance(node.get("solid"), Mapping):
            yield ("solid",), node["solid"]
    elif isinstance(kind, str) and kind in OPERATORS:
        solids = node.get("solids")
        for i, child in enumerate(solids if isinstance(solids, list | tuple) else ()):
            if isinstance(child, Mapping):
                yield ("solids", i), child


def roots(document: object) -> Iterator[tuple[Parts, Any]]:
    """Yield the solids at the top of a document: each definition, then the phantom itself."""
    node = mapping(document)
    for name, solid in mapping(node.get("definitions")).items():
        yield ("definitions", name), solid
    yield ("solid",), node.get("solid")


def every_solid(root: object, place: Parts = ()) -> Iterator[tuple[Parts, Mapping[str, Any]]]:
    """Yield a solid and all below it, left to right, not looking through instances."""
    stack: list[tuple[Parts, Any]] = [(place, root)]
    while stack:
        at, solid = stack.pop()
        if isinstance(solid, Mapping):
            yield at, solid
            stack.extend(reversed([(at + below, child) for below, child in children(solid)]))
