"""Solids in a tree that may still be wrong: checks across a document read it as far as it goes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from phantom.document.solids import OPERATORS

Parts = tuple[str | int, ...]
Node = dict[str, Any]
Placed = tuple[Parts, Node]
PHANTOM: Parts = ("solid",)


def mapping(value: object) -> Node:
    """Return the value if it is an object, else an empty one."""
    return value if isinstance(value, dict) else {}


def text(value: object) -> str | None:
    """Return the value if it is a string that says something, else None."""
    return value if isinstance(value, str) and value else None


def children(solid: Node) -> list[Placed]:
    """Return the solids that a solid is made of, each with its place below it."""
    kind = solid.get("type")
    if kind == "transformed":
        inner = solid.get("solid")
        return [(("solid",), inner)] if isinstance(inner, dict) else []
    if isinstance(kind, str) and kind in OPERATORS:
        solids = solid.get("solids")
        if isinstance(solids, (list, tuple)):
            return [(("solids", i), s) for i, s in enumerate(solids) if isinstance(s, dict)]
    return []


def survey(document: object) -> dict[Parts, list[Placed]]:
    """Return all solids of a document as written, by the place of their root.

    The roots are the definitions and the phantom itself; instances are not looked through.
    """
    node = mapping(document)
    definitions = mapping(node.get("definitions"))
    roots: dict[Parts, Any] = {("definitions", name): root for name, root in definitions.items()}
    roots[PHANTOM] = node.get("solid")
    return {place: list(_below(root, place)) for place, root in roots.items()}


def _below(root: object, place: Parts) -> Iterator[Placed]:
    """Yield a solid and all below it, left to right."""
    stack: list[Placed] = [(place, root)] if isinstance(root, dict) else []
    while stack:
        at, solid = stack.pop()
        yield at, solid
        inner = children(solid)
        if inner:
            stack.extend([(at + below, child) for below, child in reversed(inner)])


def used_by(solid: Node) -> str | None:
    """Return the name an instance uses, None for other solids."""
    return text(solid.get("of")) if solid.get("type") == "instance" else None
