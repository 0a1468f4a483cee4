"""The algebra of densities along one ray: sorted events, one sweep (paper section III.D)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from phantom.kernels.compiling import inner

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.uint8]


@inner
def sort_events(where: Floats, order: Ints, count: int) -> None:
    """Sort ``order[:count]`` by ``where`` (Shell's method: few events, mostly in order).

    Events at one place stand in the order of their numbers, so that what a ray adds up does not
    depend on what other solids there are.
    """
    gap = 1
    while gap < count // 3:
        gap = 3 * gap + 1
    while gap > 0:
        for i in range(gap, count):
            item = order[i]
            key = where[item]
            j = i
            while j >= gap:
                other = order[j - gap]
                if where[other] < key or (where[other] == key and other < item):
                    break
                order[j] = other
                j -= gap
            order[j] = item
        gap //= 3


@inner
def toggle(
    leaf: int, present: Flags, parent: Ints, operator: Ints, left: Ints, right: Ints
) -> None:
    """Flip a leaf's presence and carry the change up as far as it goes."""
    present[leaf] = 1 - present[leaf]
    node = parent[leaf]
    while node >= 0:
        a, b = present[left[node]], present[right[node]]
        kind = operator[node]
        if kind == 1:
            value = a & b
        elif kind == 2:
            value = a & (1 - b)
        else:
            value = a | b
        if present[node] == value:
            return
        present[node] = value
        node = parent[node]


@inner
def surviving(
    root: int,
    leaves: int,
    present: Flags,
    operator: Ints,
    left: Ints,
    right: Ints,
    stack: Ints,
    found: Ints,
) -> int:
    """Write the leaves whose material is left where the present ones overlap; return how many."""
    if present[root] == 0:
        return 0
    count = 0
    stack[0] = root
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        if node < leaves:
            found[count] = node
            count += 1
            continue
        kind = operator[node]
        if kind == 0:
            stack[waiting] = left[node] if present[left[node]] else right[node]
            waiting += 1
        elif kind == 4:
            stack[waiting] = right[node] if present[right[node]] else left[node]
            waiting += 1
        elif kind == 3:
            if present[left[node]]:
                stack[waiting] = left[node]
                waiting += 1
            if present[right[node]]:
                stack[waiting] = right[node]
                waiting += 1
        else:
            stack[waiting] = left[node]
            waiting += 1
    return count
