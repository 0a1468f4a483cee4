"""Names that a document uses must be names it defines, and no definition may contain itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from phantom.document.tree import Parts, Placed, mapping, text, used_by
from phantom.document.words import listed, quoted
from phantom.errors import Problem, pointer

Survey = Mapping[Parts, list[Placed]]
_DONE = -1


def undefined_names(document: object, solids: Survey) -> Iterator[Problem]:
    """Yield a problem for every material and definition that is used and not there."""
    node = mapping(document)
    tables = {noun: node.get(f"{noun}s", {}) for noun in ("material", "definition")}
    known = {noun: listed(mapping(table)) for noun, table in tables.items()}
    for placed in solids.values():
        for at, solid in placed:
            noun, field, name = "material", "material", text(solid.get("material"))
            if solid.get("type") == "instance":
                noun, field, name = "definition", "of", used_by(solid)
            # A table that is no object is a problem of its own and defines nothing.
            if name and isinstance(tables[noun], dict) and name not in tables[noun]:
                message = f"found {quoted(name)}; expected one of the {noun}s: {known[noun]}"
                yield Problem(pointer((*at, field)), f"undefined_{noun}", message)


def uses(solids: Survey) -> dict[str, list[tuple[Parts, str]]]:
    """Return, for each definition, its instances: (place, name of the definition used)."""
    graph: dict[str, list[tuple[Parts, str]]] = {}
    for root, placed in solids.items():
        if root[0] == "definitions":
            named = [(at, used_by(solid)) for at, solid in placed]
            graph[str(root[1])] = [
                (at, name) for at, name in named if name and ("definitions", name) in solids
            ]
    return graph


def in_order(graph: dict[str, list[tuple[Parts, str]]]) -> tuple[list[str], list[Problem]]:
    """Return the definitions, each after those it uses, and the circles among them."""
    order: list[str] = []
    problems: list[Problem] = []
    way: list[tuple[str, Iterator[tuple[Parts, str]]]] = []
    reached: dict[str, int] = {}  # how far down the way a definition is, or _DONE
    for start in graph:
        if start in reached:
            continue
        reached[start] = 0
        way.append((start, iter(graph[start])))
        while way:
            name, rest = way[-1]
            for at, used in rest:
                if used not in reached:
                    reached[used] = len(way)
                    way.append((used, iter(graph[used])))
                    break
                if reached[used] != _DONE:
                    steps = len(way) - reached[used]
                    names = [quoted(step) for step, _ in way[reached[used] : reached[used] + 6]]
                    shown = " → ".join([*names, quoted(used)] if steps <= 6 else names)
                    shown += "" if steps <= 6 else f" … ({steps} steps)"
                    message = f"found an instance within itself: {shown}; expected no circle"
                    problems.append(Problem(pointer((*at, "of")), "cyclic_instance", message))
            else:
                way.pop()
                reached[name] = _DONE
                order.append(name)
    return order, problems
