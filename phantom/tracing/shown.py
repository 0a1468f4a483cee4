"""Which leaves are shown in visible light: all but those whose material or label is hidden."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from phantom.document.words import listed, quoted
from phantom.errors import InvalidInputError, Problem
from phantom.scene import Phantom

Flags = NDArray[np.uint8]


def shown_leaves(phantom: Phantom, hide: Sequence[str] = ()) -> Flags:
    """Return (L,) 1 for each leaf that is shown.

    What is hidden is looked through, as if its material were clear; the solids keep their shape.

    Parameters
    ----------
    phantom
        Whose leaves.
    hide
        Names of materials, and labels of leaves; the label of a group stands for all leaves below.

    Raises
    ------
    InvalidInputError
        At ``/hide/i``, for a name that is neither.
    """
    labels, materials = phantom.leaf_names, phantom.material_names
    shown = np.ones(len(labels), dtype=np.uint8)
    problems = []
    for i, name in enumerate(hide):
        found = [k for k, label in enumerate(labels) if f"{label}/".startswith(f"{name}/")]
        if name in materials:
            found += np.flatnonzero(phantom.leaf_materials == materials.index(name)).tolist()
        elif not found:
            known = listed({*materials, *(labels[k] for k in phantom.named_leaves)})
            message = f"found {quoted(name)}; expected a material or a leaf's label: {known}"
            problems.append(Problem(f"/hide/{i}", "unknown_name", message))
        shown[found] = 0
    if problems:
        raise InvalidInputError(problems)
    return shown
