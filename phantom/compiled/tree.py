"""The operators as a balanced binary tree, so that a change travels up in a few steps."""

from __future__ import annotations

from dataclasses import dataclass, field

from phantom import document as doc
from phantom.compiled.layout import DIFFERENCE, INTERSECTION, OVERLAP, REPLACE, UNION

CODES: dict[type[doc.Operator], int] = {
    doc.Union: UNION,
    doc.Intersection: INTERSECTION,
    doc.Difference: DIFFERENCE,
    doc.Overlap: OVERLAP,
    doc.Replace: REPLACE,
}


@dataclass
class Tree:
    """Nodes in the order they were made; leaves come first, the root last."""

    leaves: int
    parent: list[int] = field(default_factory=list)
    operator: list[int] = field(default_factory=list)
    left: list[int] = field(default_factory=list)
    right: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        for column, value in (
            (self.parent, -1),
            (self.operator, -1),
            (self.left, -1),
            (self.right, -1),
        ):
            column.extend([value] * self.leaves)

    def join(self, code: int, nodes: list[int]) -> int:
        """Join two or more nodes from the left under one operator; return the new node.

        Every operator but the difference is associative in what it keeps, so the fold may be
        balanced; ``a - b - c`` is ``a - (b or c)``.
        """
        if len(nodes) == 1:
            return nodes[0]
        if code == DIFFERENCE:
            return self._node(code, nodes[0], self.join(UNION, nodes[1:]))
        half = len(nodes) // 2
        return self._node(code, self.join(code, nodes[:half]), self.join(code, nodes[half:]))

    def _node(self, code: int, left: int, right: int) -> int:
        index = len(self.parent)
        self.parent.append(-1)
        self.operator.append(code)
        self.left.append(left)
        self.right.append(right)
        self.parent[left] = self.parent[right] = index
        return index
