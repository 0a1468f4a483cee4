"""What abnormalities do to a chest: solids, materials and findings that are added."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from phantom.document import (
    Finding,
    Material,
    Point,
    Solid,
)
from phantom.errors import Problem, pointer
from phantom.library import Abnormality
from phantoms.chest.cage import FloatArray


@dataclass
class Changes:
    """What abnormalities do to a chest.

    Attributes
    ----------
    in_lungs
        Solids that replace lung and its vessels, below diaphragm and heart.
    at_last
        Solids that replace whatever is there.
    ribs
        Ribs in place of the healthy ones.
    materials, findings
        Those that are added.
    """

    in_lungs: list[Solid] = field(default_factory=list)
    at_last: list[Solid] = field(default_factory=list)
    ribs: dict[tuple[str, int], Solid] = field(default_factory=dict)
    materials: dict[str, Material] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    def found(
        self, one: Abnormality, name: str, leaves: Sequence[str], at: FloatArray, size: Any
    ) -> None:
        """Note a finding."""
        kind = str(getattr(one, "kind", "")) + " " + str(one.type)  # type: ignore[attr-defined]
        self.findings.append(
            Finding(
                name=name,
                kind=kind.strip().replace("_", " "),
                leaves=tuple(leaves),
                center=as_point(at),
                size_mm=size,
            )
        )

    def refuse(self, index: int, name: str, kind: str, message: str) -> None:
        """Note that an abnormality does not fit."""
        self.problems.append(Problem(pointer(("abnormalities", index, name)), kind, message))


def as_point(given: FloatArray) -> Point:
    """Return a point as a document holds it."""
    return (float(given[0]), float(given[1]), float(given[2]))
