"""From a validated document to the arrays a kernel reads."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.cylinders import Cylinder, cylinder
from phantom.compiled.layout import Scene
from phantom.compiled.pack import PlacedLeaf, pack
from phantom.compiled.tree import CODES, Tree
from phantom.errors import InvalidDocumentError, Problem, pointer, prefixed
from phantom.geometry.quadrics import QuadricShape, bounds, quadric
from phantom.geometry.refusal import RefusalError
from phantom.geometry.transforms import Similarity, similarity

Floats = NDArray[np.float64]
Nested = int | tuple[int, list["Nested"]]


@dataclass(frozen=True)
class Compiled:
    """A scene with what a person asks of it.

    Attributes
    ----------
    scene
        Flat arrays for kernels.
    labels
        The leaves' names, from the root, joined by ``/``; a leaf without any has its place in the
        document instead.
    leaf_bounds
        ``(L, 2, 3)`` mm, box of each leaf before operators; cuts of generalized cylinders ignored.
    bounds
        ``(2, 3)`` mm, a box that holds the final solid.
    warnings
        What a person should know about solids that are sound all the same.
    """

    scene: Scene
    labels: tuple[str, ...]
    leaf_bounds: Floats
    bounds: Floats
    warnings: tuple[str, ...] = ()


@dataclass
class _Builder:
    document: doc.Document
    channels: dict[str, int]
    leaves: list[PlacedLeaf] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    problems: dict[tuple[str, str], Problem] = field(default_factory=dict)
    cylinders: dict[tuple[str, float], Cylinder | None] = field(default_factory=dict)
    quadrics: dict[str, QuadricShape | None] = field(default_factory=dict)

    def walk(
        self, solid: doc.Solid, path: tuple[str | int, ...], to: Similarity, names: tuple[str, ...]
    ) -> Nested:
        """Place every leaf below a solid; return the tree of operators over their numbers."""
        name = getattr(solid, "name", None)
        names = (*names, name) if name else names
        if doc.is_leaf(solid):
            return self._leaf(solid, pointer(path), to, names)
        if isinstance(solid, doc.Transformed):
            return self.walk(solid.solid, (*path, "solid"), to.after(similarity(solid)), names)
        if isinstance(solid, doc.Instance):
            below = ("definitions", solid.of)
            return self.walk(self.document.definitions[solid.of], below, to, names)
        assert isinstance(solid, doc.Operator)
        inner = [
            self.walk(child, (*path, "solids", i), to, names)
            for i, child in enumerate(solid.solids)
        ]
        return CODES[type(solid)], inner

    def check(self, solid: doc.Solid, path: tuple[str | int, ...]) -> None:
        """Hold the leaves of a definition to be solids, whether or not anything uses it."""
        if isinstance(solid, doc.GeneralizedCylinder):
            if not any(key[0] == pointer(path) for key in self.cylinders):
                self._cylinder(solid, pointer(path), 1.0)
        elif doc.is_leaf(solid):
            self._quadric(solid, pointer(path))
        elif isinstance(solid, doc.Transformed):
            self.check(solid.solid, (*path, "solid"))
        elif isinstance(solid, doc.Operator):
            for i, child in enumerate(solid.solids):
                self.check(child, (*path, "solids", i))

    def _leaf(self, leaf: doc.Leaf, path: str, to: Similarity, names: tuple[str, ...]) -> int:
        shape: Cylinder | QuadricShape | None
        if isinstance(leaf, doc.GeneralizedCylinder):
            shape = self._cylinder(leaf, path, to.scale)
        else:
            shape = self._quadric(leaf, path)
        index = len(self.leaves)
        channel = self.channels[leaf.material] if leaf.material is not None else -1
        self.leaves.append(PlacedLeaf(None if shape is None else shape.moved(to), channel))
        self.labels.append(doc.label_of(names) or path)
        return index

    def _cylinder(self, leaf: doc.GeneralizedCylinder, path: str, scale: float) -> Cylinder | None:
        key = (path, scale)
        if key not in self.cylinders:
            self.cylinders[key], problems = cylinder(leaf, scale)
            self._note(path, problems)
        return self.cylinders[key]

    def _quadric(self, leaf: doc.Leaf, path: str) -> QuadricShape | None:
        if path not in self.quadrics:
            self.quadrics[path] = None
            try:
                self.quadrics[path] = quadric(leaf)  # type: ignore[arg-type]
            except RefusalError as refusal:
                self._note(path, [refusal.problem])
        return self.quadrics[path]

    def warnings(self) -> list[str]:
        """Return the warnings of all cylinders, each with the path of its solid."""
        return [
            f"{path}: {warning}"
            for (path, _), shape in self.cylinders.items()
            if shape is not None
            for warning in shape.warnings
        ]

    def _note(self, path: str, problems: list[Problem]) -> None:
        for problem in prefixed(path, problems):
            self.problems[problem.path, problem.kind] = problem


def build(document: doc.Document) -> Compiled:
    """Compile a document.

    Raises
    ------
    InvalidDocumentError
        With every solid that is not one: overlapping itself, unbounded, empty, singular ...
    """
    channels = {name: i for i, name in enumerate(document.materials)}
    builder = _Builder(document, channels)
    nested = builder.walk(document.solid, ("solid",), Similarity.identity(), ())
    for name, solid in document.definitions.items():
        builder.check(solid, ("definitions", name))
    if builder.problems:
        raise InvalidDocumentError(builder.problems.values())
    leaves = builder.leaves
    boxes = np.array([_box(leaf) for leaf in leaves])
    tree = Tree(len(leaves))
    _, box = _flatten(nested, tree, boxes)
    scene = pack(leaves, boxes, tree)
    return Compiled(scene, tuple(builder.labels), boxes, box, tuple(builder.warnings()))


def _box(leaf: PlacedLeaf) -> Floats:
    if isinstance(leaf.shape, Cylinder):
        box, corners = leaf.shape.sampled_box(), leaf.shape.boxes_corners()
        # What a sample may miss between its points, and never beyond the segments' own boxes.
        pad = 1e-3 * float(np.ptp(box, axis=0).min())
        return np.stack(
            [
                np.maximum(box[0] - pad, corners.min(axis=0)),
                np.minimum(box[1] + pad, corners.max(axis=0)),
            ]
        )
    assert leaf.shape is not None
    return bounds(leaf.shape)


def _flatten(nested: Nested, tree: Tree, boxes: Floats) -> tuple[int, Floats]:
    """Add the nodes below to the tree; return the top one and a box that holds what is left."""
    if isinstance(nested, int):
        return nested, boxes[nested]
    code, children = nested
    parts = [_flatten(child, tree, boxes) for child in children]
    node = tree.join(code, [part[0] for part in parts])
    held = np.array([part[1] for part in parts])
    if code == CODES[doc.Difference]:
        return node, held[0]
    if code == CODES[doc.Intersection]:
        low, high = held[:, 0].max(axis=0), held[:, 1].min(axis=0)
        return node, np.stack([low, np.maximum(low, high)])
    return node, np.stack([held[:, 0].min(axis=0), held[:, 1].max(axis=0)])
