"""Names that a document uses must be names it defines, and no definition may contain itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from phantom.document.tree import Parts, Placed, mapping, text, used_by
from phantom.document.words import listed, quoted
from phantom.errors import Problem, pointer

Survey = Mapping[Parts, list[Placed]]


def undefined_names(document: object, solids: Survey) -> Iterator[Problem]:
    """Yield a problem for every material and definition that is used and not there."""
    node = mapping(document)
    materials, definitions = mapping(node.get("materials")), mapping(node.get("definitions"))
    for placed in solids.values():
        for at, solid in placed:
            name, known, noun, field = (
                text(solid.get("material")),
                materials,
                "material",
                "material",
            )
            if solid.get("type") == "instance":
                name, known, noun, field = used_by(solid), definitions, "definition", "of"
            if (
                name is not None
                and name not in known
                and isinstance(node.get(noun + "s", {}), dict)
            ):
                message = f"found {quoted(name)}; expected one of the {noun}s: {listed(known)}"
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
    state: dict[str, int] = {}  # 1: on the way down, 2: done
    for start in graph:
        if start in state:
            continue
        state[start], way = 1, [(start, iter(graph[start]))]
        while way:
            name, rest = way[-1]
            for at, used in rest:
                if used not in state:
                    state[used] = 1
                    way.append((used, iter(graph[used])))
                    break
                if state[used] == 1:
                    names = [step for step, _ in way]
                    circle = [*names[names.index(used) :], used]
                    shown = " → ".join(quoted(step) for step in circle[:6])
                    shown += "" if len(circle) <= 6 else f" … ({len(circle)} steps)"
                    message = f"found an instance within itself: {shown}; expected no circle"
                    problems.append(Problem(pointer((*at, "of")), "cyclic_instance", message))
            else:
                way.pop()
                state[name] = 2
                order.append(name)
    return order, problems
