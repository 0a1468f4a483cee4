"""A phantom: a validated document together with its compiled scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from phantom import document as doc
from phantom.compiled.build import Compiled, build
from phantom.compiled.surfacing import surfacing

Floats = NDArray[np.float64]
Kept = TypeVar("Kept")


@dataclass(frozen=True, eq=False)
class Phantom:
    """A document that was found to be a solid, ready to be traced.

    Attributes
    ----------
    document
        The document as it was written.
    compiled
        The arrays the kernels read.
    """

    document: doc.Document
    compiled: Compiled
    _kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    @property
    def material_names(self) -> tuple[str, ...]:
        """Every material of the document, in its order, used or not."""
        return tuple(self.document.materials)

    @property
    def leaf_names(self) -> tuple[str, ...]:
        """Labels of the leaves, left to right; an unnamed leaf has its place in the document."""
        return self.compiled.labels

    @property
    def leaf_materials(self) -> NDArray[np.int64]:
        """Index into :attr:`material_names` for each leaf, -1 where it never surfaces."""
        return self.compiled.scene.leaf_material

    @property
    def leaf_bounds(self) -> Floats:
        """Box ``(L, 2, 3)`` in mm of each leaf by itself."""
        return self.compiled.leaf_bounds

    @property
    def surfacing_leaves(self) -> tuple[int, ...]:
        """Numbers of the leaves that the final solid can keep something of."""
        return surfacing(self.compiled.scene)

    @property
    def named_leaves(self) -> tuple[int, ...]:
        """Numbers of those among them that have a name; the others have no ground truth."""
        names = self.leaf_names
        # The label of an unnamed leaf is its place in the document, a JSON pointer.
        unnamed = ("/solid", "/definitions")
        return tuple(
            i for i in self.surfacing_leaves if names[i] and not names[i].startswith(unnamed)
        )

    @property
    def bounds(self) -> Floats:
        """Box ``(2, 3)`` in mm that holds the final solid."""
        return self.compiled.bounds

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a person should know, such as a frame that jumps, each with its place."""
        return self.compiled.warnings

    @property
    def isocentre(self) -> Floats:
        """The point presets aim at: the landmark of that name, else the middle of the bounds."""
        named = self.document.landmarks.get("isocentre")
        if named is not None:
            return np.array(named, dtype=np.float64)
        return np.asarray(0.5 * (self.bounds[0] + self.bounds[1]))

    def kept(self, name: str, make: Callable[[], Kept], *, anew: bool = False) -> Kept:
        """Return what is made of the phantom once and kept with it, such as a tessellation.

        Parameters
        ----------
        name
            Whose place it is.
        make
            Makes it; two threads that ask at once may both do so.
        anew
            Make it again, in place of what was kept.
        """
        if anew or name not in self._kept:
            self._kept[name] = make()
        found: Kept = self._kept[name]
        return found


def load(source: Path | str | bytes | Mapping[str, object] | doc.Document) -> Phantom:
    """Read a document, check that it is a solid, and compile it.

    Parameters
    ----------
    source
        Path of a JSON or YAML file, JSON text as bytes, a parsed tree, or a document.

    Raises
    ------
    InvalidDocumentError
        With every problem found, each with the path of its field.
    """
    document = doc.read(source)
    return Phantom(document, build(document))
