"""Every leaf that can surface has a material, and no two leaves have one label."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from phantom.document.solids import LEAVES, label_of
from phantom.document.tree import PHANTOM, Node, Parts, children, mapping, text, used_by
from phantom.document.words import quoted
from phantom.errors import Problem, pointer

_HIDES_ITS_RIGHT = ("difference", "intersection")


@dataclass(frozen=True)
class _Use:
    """A solid where it stands once instances are expanded."""

    solid: Node
    place: Parts  # where it is written
    use: Parts  # where the phantom's own tree uses it: its place, or its first instance's
    names: tuple[str, ...]
    surfaces: bool


def leaf_problems(document: object) -> Iterator[Problem]:
    """Yield leaves that lack a material and labels that stand twice, instances expanded.

    Only for documents whose instances are neither cyclic nor too many.
    """
    labels: dict[str, _Use] = {}
    for leaf in _leaves(document):
        own_name, material = text(leaf.solid.get("name")), leaf.solid.get("material")
        if material is None and leaf.surfaces:
            through = "" if leaf.use == leaf.place else f" through {pointer(leaf.use)[:80]}"
            message = f"missing; expected a material, for this leaf can surface{through}"
            yield Problem(pointer((*leaf.place, "material")), "missing_material", message)
        label = label_of(leaf.names)
        # A leaf that never surfaces has no ground truth, so it need not be told apart.
        if label and (own_name is not None or leaf.surfaces):
            if label in labels:
                first = labels[label]
                # Two leaves of one instance differ only in where they are written.
                apart = first.use != leaf.use
                at, before = (leaf.use, first.use) if apart else (leaf.place, first.place)
                message = f"found the label {quoted(label)}, that of {pointer(before)[:80]} too; "
                message += "expected every leaf to have its own"
                field = ("name",) if at == leaf.place and own_name else ()
                yield Problem(pointer(at + field), "repeated_label", message)
            else:
                labels[label] = leaf
    known = set(labels)
    findings = mapping(document).get("findings")
    for i, finding in enumerate(findings if isinstance(findings, list | tuple) else ()):
        named = mapping(finding).get("leaves")
        for j, label in enumerate(named if isinstance(named, list | tuple) else ()):
            if text(label) and label not in known:
                message = f"found {quoted(label)}; expected the label of a leaf"
                yield Problem(pointer(("findings", i, "leaves", j)), "undefined_leaf", message)


def _leaves(document: object) -> Iterator[_Use]:
    """Yield the leaves of the phantom from left to right, looking through instances."""
    definitions = mapping(mapping(document).get("definitions"))
    stack = [_Use(mapping(mapping(document).get("solid")), PHANTOM, PHANTOM, (), True)]
    while stack:
        at = stack.pop()
        kind, name = at.solid.get("type"), text(at.solid.get("name"))
        names = (*at.names, name) if name else at.names
        if kind == "instance":
            used = used_by(at.solid)
            if used in definitions:
                solid = mapping(definitions[used])
                stack.append(_Use(solid, ("definitions", used), at.use, names, at.surfaces))
        elif isinstance(kind, str) and kind in LEAVES:
            yield _Use(at.solid, at.place, at.use, names, at.surfaces)
        else:
            inner = []
            for below, child in children(at.solid):
                hidden = kind in _HIDES_ITS_RIGHT and below[-1] != 0
                inside = at.use != at.place
                use = at.use if inside else at.place + below
                inner.append(_Use(child, at.place + below, use, names, at.surfaces and not hidden))
            stack.extend(reversed(inner))
